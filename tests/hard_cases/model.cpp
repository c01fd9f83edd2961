// SPDX-License-Identifier: MIT

#include "tests/hard_cases/model.hpp"

#include "bench/gl_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kb::hard
{

using bench::must;

static constexpr int nan_id = 1000; ///< And above: the shader makes their depth a NaN.

Scene make_mixture(std::uint32_t seed)
{
    Scene scene{.fragment_statements =
                    "    gl_FragDepth = surface.b >= 1000.0 ? uintBitsToFloat(0x7fc00000u)\n"
                    "                                       : gl_FragCoord.z;"};
    std::mt19937 random(seed);
    const auto coordinate = [&random](double low, double high) {
        return static_cast<float>(low + (high - low) * static_cast<double>(random() >> 8U) *
                                            std::ldexp(1.0, -24));
    };
    const auto attributes = [&](int id) {
        constexpr std::array alphas{0.0, 0.25, 0.5, 0.75, 1.0};
        return Attributes{(random() % 256) / 255.0, alphas.at(random() % alphas.size()), id};
    };
    int id = 0;
    for (int i = 0; i < 6; ++i) {
        // A plane across the view, whole and cut the other way, up to three times each.
        const float a = coordinate(-0.4, 0.4);
        const float b = coordinate(-0.4, 0.4);
        const float base = coordinate(-0.2, 0.2);
        const auto corner = [&](float x, float y) { return glm::vec3(x, y, base + a * x + b * y); };
        const std::array c{corner(-1.0F, -1.0F), corner(1.0F, -1.0F), corner(1.0F, 1.0F),
                           corner(-1.0F, 1.0F)};
        for (std::uint32_t n = random() % 3 + 1; n > 0; --n) {
            append_quad(scene.mesh, c, attributes(id++));
            append_quad(scene.mesh, {c[1], c[2], c[3], c[0]}, attributes(id++));
        }
        // Depths one float apart, of which two are the same.
        const double depth = 0.5 + std::ldexp(random() % 0x400000, -23);
        for (const int step : {2, 0, 1, 0})
            append_full(scene.mesh, depth + std::ldexp(step, -24), attributes(id++));
        // Loose triangles through the whole range, beyond the view and the planes.
        for (int t = 0; t < 3; ++t) {
            std::array<glm::vec3, 3> corners{};
            for (glm::vec3 &p : corners)
                p = {coordinate(-1.5, 1.5), coordinate(-1.5, 1.5), coordinate(-1.2, 1.2)};
            append_triangle(scene.mesh, corners, attributes(id++));
        }
        append_full(scene.mesh, 0.25, attributes(nan_id + i));
    }
    return scene;
}

Layers sorted_fragments(const Gl &gl, const Scene &scene, const SceneInGl &in_gl,
                        const Shape &shape)
{
    const LayerReader reader(gl, shape.size, shape.samples);
    const auto make = [&](GLenum format) {
        return shape.samples > 0
                   ? make_texture_2d_multisample_array(gl, format, shape.samples, shape.size.width,
                                                       shape.size.height, 1)
                   : make_texture_2d_array(gl, format, shape.size.width, shape.size.height, 1);
    };
    const Texture color = make(GL_RGBA32F);
    const Texture depth = make(shape.depth_format);
    const Framebuffer framebuffer(gl);
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
    gl.FramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, color.id(), 0);
    gl.FramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, depth.id(), 0);
    must(check_framebuffer(gl));

    constexpr float nothing = -1.0F; // No fragment's id.
    Layers layers(reader.pixels() * static_cast<std::size_t>(reader.samples()));
    for (std::size_t triangle = 0; triangle < scene.mesh.triangle_count(); ++triangle) {
        const glm::vec4 &surface = scene.mesh.colors[scene.mesh.indices[3 * triangle]];
        if (surface.b >= static_cast<float>(nan_id))
            continue;
        gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
        gl.Viewport(0, 0, shape.size.width, shape.size.height);
        gl.Enable(GL_DEPTH_TEST);
        gl.DepthFunc(GL_ALWAYS);
        gl.ClearColor(0.0F, 0.0F, nothing, 0.0F);
        gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        in_gl.draw_triangle(triangle);
        gl.Disable(GL_DEPTH_TEST);
        for (int sample = 0; sample < reader.samples(); ++sample) {
            const auto colors = reader.read_color(color, 0, sample);
            const auto depths = reader.read_depth(depth, shape.depth_format, 0, sample);
            for (std::size_t p = 0; p < reader.pixels(); ++p)
                if (colors[p].b != nothing && depths[p] != shape.empty_depth())
                    layers[reader.pixels() * static_cast<std::size_t>(sample) + p].push_back(
                        {depths[p], surface.r, surface.g, surface.b});
        }
    }
    const bool farthest_first = shape.func == GL_GREATER || shape.func == GL_GEQUAL;
    const bool last_first = shape.func == GL_LEQUAL || shape.func == GL_GEQUAL;
    for (auto &fragments : layers) {
        if (last_first)
            std::ranges::reverse(fragments);
        std::ranges::stable_sort(fragments, [farthest_first](const auto &a, const auto &b) {
            return farthest_first ? a.depth > b.depth : a.depth < b.depth;
        });
    }
    return layers;
}

Layers cut_out(const Layers &layers, int first, int k)
{
    Layers part(layers.size());
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const auto size = static_cast<std::ptrdiff_t>(layers[i].size());
        part[i].assign(layers[i].begin() + std::min<std::ptrdiff_t>(first, size),
                       layers[i].begin() + std::min<std::ptrdiff_t>(first + k, size));
    }
    return part;
}

double differing(const Layers &a, const Layers &b)
{
    double count = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        count += a[i] == b[i] ? 0.0 : 1.0;
    return 100.0 * count / static_cast<double>(a.size());
}

Layers join(const std::vector<Pass> &passes)
{
    Layers all(passes.front().layers.size());
    for (const Pass &pass : passes)
        for (std::size_t i = 0; i < all.size(); ++i)
            all[i].insert(all[i].end(), pass.layers[i].begin(), pass.layers[i].end());
    return all;
}

std::size_t deepest(const Layers &layers)
{
    std::size_t most = 0;
    for (const auto &fragments : layers)
        most = std::max(most, fragments.size());
    return most;
}

} // namespace kb::hard
