// SPDX-License-Identifier: MIT

#include "peeling/accumulation.hpp"

#include "lib/gl/kbuffer.hpp"
#include "lib/gl/mesh_buffers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace kb
{

/// Composes the layers of a pass, of each sample for itself.
static constexpr const char *compose_shader = R"(
uniform SAMPLERS colors;
uniform SAMPLERS depths;
layout(location = 0) out vec4 sum_and_transmittance;
layout(location = 1) out float count;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    int filled = 0;
    while (filled < LAYERS && texelFetch(depths, ivec3(pixel, filled), SAMPLE).x != EMPTY)
        ++filled;
    vec3 sum = vec3(0.0);
    float transmittance = 1.0;
    for (int i = 0; i < filled; ++i) {
        vec4 color = texelFetch(colors, ivec3(pixel, NEAREST_FIRST ? i : filled - 1 - i), SAMPLE);
        sum += transmittance * color.a * color.rgb;
        transmittance *= 1.0 - color.a;
    }
    sum_and_transmittance = vec4(sum, transmittance);
    count = float(filled);
}
)";

static constexpr const char *average_shader = R"(
uniform SAMPLER sums;
uniform SAMPLER counts;
uniform vec3 background;
layout(location = 0) out vec4 color;
layout(location = 1) out vec2 total_and_deepest;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    color = vec4(0.0, 0.0, 0.0, 1.0);
    total_and_deepest = vec2(0.0);
    for (int i = 0; i < SAMPLES; ++i) {
        vec4 sum = texelFetch(sums, pixel, i);
        color.rgb += (sum.rgb + sum.a * background) / float(SAMPLES);
        float count = texelFetch(counts, pixel, i).x;
        total_and_deepest.x += count;
        total_and_deepest.y = max(total_and_deepest.y, count);
    }
}
)";

static bool nearest_first(const PeelingLayers &layers)
{
    return layers.func == GL_LESS || layers.func == GL_LEQUAL;
}

static std::string shader_start(const PeelingLayers &layers)
{
    // gl_SampleID makes the shader run once for each sample.
    const bool multisampled = layers.samples > 0;
    return fmt::format("#version 330\n{}"
                       "#define SAMPLER {}\n#define SAMPLERS {}\n#define SAMPLES {}\n"
                       "#define SAMPLE {}\n"
                       "#define LAYERS {}\n#define EMPTY {}\n#define NEAREST_FIRST {}\n",
                       multisampled ? "#extension GL_ARB_sample_shading : require\n" : "",
                       multisampled ? "sampler2DMS" : "sampler2D",
                       multisampled ? "sampler2DMSArray" : "sampler2DArray",
                       std::max(layers.samples, 1), multisampled ? "gl_SampleID" : "0",
                       layers.count, nearest_first(layers) ? "1.0" : "0.0", nearest_first(layers));
}

static Texture make_target(const Gl &gl, GLenum internal_format, const PeelingLayers &layers)
{
    const auto [width, height] = layers.size;
    return layers.samples > 0
               ? make_texture_2d_multisample(gl, internal_format, layers.samples, width, height)
               : make_texture_2d(gl, internal_format, width, height);
}

Accumulation::Accumulation(const Gl &gl, const PeelingLayers &layers, Program compose,
                           Program average)
    : layers_(layers), compose_(std::move(compose)), average_(std::move(average)),
      sums_(make_target(gl, GL_RGBA32F, layers)), counts_(make_target(gl, GL_R32F, layers)),
      framebuffer_(gl),
      picture_(make_texture_2d(gl, GL_RGBA32F, layers.size.width, layers.size.height)),
      picture_counts_(make_texture_2d(gl, GL_RG32F, layers.size.width, layers.size.height)),
      picture_framebuffer_(gl), empty_(gl)
{
    compose_.use();
    gl.Uniform1i(compose_.uniform("colors"), 0);
    gl.Uniform1i(compose_.uniform("depths"), 1);
    average_.use();
    gl.Uniform1i(average_.uniform("sums"), 0);
    gl.Uniform1i(average_.uniform("counts"), 1);
}

