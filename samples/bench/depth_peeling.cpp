// SPDX-License-Identifier: MIT
//
// GL_MESA_depth_peeling: one pass over the geometry, in which the driver inserts each fragment by
// its depth into k layers.

#include "layer_resolve.hpp"
#include "renderer.hpp"

#include <array>
#include <stdexcept>

namespace kb::bench
{

namespace
{

class DepthPeeling final : public Renderer
{
public:
    DepthPeeling(const Gl &gl, Size size, int k)
        : gl_(gl), k_(k), shading_(make_geometry_program(gl, "", R"(
out vec4 color;

void main()
{
    color = shade();
}
)")),
          resolve_(gl, k), colors_(make_texture_2d_array(gl, GL_RGBA8, size.width, size.height, k)),
          depths_(make_texture_2d_array(gl, GL_DEPTH_COMPONENT32F, size.width, size.height, k)),
          framebuffer_(gl)
    {
        gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
        gl.FramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, colors_.id(), 0);
        gl.FramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, depths_.id(), 0);
        must(check_framebuffer(gl));
    }

    void draw(const GlScene &scene, GLuint target) override
    {
        gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
        constexpr std::array<GLfloat, 4> nothing{};
        gl_.ClearBufferfv(GL_COLOR, 0, nothing.data());
        const GLfloat farthest = 1.0F;
        gl_.ClearBufferfv(GL_DEPTH, 0, &farthest);

        gl_.DepthFunc(GL_LESS);
        gl_.Enable(GL_DEPTH_PEELING_MESA);
        scene.draw(shading_);
        gl_.Disable(GL_DEPTH_PEELING_MESA);

        resolve_.draw(colors_, target);
    }

    int bytes_per_pixel() const override { return k_ * (4 + 4); }

private:
    const Gl &gl_;
    int k_;
    Program shading_;
    LayerResolve resolve_;
    Texture colors_;
    Texture depths_;
    Framebuffer framebuffer_;
};

} // namespace

std::unique_ptr<Renderer> make_depth_peeling(const Gl &gl, Size size, int k)
{
    if (!has_extension(gl, "GL_MESA_depth_peeling"))
        throw std::runtime_error("the driver has no GL_MESA_depth_peeling");
    return std::make_unique<DepthPeeling>(gl, size, k);
}

} // namespace kb::bench
