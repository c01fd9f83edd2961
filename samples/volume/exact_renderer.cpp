// SPDX-License-Identifier: MIT
//
// A pass of depth peeling captures the next k fragments of every pixel; a pass over all pixels
// composites them, from where the last one left off: it reads what that left in one pair of
// textures and writes the other.

#include "lib/gl/depth_peeling.hpp"
#include "lib/gl/mesh_buffers.hpp"
#include "volume/face_program.hpp"
#include "volume/segment_texture.hpp"
#include "volume/volume_program.hpp"
#include "volume/volume_renderer.hpp"

#include <fmt/format.h>

#include <array>

namespace kb
{

namespace
{

constexpr const char *face_shader = R"(
layout(location = 0) out vec2 fragment;

void main()
{
    fragment = vec2(ray_distance(), coded_scalar());
}
)";

/// A prime number: cuts of a cell over all scalars do not fall onto steps at 1/2, 1/4, 1/10, at
/// which the table is not exact.
constexpr int cuts = 31;
/// Narrow peaks of a transfer function want many texels.
constexpr TableSize exact_table{4097, 65, 1.0 / cuts};

/// Texture units of the shaders below.
enum Unit { fragments_unit, depths_unit, color_unit, front_unit, table_unit };

/// Distance is 0 where a layer has no fragment: nothing is behind it.
constexpr const char *add_shader = R"(
uniform sampler2DArray fragments;
uniform sampler2D color_so_far;
uniform sampler2D front_so_far;
layout(location = 0) out vec4 new_color;
layout(location = 1) out vec4 new_front;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    start(texelFetch(color_so_far, pixel, 0), texelFetch(front_so_far, pixel, 0));
    for (int i = 0; i < LAYERS; ++i) {
        vec2 fragment = texelFetch(fragments, ivec3(pixel, i), 0).xy;
        if (!(fragment.x > 0.0))
            break;
        add(fragment);
    }
    new_color = color;
    new_front = front;
}
)";

constexpr const char *finish_shader = R"(#version 330
uniform sampler2D color_so_far;
uniform vec3 background;
layout(location = 0) out vec4 result;

void main()
{
    vec4 color = texelFetch(color_so_far, ivec2(gl_FragCoord.xy), 0);
    result = vec4(color.rgb + (1.0 - color.a) * background, color.a);
}
)";

class ExactRenderer final : public VolumeRenderer
{
public:
    ExactRenderer(const Gl &gl, const VolumeSettings &settings, DepthPeeling peeling, Program faces,
                  Program add, Program finish)
        : gl_(gl), size_(settings.size), peeling_(std::move(peeling)), faces_(std::move(faces)),
          add_(std::move(add)), finish_(std::move(finish)),
          table_(gl, PreintegratedTable(settings.transfer, exact_table)),
          sums_({Sum(gl, size_), Sum(gl, size_)}),
          picture_(make_texture_2d(gl, GL_RGBA32F, size_.width, size_.height)), framebuffer_(gl),
          empty_(gl), go_on_(settings.go_on)
    {
        add_.use();
        gl.Uniform1i(add_.uniform("fragments"), fragments_unit);
        gl.Uniform1i(add_.uniform("color_so_far"), color_unit);
        gl.Uniform1i(add_.uniform("front_so_far"), front_unit);
        gl.Uniform1i(add_.uniform("thin"), table_unit);
        gl.Uniform1i(add_.uniform("fading"), table_unit + 1);
        finish_.use();
        gl.Uniform1i(finish_.uniform("color_so_far"), color_unit);
        gl.Uniform3f(finish_.uniform("background"), settings.background.r, settings.background.g,
                     settings.background.b);
        gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
        gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, picture_.id(),
                                0);
    }

    Status draw(const SortedFaces &faces) override
    {
        sums_[0].clear();
        passes_ = 0;
        Status status = peeling_.restart();
        for (bool more = true; status && more;) {
            draw_layers(faces);
            add_layers();
            ++passes_;
            if (go_on_ && !go_on_())
                return Error{"stopped"};
            more = peeling_.overflow();
            // A pass takes k fragments of a pixel, of which a face makes at most one.
            if (more && static_cast<std::size_t>(peeling_.first_layer()) > faces.count())
                return Error{fmt::format("{} passes have not come to the end of {} faces: this is "
                                         "an error of the driver",
                                         passes_, faces.count())};
            if (more)
                status = peeling_.advance();
        }
        if (!status)
            return status;
        finish();
        return check_gl(gl_, "drawing the volume");
    }

    GLuint framebuffer() const override { return framebuffer_.id(); }
    int passes() const override { return passes_; }
    int bytes_per_pixel() const override { return peeling_.bytes_per_pixel() + 4 * 16; }