void Accumulation::attach(const Framebuffer &framebuffer, GLenum target, const Texture &first,
                          const Texture &second) const
{
    const Gl &gl = framebuffer.gl();
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, target, first.id(), 0);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, target, second.id(), 0);
    const std::array<GLenum, 2> both{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    gl.DrawBuffers(2, both.data());
}

Result<Accumulation> Accumulation::make(const Gl &gl, const PeelingLayers &layers)
{
    const std::string start = shader_start(layers);
    auto compose = Program::make(gl, full_screen_vertex_shader, start + compose_shader);
    if (!compose)
        return compose.error();
    auto average = Program::make(gl, full_screen_vertex_shader, start + average_shader);
    if (!average)
        return average.error();
    Accumulation accumulation(gl, layers, std::move(*compose), std::move(*average));
    accumulation.attach(accumulation.picture_framebuffer_, GL_TEXTURE_2D, accumulation.picture_,
                        accumulation.picture_counts_);
    if (auto complete = check_framebuffer(gl); !complete)
        return complete.error();
    accumulation.attach(accumulation.framebuffer_,
                        layers.samples > 0 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D,
                        accumulation.sums_, accumulation.counts_);
    if (auto complete = check_framebuffer(gl); !complete)
        return complete.error();
    return accumulation;
}

void Accumulation::clear() const
{
    const Gl &gl = framebuffer_.gl();
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    const std::array<float, 4> nothing{0.0F, 0.0F, 0.0F, 1.0F};
    const std::array<float, 4> zero{};
    gl.ClearBufferfv(GL_COLOR, 0, nothing.data());
    gl.ClearBufferfv(GL_COLOR, 1, zero.data());
}

void Accumulation::add(const DepthPeeling &peeling) const
{
    const Gl &gl = framebuffer_.gl();
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    gl.Viewport(0, 0, layers_.size.width, layers_.size.height);
    gl.Disable(GL_DEPTH_TEST);
    gl.Enable(GL_BLEND);
    if (nearest_first(layers_))
        gl.BlendFuncSeparatei(0, GL_DST_ALPHA, GL_ONE, GL_ZERO, GL_SRC_ALPHA);
    else
        gl.BlendFuncSeparatei(0, GL_ONE, GL_SRC_ALPHA, GL_ZERO, GL_SRC_ALPHA);
    gl.BlendFunci(1, GL_ONE, GL_ONE);
    peeling.bind_textures();
    compose_.use();
    draw_full_screen(gl, empty_);
    gl.Disable(GL_BLEND);
}

void Accumulation::finish(glm::vec3 background) const
{
    const Gl &gl = framebuffer_.gl();
    gl.BindFramebuffer(GL_FRAMEBUFFER, picture_framebuffer_.id());
    gl.Viewport(0, 0, layers_.size.width, layers_.size.height);
    const GLenum target = layers_.samples > 0 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D;
    gl.ActiveTexture(GL_TEXTURE1);
    gl.BindTexture(target, counts_.id());
    gl.ActiveTexture(GL_TEXTURE0);
    gl.BindTexture(target, sums_.id());
    average_.use();
    gl.Uniform3f(average_.uniform("background"), background.r, background.g, background.b);
    draw_full_screen(gl, empty_);
}

Accumulation::Count Accumulation::count() const
{
    const Gl &gl = framebuffer_.gl();
    // A framebuffer of its own, as pictures are read from attachment 0.
    const Framebuffer counts(gl);
    gl.BindFramebuffer(GL_FRAMEBUFFER, counts.id());
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                            picture_counts_.id(), 0);
    Count count;
    for (const glm::vec4 &pixel : read_color(gl, counts.id(), layers_.size).pixels) {
        count.fragments += static_cast<std::uint64_t>(pixel.x);
        count.deepest = std::max(count.deepest, static_cast<int>(pixel.y));
    }
    return count;
}

} // namespace kb
