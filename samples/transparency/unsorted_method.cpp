// SPDX-License-Identifier: MIT
//
// Plain "over" blending in the order in which the triangles come: what one gets without sorting.

#include "transparency/method.hpp"

namespace kb
{

namespace
{

class UnsortedMethod final : public Method
{
public:
    UnsortedMethod(const Gl &gl, const MethodOptions &options, Program shading)
        : gl_(gl), options_(options), shading_(std::move(shading)), framebuffer_(gl),
          color_(make_texture_2d(gl, color_format(), options.size.width, options.size.height))
    {
        gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
        gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color_.id(),
                                0);
    }

    void capture(const Scene &scene, const OrbitCamera &camera) override
    {
        gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
        gl_.Viewport(0, 0, options_.size.width, options_.size.height);
        gl_.ClearColor(options_.background.r, options_.background.g, options_.background.b, 1.0F);
        gl_.Clear(GL_COLOR_BUFFER_BIT);
        gl_.Disable(GL_DEPTH_TEST);
        gl_.Enable(GL_BLEND);
        // Alpha stays 1.
        gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
        scene.draw(shading_, camera, options_.size);
        gl_.Disable(GL_BLEND);
    }

    void resolve(GLuint framebuffer) override
    {
        gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.id());
        gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
        gl_.BlitFramebuffer(0, 0, options_.size.width, options_.size.height, 0, 0,
                            options_.size.width, options_.size.height, GL_COLOR_BUFFER_BIT,
                            GL_NEAREST);
    }

    int bytes_per_pixel() const override { return color_format() == GL_RGBA8 ? 4 : 16; }

private:
    GLenum color_format() const
    {
        return options_.layout == EntryLayout::packed ? GL_RGBA8 : GL_RGBA32F;
    }

    const Gl &gl_;
    MethodOptions options_;
    Program shading_;
    Framebuffer framebuffer_;
    Texture color_;
};

} // namespace

Result<std::unique_ptr<Method>> make_unsorted_method(const Gl &gl, const MethodOptions &options)
{
    auto shading = Scene::make_program(gl);
    if (!shading)
        return shading.error();
    auto method = std::make_unique<UnsortedMethod>(gl, options, std::move(*shading));
    if (auto complete = check_framebuffer(gl); !complete)
        return complete.error();
    return std::unique_ptr<Method>(std::move(method));
}

} // namespace kb