private:
    /// Entries 0 and 1 of volume_program.hpp. Depths are distances along the ray: its length is 1.
    struct Sum {
        Sum(const Gl &gl, Size size)
            : color(make_texture_2d(gl, GL_RGBA32F, size.width, size.height)),
              front(make_texture_2d(gl, GL_RGBA32F, size.width, size.height)), framebuffer(gl)
        {
            gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
            gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color.id(),
                                    0);
            gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, front.id(),
                                    0);
            const std::array<GLenum, 2> both{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
            gl.DrawBuffers(2, both.data());
        }

        void clear() const
        {
            const Gl &gl = framebuffer.gl();
            gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
            const std::array<float, 4> zero{};
            gl.ClearBufferfv(GL_COLOR, 0, zero.data());
            gl.ClearBufferfv(GL_COLOR, 1, std::array{0.0F, 0.0F, 0.0F, 1.0F}.data());
        }

        Texture color;
        Texture front;
        Framebuffer framebuffer;
    };

    void bind(Unit unit, GLenum target, const Texture &texture) const
    {
        gl_.ActiveTexture(GL_TEXTURE0 + unit);
        gl_.BindTexture(target, texture.id());
        gl_.ActiveTexture(GL_TEXTURE0);
    }

    void draw_layers(const SortedFaces &faces) const
    {
        peeling_.clear();
        gl_.Enable(GL_DEPTH_PEELING_MESA);
        draw_faces(gl_, faces_, faces, size_);
        gl_.Disable(GL_DEPTH_PEELING_MESA);
    }

    /// The sums so far are in sums_[0].
    void add_layers()
    {
        gl_.Disable(GL_DEPTH_TEST);
        gl_.BindFramebuffer(GL_FRAMEBUFFER, sums_[1].framebuffer.id());
        gl_.Viewport(0, 0, size_.width, size_.height);
        peeling_.bind_textures();
        bind(color_unit, GL_TEXTURE_2D, sums_[0].color);
        bind(front_unit, GL_TEXTURE_2D, sums_[0].front);
        table_.bind(table_unit);
        add_.use();
        draw_full_screen(gl_, empty_);
        std::swap(sums_[0], sums_[1]);
    }

    void finish() const
    {
        gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
        bind(color_unit, GL_TEXTURE_2D, sums_[0].color);
        finish_.use();
        draw_full_screen(gl_, empty_);
    }

    const Gl &gl_;
    Size size_;
    DepthPeeling peeling_;
    Program faces_;
    Program add_;
    Program finish_;
    SegmentTextures table_;
    std::array<Sum, 2> sums_;
    Texture picture_;
    Framebuffer framebuffer_;
    VertexArray empty_;
    GoOn go_on_;
    int passes_ = 0;
};

} // namespace

Result<std::unique_ptr<VolumeRenderer>> make_exact_renderer(const Gl &gl,
                                                            const VolumeSettings &settings)
{
    PeelingLayers layers;
    layers.size = settings.size;
    layers.count = settings.k;
    layers.func = GL_GREATER;
    layers.color_formats = {GL_RG32F};
    auto peeling = DepthPeeling::make(gl, layers);
    if (!peeling)
        return peeling.error();
    auto faces = make_face_program(gl, face_shader);
    if (!faces)
        return faces.error();
    auto add = Program::make(gl, full_screen_vertex_shader,
                             fmt::format("#version 330\n#define LAYERS {}\n", settings.k) +
                                 SegmentTextures::shader(exact_table) + make_volume_shader(cuts) +
                                 add_shader);
    if (!add)
        return add.error();
    auto finish = Program::make(gl, full_screen_vertex_shader, finish_shader);
    if (!finish)
        return finish.error();
    auto renderer = std::make_unique<ExactRenderer>(
        gl, settings, std::move(*peeling), std::move(*faces), std::move(*add), std::move(*finish));
    if (auto complete = check_framebuffer(gl); !complete)
        return complete.error();
    return std::unique_ptr<VolumeRenderer>(std::move(renderer));
}

} // namespace kb
