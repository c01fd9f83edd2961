// SPDX-License-Identifier: MIT

#include "bench/layer_resolve.hpp"

#include "bench/background.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kb::bench
{

// In llvmpipe a turn of a loop costs as much as several loads: a turn takes this many layers, and
// deep pixels pay for few turns, shallow ones for few layers that they do not have. imageLoad is
// shorter code than texelFetch.
constexpr int layers_a_turn = 8;

static std::string resolve_source(int layers, EmptyLayers empty_layers)
{
    std::string source = R"(
layout(binding = 0, rgba8) readonly uniform image2DArray layers;
out vec4 color;
vec3 sum = vec3(0.0);
float transmittance = 1.0;

void add(vec4 fragment)
{
    sum += transmittance * fragment.a * fragment.rgb;
    transmittance *= 1.0 - fragment.a;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
)";
    const auto add_layers = [&source](const char *first, int count, bool may_end) {
        for (int i = 0; i < count; ++i)
            source += fmt::format(
                "        vec4 fragment{0} = imageLoad(layers, ivec3(pixel, {1} + {0}));\n", i,
                first);
        if (may_end)
            source += "        if (fragment0.a == 0.0)\n            break;\n";
        for (int i = 0; i < count; ++i)
            source += fmt::format("        add(fragment{});\n", i);
    };
    // If all have to be looked at, no loop is fastest.
    const int turns = empty_layers == EmptyLayers::behind ? layers / layers_a_turn : 0;
    if (turns > 0) {
        source += fmt::format("    for (int first = 0; first < {}; first += {}) {{\n",
                              turns * layers_a_turn, layers_a_turn);
        add_layers("first", layers_a_turn, true);
        source += "    }\n";
    }
    source += "    {\n";
    add_layers(fmt::format("{}", turns * layers_a_turn).c_str(), layers - turns * layers_a_turn,
               false);
    source += "    }\n";
    return source +
           fmt::format("    color = vec4(sum + transmittance * {}, 1.0);\n}}\n", background_glsl());
}

LayerResolve::LayerResolve(const Gl &gl, int layers, EmptyLayers empty_layers)
    : gl_(gl), program_(make_view_program(gl, resolve_source(layers, empty_layers))), empty_(gl)
{
}

void LayerResolve::draw(const Texture &layers, GLuint target) const
{
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target);
    gl_.BindImageTexture(0, layers.id(), 0, GL_TRUE, 0, GL_READ_ONLY, GL_RGBA8);
    program_.use();
    draw_full_screen(gl_, empty_);
}

} // namespace kb::bench
