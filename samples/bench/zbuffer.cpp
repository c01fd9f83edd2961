// SPDX-License-Identifier: MIT
//
// The base of the ratios: the nearest surface, opaque.

#include "bench/background.hpp"
#include "bench/renderer.hpp"

namespace kb::bench
{

namespace
{

class Zbuffer final : public Renderer
{
public:
    Zbuffer(const Gl &gl, Size size)
        : gl_(gl), program_(make_geometry_program(gl, "", R"(
out vec4 color;

void main()
{
    color = vec4(shade().rgb, 1.0);
}
)")),
          depth_(make_texture_2d(gl, GL_DEPTH_COMPONENT32F, size.width, size.height))
    {
    }

    void draw(const GlScene &scene, GLuint target) override
    {
        gl_.BindFramebuffer(GL_FRAMEBUFFER, target);
        gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.id(),
                                 0);
        gl_.Enable(GL_DEPTH_TEST);
        gl_.DepthFunc(GL_LESS);
        gl_.ClearBufferfv(GL_COLOR, 0, background_color.data());
        const GLfloat farthest = 1.0F;
        gl_.ClearBufferfv(GL_DEPTH, 0, &farthest);

        scene.draw(program_);

        gl_.Disable(GL_DEPTH_TEST);
        gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, 0, 0);
    }

    int bytes_per_pixel() const override { return 4; }

private:
    const Gl &gl_;
    Program program_;
    Texture depth_;
};

} // namespace

std::unique_ptr<Renderer> make_zbuffer(const Gl &gl, Size size)
{
    return std::make_unique<Zbuffer>(gl, size);
}

} // namespace kb::bench
