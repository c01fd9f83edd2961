// SPDX-License-Identifier: MIT

#include "lib/gl/context_kinds.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <cmath>

namespace kb
{

namespace
{

class GlfwContext final : public Context
{
public:
    GlfwContext() = default;
    ~GlfwContext() override
    {
        if (window_)
            glfwDestroyWindow(window_);
        if (initialized_)
            glfwTerminate();
    }

    Status start(Size size, const std::string &title)
    {
        if (!glfwInit())
            return glfw_error("GLFW does not start");
        initialized_ = true;
        window_ = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
        if (!window_)
            return glfw_error("GLFW makes no window");
        glfwMakeContextCurrent(window_);
        glfwSetWindowUserPointer(window_, this);
        glfwSetScrollCallback(window_, [](GLFWwindow *window, double, double steps) {
            static_cast<GlfwContext *>(glfwGetWindowUserPointer(window))->scroll_ += steps;
        });
        auto gl = load_gl([](const char *name) { return glfwGetProcAddress(name); });
        if (!gl)
            return gl.error();
        gl_ = *gl;
        return ok;
    }

    bool has_window() const override { return true; }

    bool present(GLuint framebuffer, Size size, OrbitCamera &camera) override
    {
        int width = 0;
        int height = 0;
        glfwGetFramebufferSize(window_, &width, &height);
        gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
        gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
        gl_.BlitFramebuffer(0, 0, size.width, size.height, 0, 0, width, height, GL_COLOR_BUFFER_BIT,
                            GL_NEAREST);
        glfwSwapBuffers(window_);
        glfwWaitEventsTimeout(1.0 / 60.0);
        move(camera);
        return !glfwWindowShouldClose(window_) &&
               glfwGetKey(window_, GLFW_KEY_ESCAPE) != GLFW_PRESS;
    }

private:
    static Error glfw_error(const char *what)
    {
        const char *reason = nullptr;
        glfwGetError(&reason);
        return Error{fmt::format("{}: {}", what, reason ? reason : "unknown reason")};
    }

    /// Dragging turns, the wheel zooms; the arrow keys turn too.
    void move(OrbitCamera &camera)
    {
        double x = 0.0;
        double y = 0.0;
        glfwGetCursorPos(window_, &x, &y);
        if (glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS)
            camera.turn(static_cast<float>(cursor_x_ - x) * 0.4F,
                        static_cast<float>(y - cursor_y_) * 0.4F);
        cursor_x_ = x;
        cursor_y_ = y;

        const auto key = [this](int code) {
            return glfwGetKey(window_, code) == GLFW_PRESS ? 2.0F : 0.0F;
        };
        const float across = key(GLFW_KEY_LEFT) - key(GLFW_KEY_RIGHT);
        const float up = key(GLFW_KEY_UP) - key(GLFW_KEY_DOWN);
        // Nothing moves by itself: a camera may be where turning and zooming would not leave it.
        if (across != 0.0F || up != 0.0F)
            camera.turn(across, up);
        if (scroll_ != 0.0)
            camera.zoom(static_cast<float>(std::pow(0.9, scroll_)));
        scroll_ = 0.0;
    }

    bool initialized_ = false;
    GLFWwindow *window_ = nullptr;
    double scroll_ = 0.0;
    double cursor_x_ = 0.0;
    double cursor_y_ = 0.0;
};

} // namespace

Result<std::unique_ptr<Context>> make_glfw_context(Size size, const std::string &title)
{
    auto context = std::make_unique<GlfwContext>();
    if (auto started = context->start(size, title); !started)
        return started.error();
    return std::unique_ptr<Context>(std::move(context));
}

} // namespace kb
