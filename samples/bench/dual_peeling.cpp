// SPDX-License-Identifier: MIT
//
// Dual depth peeling (Bavoil and Myers 2008): blending with MAX finds the nearest and the farthest
// fragment that are left, as (-z, z), and the next pass peels both. So k layers take half as many
// passes as by classic peeling, but they are k/2 from the front and k/2 from the back: the picture
// is that of all fragments once k is their number, and none of the k nearest before. Fragments of
// equal depth are mixed up: that is the method's own error.

#include "bench/layer_resolve.hpp"
#include "bench/renderer.hpp"

#include <fmt/format.h>

#include <array>
#include <string>

namespace kb::bench
{

namespace
{

constexpr std::array<GLenum, 3> attachments{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1,
                                            GL_COLOR_ATTACHMENT2};

std::string peel_source(float epsilon)
{
    return fmt::format("const float epsilon = {:e};\n", epsilon) + R"(
uniform sampler2D bounds;
layout(location = 0) out vec2 next_bounds;
layout(location = 1) out vec4 front;
layout(location = 2) out vec4 back;

void main()
{
    float z = gl_FragCoord.z;
    vec2 bound = texelFetch(bounds, ivec2(gl_FragCoord.xy), 0).rg;
    float nearest = -bound.x;
    float farthest = bound.y;
    if (z < nearest - epsilon || z > farthest + epsilon)
        discard;
    next_bounds = vec2(-2.0);
    front = vec4(0.0);
    back = vec4(0.0);
    if (z > nearest + epsilon && z < farthest - epsilon)
        next_bounds = vec2(-z, z);
    else if (z <= nearest + epsilon)
        front = shade();
    else
        back = shade();
}
)";
}

/// Read and written in turns.
std::array<Texture, 2> make_bounds(const Gl &gl, Size size)
{
    return {make_texture_2d(gl, GL_RG32F, size.width, size.height),
            make_texture_2d(gl, GL_RG32F, size.width, size.height)};
}

class DualPeeling final : public Renderer
{
public:
    DualPeeling(const Gl &gl, Size size, int k, float epsilon)
        : gl_(gl), front_layers_((k + 1) / 2), back_layers_(k / 2), bounds_(make_bounds(gl, size)),
          layers_(make_texture_2d_array(gl, GL_RGBA8, size.width, size.height, k)),
          framebuffer_(gl), first_(make_geometry_program(gl, "", R"(
out vec2 bounds;

void main()
{
    bounds = vec2(-gl_FragCoord.z, gl_FragCoord.z);
}
)")),
          peel_(make_geometry_program(gl, "", peel_source(epsilon))),
          // Where front and back meet.
          resolve_(gl, k, EmptyLayers::anywhere)
    {
    }

    void draw(const GlScene &scene, GLuint target) override
    {
        gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
        gl_.Enable(GL_BLEND);
        gl_.BlendEquation(GL_MAX);
        gl_.ActiveTexture(GL_TEXTURE0);
        begin_pass(0, 0, 0);
        gl_.BindTexture(GL_TEXTURE_2D, 0);
        scene.draw(first_);
        for (int pass = 1; pass <= front_layers_; ++pass) {
            // The array has the layers from front to back: those of the back come last first.
            const int front = pass - 1;
            const int back = front_layers_ + back_layers_ - pass;
            begin_pass(pass, front, back < front_layers_ ? front : back);
            gl_.BindTexture(GL_TEXTURE_2D, bounds_.at(static_cast<std::size_t>(pass + 1) % 2).id());
            scene.draw(peel_);
        }
        gl_.BlendEquation(GL_FUNC_ADD);
        gl_.Disable(GL_BLEND);

        resolve_.draw(layers_, target);
    }

    int passes() const override { return 1 + front_layers_; }
    int bytes_per_pixel() const override { return 4 * (front_layers_ + back_layers_) + 2 * 8; }

private:
    /// Clears what the pass draws into: bounds alone (pass 0), a front layer too and, unless it is
    /// the same, a back layer.
    void begin_pass(int pass, int front, int back)
    {
        constexpr std::array<GLfloat, 4> behind_all{-2.0F, -2.0F, 0.0F, 0.0F};
        constexpr std::array<GLfloat, 4> nothing{};
        const GLsizei count = pass == 0 ? 1 : back == front ? 2 : 3;
        gl_.FramebufferTexture2D(GL_FRAMEBUFFER, attachments[0], GL_TEXTURE_2D,
                                 bounds_.at(static_cast<std::size_t>(pass) % 2).id(), 0);
        for (std::size_t i = 1; i < attachments.size(); ++i)
            gl_.FramebufferTextureLayer(GL_FRAMEBUFFER, attachments.at(i),
                                        static_cast<GLsizei>(i) < count ? layers_.id() : 0, 0,
                                        i == 1 ? front : back);
        gl_.DrawBuffers(count, attachments.data());
        gl_.ClearBufferfv(GL_COLOR, 0, behind_all.data());
        for (GLint i = 1; i < count; ++i)
            gl_.ClearBufferfv(GL_COLOR, i, nothing.data());
    }

    const Gl &gl_;
    int front_layers_;
    int back_layers_;
    std::array<Texture, 2> bounds_;
    Texture layers_;
    Framebuffer framebuffer_;
    Program first_;
    Program peel_;
    LayerResolve resolve_;
};

} // namespace

std::unique_ptr<Renderer> make_dual_peeling(const Gl &gl, Size size, int k, float epsilon)
{
    return std::make_unique<DualPeeling>(gl, size, k, epsilon);
}

} // namespace kb::bench
