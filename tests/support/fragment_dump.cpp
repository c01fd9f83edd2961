// SPDX-License-Identifier: MIT
//
// Draws each triangle of a mesh alone, without blending, depth test or any k-buffer, and writes all
// fragments in the order of drawing: what a correct k-buffer must have been given. Meant for stock
// Mesa. Each fragment is six 32-bit values: sample (from the bottom left pixel, row by row, the
// samples of a pixel in a row), depth as the depth buffer has it, RGBA.
//
//     fragment-dump MESH SIZE ALPHA FILE [DEPTH_FORMAT [SAMPLES]]
//
// ALPHA below 0: that of the vertices. DEPTH_FORMAT: 32f, 24 or 16. SAMPLES: 0 is no multisampling.

#include "lib/gl/context.hpp"
#include "lib/gl/mesh_buffers.hpp"
#include "lib/io/output_file.hpp"
#include "transparency/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <vector>

namespace
{

constexpr float nothing = -1.0F; // The alpha of no fragment.

constexpr const char *copy_sample_shader = R"(#version 330
uniform sampler2DMS color;
uniform sampler2DMS depth;
uniform int index;
layout(location = 0) out vec4 result;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    result = texelFetch(color, pixel, index);
    gl_FragDepth = texelFetch(depth, pixel, index).x;
}
)";

/// A color and a depth texture, and the framebuffer that they are attached to.
struct Target {
    kb::Texture color;
    kb::Texture depth;
    kb::Framebuffer framebuffer;
};

kb::Result<Target> make_target(const kb::Gl &gl, int side, GLenum depth_format, int samples)
{
    const auto make = [&](GLenum format) {
        return samples > 0 ? kb::make_texture_2d_multisample(gl, format, samples, side, side)
                           : kb::make_texture_2d(gl, format, side, side);
    };
    Target target{make(GL_RGBA32F), make(depth_format), kb::Framebuffer(gl)};
    const GLenum kind = samples > 0 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D;
    gl.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.id());
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, kind, target.color.id(), 0);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, kind, target.depth.id(), 0);
    if (auto complete = kb::check_framebuffer(gl); !complete)
        return complete.error();
    return target;
}

/// Copies one sample of all pixels to a target without samples, from which it can be read.
class SampleCopy
{
public:
    static kb::Result<SampleCopy> make(const kb::Gl &gl, int side)
    {
        auto program = kb::Program::make(gl, kb::full_screen_vertex_shader, copy_sample_shader);
        if (!program)
            return program.error();
        // A format that holds the values of all others.
        auto target = make_target(gl, side, GL_DEPTH_COMPONENT32F, 0);
        if (!target)
            return target.error();
        return SampleCopy(std::move(*program), std::move(*target), kb::VertexArray(gl));
    }

    void copy(const Target &source, int sample) const
    {
        const kb::Gl &gl = source.framebuffer.gl();
        gl.BindFramebuffer(GL_FRAMEBUFFER, target_.framebuffer.id());
        gl.ActiveTexture(GL_TEXTURE1);
        gl.BindTexture(GL_TEXTURE_2D_MULTISAMPLE, source.depth.id());
        gl.ActiveTexture(GL_TEXTURE0);
        gl.BindTexture(GL_TEXTURE_2D_MULTISAMPLE, source.color.id());
        program_.use();
        gl.Uniform1i(program_.uniform("depth"), 1);
        gl.Uniform1i(program_.uniform("index"), sample);
        kb::draw_full_screen(gl, empty_);
    }

private:
    SampleCopy(kb::Program program, Target target, kb::VertexArray empty)
        : program_(std::move(program)), target_(std::move(target)), empty_(std::move(empty))
    {
    }

    kb::Program program_;
    Target target_;
    kb::VertexArray empty_;
};

/// Appends the fragments of one sample of all pixels, read from the framebuffer that is bound.
void append_fragments(const kb::Gl &gl, int side, int sample, int samples,
                      std::vector<std::uint32_t> &words)
{
    const auto pixel_count = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
    std::vector<std::array<float, 4>> colors(pixel_count);
    std::vector<float> depths(pixel_count);
    gl.ReadPixels(0, 0, side, side, GL_RGBA, GL_FLOAT, colors.data());
    gl.ReadPixels(0, 0, side, side, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
    for (std::size_t p = 0; p < pixel_count; ++p) {
        if (colors[p][3] == nothing)
            continue;
        words.push_back(static_cast<std::uint32_t>(p) * static_cast<std::uint32_t>(samples) +
                        static_cast<std::uint32_t>(sample));
        words.push_back(std::bit_cast<std::uint32_t>(depths[p]));
        for (const float channel : colors[p])
            words.push_back(std::bit_cast<std::uint32_t>(channel));
    }
}

struct Options {
    const char *mesh;
    int side;
    float alpha;
    const char *file;
    GLenum depth_format = GL_DEPTH_COMPONENT32F;
    int samples = 0;
};

kb::Status dump(const kb::Gl &gl, const kb::Mesh &mesh, const Options &options)
{
    const int side = options.side;
    const auto program = kb::Scene::make_program(gl);
    if (!program)
        return program.error();
    const kb::Scene scene(gl, mesh,
                          options.alpha < 0.0F ? std::nullopt : std::optional(options.alpha));
    const auto copy = SampleCopy::make(gl, side);
    if (!copy)
        return copy.error();
    const auto target = make_target(gl, side, options.depth_format, options.samples);
    if (!target)
        return target.error();

    gl.Viewport(0, 0, side, side);
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_ALWAYS);
    gl.ClearColor(0.0F, 0.0F, 0.0F, nothing);
    std::vector<std::uint32_t> words;
    for (std::size_t triangle = 0; triangle < scene.triangle_count(); ++triangle) {
        gl.BindFramebuffer(GL_FRAMEBUFFER, target->framebuffer.id());
        gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        scene.draw_triangle(*program, {}, {side, side}, triangle);
        if (options.samples == 0)
            append_fragments(gl, side, 0, 1, words);
        for (int sample = 0; sample < options.samples; ++sample) {
            copy->copy(*target, sample);
            append_fragments(gl, side, sample, options.samples, words);
        }
    }
    if (auto drawn = kb::check_gl(gl, "drawing"); !drawn)
        return drawn;
    return kb::write_file(options.file, std::as_bytes(std::span(words)));
}

kb::Status run(const Options &options)
{
    const auto loaded = kb::load_mesh(options.mesh);
    if (!loaded)
        return loaded.error();
    auto context = kb::make_context("osmesa");
    if (!context)
        return context.error();
    return dump((*context)->gl(), loaded->mesh, options);
}

} // namespace

int main(int argc, char **argv)
{
    if (argc < 5 || argc > 7) {
        fmt::print(stderr, "usage: fragment-dump MESH SIZE ALPHA FILE [DEPTH_FORMAT [SAMPLES]]\n");
        return 2;
    }
    Options options{argv[1], std::atoi(argv[2]), std::strtof(argv[3], nullptr), argv[4]};
    const std::string_view depth_format = argc > 5 ? argv[5] : "32f";
    if (depth_format == "24")
        options.depth_format = GL_DEPTH_COMPONENT24;
    else if (depth_format == "16")
        options.depth_format = GL_DEPTH_COMPONENT16;
    if (argc > 6)
        options.samples = std::atoi(argv[6]);
    if (const auto done = run(options); !done) {
        fmt::print(stderr, "fragment-dump: {}\n", done.error().message);
        return 1;
    }
    return 0;
}
