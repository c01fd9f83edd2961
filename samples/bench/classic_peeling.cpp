// SPDX-License-Identifier: MIT
//
// Classic depth peeling: k passes over the geometry, each keeping the nearest fragment behind the
// one that the pass before it kept. Fragments of equal depth count as one: that is the method's own
// error.

#include "bench/layer_resolve.hpp"
#include "bench/renderer.hpp"

#include <array>

namespace kb::bench
{

namespace
{

class ClassicPeeling final : public Renderer
{
public:
    ClassicPeeling(const Gl &gl, Size size, int k)
        : gl_(gl), k_(k), first_(make_geometry_program(gl, "", R"(
out vec4 color;

void main()
{
    color = shade();
}
)")),
          next_(make_geometry_program(gl, "", R"(
uniform sampler2D previous_depth;
out vec4 color;

void main()
{
    if (gl_FragCoord.z <= texelFetch(previous_depth, ivec2(gl_FragCoord.xy), 0).r)
        discard;
    color = shade();
}
)")),
          resolve_(gl, k), framebuffer_(gl),
          layers_(make_texture_2d_array(gl, GL_RGBA8, size.width, size.height, k)),
          depths_{make_texture_2d(gl, GL_DEPTH_COMPONENT32F, size.width, size.height),
                  make_texture_2d(gl, GL_DEPTH_COMPONENT32F, size.width, size.height)}
    {
    }

    void draw(const GlScene &scene, GLuint target) override
    {
        gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
        gl_.Enable(GL_DEPTH_TEST);
        gl_.DepthFunc(GL_LESS);
        gl_.ActiveTexture(GL_TEXTURE0);
        for (int pass = 0; pass < k_; ++pass)
            peel(scene, pass);
        gl_.Disable(GL_DEPTH_TEST);

        resolve_.draw(layers_, target);
    }

    int passes() const override { return k_; }
    int bytes_per_pixel() const override { return 4 * k_ + 2 * 4; }

private:
    void peel(const GlScene &scene, int pass)
    {
        const Texture &depth = depths_.at(static_cast<std::size_t>(pass) % 2);
        const Texture &previous = depths_.at(static_cast<std::size_t>(pass + 1) % 2);
        gl_.FramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, layers_.id(), 0, pass);
        gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth.id(), 0);
        constexpr std::array<GLfloat, 4> nothing{};
        gl_.ClearBufferfv(GL_COLOR, 0, nothing.data());
        const GLfloat farthest = 1.0F;
        gl_.ClearBufferfv(GL_DEPTH, 0, &farthest);

        const Program &program = pass == 0 ? first_ : next_;
        gl_.BindTexture(GL_TEXTURE_2D, pass == 0 ? 0 : previous.id());
        scene.draw(program);
    }

    const Gl &gl_;
    int k_;
    Program first_;
    Program next_;
    LayerResolve resolve_;
    Framebuffer framebuffer_;
    Texture layers_;
    std::array<Texture, 2> depths_;
};

} // namespace

std::unique_ptr<Renderer> make_classic_peeling(const Gl &gl, Size size, int k)
{
    return std::make_unique<ClassicPeeling>(gl, size, k);
}

} // namespace kb::bench
