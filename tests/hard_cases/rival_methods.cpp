// SPDX-License-Identifier: MIT

#include "tests/hard_cases/rival_methods.hpp"

#include "tests/hard_cases/cases.hpp"

#include "bench/gl_scene.hpp"
#include "lib/gl/kbuffer.hpp"

#include <array>
#include <cmath>

namespace kb::hard
{

using bench::must;

Outcome blend_in_eight_bits(const Gl &gl)
{
    constexpr int count = 400;
    constexpr Size size{20, 12};
    Scene scene{.fragment_statements = "    color = vec4(surface.rrr, surface.g);"};
    for (int i = count - 1; i >= 0; --i)
        append_full(scene.mesh, (i + 1) / 512.0, {1.0, 0.01, i});
    const SceneInGl in_gl(gl, scene);
    const Texture texture = make_texture_2d(gl, GL_RGBA8, size.width, size.height);
    const Framebuffer framebuffer(gl);
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture.id(), 0);
    gl.Viewport(0, 0, size.width, size.height);
    gl.ClearColor(0.0F, 0.0F, 0.0F, 0.0F);
    gl.Clear(GL_COLOR_BUFFER_BIT);
    gl.Enable(GL_BLEND);
    gl.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    in_gl.draw();
    gl.Disable(GL_BLEND);
    const ImageRgbaF picture = read_color(gl, framebuffer.id(), size);
    must(check_gl(gl, "blending"));
    return {{"alpha", 1.0 - std::pow(0.99, count), static_cast<double>(picture.at(0, 0).a), 1e-6},
            {"color of white layers", 1.0 - std::pow(0.99, count),
             static_cast<double>(picture.at(0, 0).r), 1e-6}};
}

Outcome peel_edge_with_samples(const Gl &gl)
{
    constexpr int samples = 4;
    constexpr int layer_count = 2;
    const auto [width, height] = usual_size;
    Outcome outcome;
    for (const double step : {0.0, 0.25}) {
        const Scene scene = make_abutting_quads(static_cast<float>(step));
        Scene behind = scene;
        behind.fragment_statements =
            "    if (gl_FragCoord.z <= texelFetch(nearer, ivec2(gl_FragCoord.xy), 0).r)\n"
            "        discard;";
        behind.fragment_declarations = "uniform sampler2DMS nearer;";
        const SceneInGl first(gl, scene);
        const SceneInGl next(gl, behind);
        const LayerReader reader(gl, usual_size, samples);
        const Framebuffer framebuffer(gl);
        const Texture colors =
            make_texture_2d_multisample_array(gl, GL_RGBA32F, samples, width, height, layer_count);
        const std::array depths{
            make_texture_2d_multisample(gl, GL_DEPTH_COMPONENT32F, samples, width, height),
            make_texture_2d_multisample(gl, GL_DEPTH_COMPONENT32F, samples, width, height)};
        for (int layer = 0; layer < layer_count; ++layer) {
            gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
            gl.FramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, colors.id(), 0, layer);
            gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D_MULTISAMPLE,
                                    depths.at(static_cast<std::size_t>(layer)).id(), 0);
            must(check_framebuffer(gl));
            gl.Viewport(0, 0, width, height);
            gl.ClearColor(0.0F, 0.0F, 0.0F, 0.0F);
            gl.ClearDepth(1.0);
            gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            gl.Enable(GL_DEPTH_TEST);
            gl.DepthFunc(GL_LESS);
            gl.BindTexture(GL_TEXTURE_2D_MULTISAMPLE, layer == 0 ? 0 : depths[0].id());
            (layer == 0 ? first : next).draw();
            gl.Disable(GL_DEPTH_TEST);
        }
        must(check_gl(gl, "peeling with samples"));

        std::vector<double> alphas(reader.pixels());
        for (int sample = 0; sample < samples; ++sample) {
            const auto nearest = reader.read_color(colors, 0, sample);
            const auto second = reader.read_color(colors, 1, sample);
            // The attribute alpha is the green channel.
            for (std::size_t p = 0; p < alphas.size(); ++p)
                alphas[p] += (1.0 - (1.0 - static_cast<double>(nearest[p].g)) *
                                        (1.0 - static_cast<double>(second[p].g))) /
                             samples;
        }
        const auto [least, greatest] = std::ranges::minmax(alphas);
        append_extremes(outcome,
                        step == 0.0 ? "one plane: alpha of pixels"
                                    : "a step in depth: alpha of pixels",
                        0.5, {least, greatest});
    }
    return outcome;
}

} // namespace kb::hard
