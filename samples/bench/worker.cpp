// SPDX-License-Identifier: MIT

#include "bench/worker.hpp"

#include "bench/capture.hpp"
#include "bench/renderer.hpp"
#include "bench/worker_process.hpp"
#include "lib/app/timing.hpp"
#include "lib/gl/context.hpp"
#include "lib/gl/kbuffer.hpp"

#include <optional>

#include <unistd.h>

namespace kb::bench
{

using nlohmann::json;

namespace
{

/// What a frame ends in.
class Target
{
public:
    Target(const Gl &gl, GLenum format, Size size)
        : color_(make_texture_2d(gl, format, size.width, size.height)), framebuffer_(gl)
    {
        gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
        gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color_.id(),
                                0);
        must(check_framebuffer(gl));
    }

    GLuint framebuffer() const { return framebuffer_.id(); }

private:
    Texture color_;
    Framebuffer framebuffer_;
};

class Worker
{
public:
    explicit Worker(std::unique_ptr<Context> context)
        : context_(std::move(context)), gl_(context_->gl())
    {
    }

    json answer(const json &request)
    {
        const auto what = request.at("do").get<std::string>();
        if (what == "hello")
            return {{"driver", describe_driver(gl_)},
                    {"kbuffer_program", has_extension(gl_, "GL_MESA_kbuffer_program")}};
        if (what == "scene")
            return load_scene(request);
        if (what == "capture")
            return capture(request);
        if (what == "method")
            return add_method(request);
        if (what == "frame")
            return {{"ms", time_frame(renderer(request))}};
        if (what == "image")
            return write_image(request);
        throw std::invalid_argument("no such request: " + what);
    }

private:
    json load_scene(const json &request)
    {
        renderers_.clear();
        scene_.reset();
        size_ = {request.at("width").get<int>(), request.at("height").get<int>()};
        const auto made = make_scene(request.at("name").get<std::string>(),
                                     request.at("dragon").get<std::string>());
        if (!made)
            throw BadInput(made.error().message);
        const StudyScene &scene = *made;
        scene_.emplace(gl_, scene);
        // Frames are timed into eight bits a channel, as a window has, and looked at in floats, so
        // that errors are the method's and not the window's.
        timed_.emplace(gl_, GL_RGBA8, size_);
        seen_.emplace(gl_, GL_RGBA32F, size_);
        gl_.Viewport(0, 0, size_.width, size_.height);
        must(check_gl(gl_, "loading the scene"));
        return {{"triangles", scene.mesh.triangle_count()}, {"note", scene.note}};
    }

    json capture(const json &request)
    {
        const auto ks = request.at("ks").get<std::vector<int>>();
        const auto paths = request.at("paths").get<std::vector<std::string>>();
        const Capture capture = capture_exact_images(gl_, scene_.value(), size_, ks);
        for (std::size_t i = 0; i < paths.size(); ++i)
            must(write_pfm(paths[i], capture.images.at(i)));
        return {{"fragments", capture.fragments},
                {"depth_complexity", capture.depth_complexity},
                {"covered_pixels", capture.covered_pixels}};
    }

    json add_method(const json &request)
    {
        const auto method = request.at("method").get<std::string>();
        renderers_.push_back(make_renderer(gl_, method, request.at("variant").get<std::string>(),
                                           size_, request.at("k").get<int>()));
        must(check_gl(gl_, "setting up " + method));
        return {{"id", renderers_.size() - 1}, {"passes", renderers_.back()->passes()}};
    }

    Renderer &renderer(const json &request)
    {
        return *renderers_.at(request.at("id").get<std::size_t>());
    }

    double time_frame(Renderer &renderer)
    {
        const double ms =
            milliseconds(gl_, [&] { renderer.draw(scene_.value(), timed_->framebuffer()); });
        must(check_gl(gl_, "drawing"));
        return ms;
    }

    json write_image(const json &request)
    {
        renderer(request).draw(scene_.value(), seen_->framebuffer());
        const ImageRgbaF image = read_color(gl_, seen_->framebuffer(), size_);
        must(check_gl(gl_, "reading the image"));
        must(write_pfm(request.at("path").get<std::string>(), image));
        // Drivers compile shaders for the formats that they write.
        renderer(request).draw(scene_.value(), timed_->framebuffer());
        return {{"bytes_per_pixel", renderer(request).bytes_per_pixel()}};
    }

    std::unique_ptr<Context> context_;
    const Gl &gl_;
    Size size_;
    std::optional<GlScene> scene_;
    std::optional<Target> timed_;
    std::optional<Target> seen_;
    std::vector<std::unique_ptr<Renderer>> renderers_;
};

} // namespace

int work()
{
    // Whatever a library prints must not get between the answers.
    const File answers(fdopen(dup(STDOUT_FILENO), "w"));
    dup2(STDERR_FILENO, STDOUT_FILENO);

    std::optional<Worker> worker;
    for (json request; !(request = read_message(stdin)).is_null();) {
        json answer;
        try {
            if (!worker)
                worker.emplace(must(make_context("osmesa")));
            answer = worker->answer(request);
        } catch (const BadInput &error) {
            answer = {{"bad_input", error.what()}};
        } catch (const std::exception &error) {
            answer = {{"error", error.what()}};
        }
        write_message(answers.get(), answer);
    }
    return 0;
}

} // namespace kb::bench
