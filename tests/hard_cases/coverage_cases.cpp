// SPDX-License-Identifier: MIT
//
// Which samples a primitive covers, and with what depth at their edges.

#include "tests/hard_cases/cases.hpp"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace kb::hard
{

namespace
{

/// The places of vertices on a grid of 1/256 pixel, which a view of 64x64 pixels represents exactly
/// from [-1, 1] on.
constexpr Size grid_size{64, 64};
constexpr int grid_steps = 256 * 64;
float on_grid(int step)
{
    return static_cast<float>(step) / static_cast<float>(grid_steps / 2) - 1.0F;
}

/// 9. Needles along rows of samples and across the view, 1/256 pixel high or wide. A driver may
/// compute depths as z0 + x dz/dx + y dz/dy: gradients are up to 256 a pixel, over 64 pixels terms
/// are up to 2^14. Single precision rounds 2 products and 3 sums by 2^-25 of that, 2 gradients by
/// 2^-24: 9 * 2^-11 in all.
Outcome slivers(const Gl &gl, Method &method, const Shape &shape)
{
    constexpr int count = 256;
    Scene scene;
    std::vector<Extremes> depths;
    std::mt19937 random(9);
    const auto choose = [&random](int n) { return static_cast<int>(random() % std::uint32_t(n)); };
    for (int i = 0; i < count; ++i) {
        // Where llvmpipe's 4 samples of a pixel lie, or its center.
        const int row = 256 * choose(64) + (shape.samples > 0 ? 32 + 64 * choose(4) : 128);
        const int raised = choose(3);
        const int step = choose(2) == 0 ? 1 : -1;
        std::array<glm::vec3, 3> corners{};
        Extremes own{1.0, 0.0};
        for (int c = 0; c < 3; ++c) {
            const double depth = (1 + choose(4094)) / 4096.0;
            own = {std::min(own.least, depth), std::max(own.greatest, depth)};
            const float along = on_grid(choose(grid_steps + 1));
            const float across = on_grid(std::min(row + (c == raised ? step : 0), grid_steps));
            const auto z = static_cast<float>(2.0 * depth - 1.0);
            corners.at(static_cast<std::size_t>(c)) =
                i % 2 == 0 ? glm::vec3(along, across, z) : glm::vec3(across, along, z);
        }
        append_triangle(scene.mesh, corners, {1.0, 0.5, i});
        depths.push_back(own);
    }
    const SceneInGl in_gl(gl, scene);
    const Query query(gl);
    const Layers layers = method.draw(shape, [&] {
        gl.BeginQuery(GL_SAMPLES_PASSED, query.id());
        in_gl.draw();
        gl.EndQuery(GL_SAMPLES_PASSED);
    });
    GLuint inserted = 0;
    gl.GetQueryObjectuiv(query.id(), GL_QUERY_RESULT, &inserted);
    double fragment_count = 0.0;

    double outside = 0.0;
    std::vector<bool> seen(count);
    for (const auto &fragments : layers)
        for (const Fragment &fragment : fragments) {
            const auto id = static_cast<std::size_t>(fragment.id);
            outside = std::max({outside, depths.at(id).least - fragment.depth,
                                fragment.depth - depths.at(id).greatest});
            seen.at(id) = true;
            fragment_count += 1.0;
        }
    // Their long edges run through samples, and belong to the needles on one side of it.
    return {
        {"needles with fragments", count / 2, double(std::ranges::count(seen, true)), count / 8},
        {"fragments, of which an occlusion query counted", double(inserted), fragment_count},
        {"depth outside of the vertices' range, at most", 0.0, outside, 9.0 * 0x1p-11}};
}

/// 9. Each ray that enters a closed surface leaves it: also in pixels along the silhouette, whose
/// triangles are slivers. A disk of radius .9 of a square view covers pi/4 * .81; the polygon's
/// corners and the samples at its edge (of 2 pi .9 * 26 pixels, half on each side) make less
/// than .01.
Outcome closed_sphere(const Gl &gl, Method &method, const Shape &shape)
{
    constexpr float radius = 0.9F;
    Scene scene{.mesh = make_closed_sphere(radius, 96, 64),
                .fragment_statements = "    color.r = gl_FrontFacing ? 1.0 : -1.0;"};
    const SceneInGl in_gl(gl, scene);
    const Layers layers = method.draw(shape, [&] { in_gl.draw(); });
    return {{"covered samples, %", 100.0 * glm::pi<double>() / 4.0 * 0.81,
             percentage(layers, [](const auto &f) { return !f.empty(); }), 1.0},
            {"samples with as many front as back faces, %", 100.0,
             percentage(layers, [](const auto &f) {
                 float sum = 0.0F;
                 for (const Fragment &fragment : f)
                     sum += fragment.value;
                 return sum == 0.0F;
             })}};
}

/// 24. Two quads that share a slanted edge: every sample lies in exactly one of them. With alphas
/// of a half all sums are exact.
Outcome abutting(const Gl &gl, Method &method, const Shape &shape)
{
    Outcome outcome;
    // In one plane, and with a step at the edge.
    for (const float step : {0.0F, 0.25F}) {
        const Scene scene = make_abutting_quads(step);
        const SceneInGl in_gl(gl, scene);
        const Layers layers = method.draw(shape, [&] { in_gl.draw(); });

        // The average of a pixel's samples: what a resolve makes of them.
        const auto samples = static_cast<std::size_t>(std::max(shape.samples, 1));
        const std::size_t pixels = layers.size() / samples;
        Extremes resolved{1.0, 0.0};
        std::size_t divided = 0;
        for (std::size_t p = 0; p < pixels; ++p) {
            double sum = 0.0;
            std::size_t of_first = 0;
            for (std::size_t s = 0; s < samples; ++s) {
                const auto &fragments = layers[s * pixels + p];
                sum += coverage(fragments);
                of_first += !fragments.empty() && fragments.front().id == 1.0F ? 1 : 0;
            }
            divided += of_first > 0 && of_first < samples ? 1 : 0;
            sum /= static_cast<double>(samples);
            resolved = {std::min(resolved.least, sum), std::max(resolved.greatest, sum)};
        }
        const std::string name = step == 0.0F ? "one plane: " : "a step in depth: ";
        outcome.push_back({name + "samples with one fragment, %", 100.0,
                           percentage(layers, [](const auto &f) { return f.size() == 1; })});
        append_extremes(outcome, name + "alpha of pixels", 0.5, resolved);
        if (samples > 1) {
            // The edge crosses 52 rows of pixels, and moves by .27 pixels in each. Samples of a
            // pixel span .75: it divides a pixel in .75 - .27 of the rows at least, and no more
            // pixels than it meets, 52 + 14.
            outcome.push_back(
                {name + "pixels that the edge divides", 45.0, static_cast<double>(divided), 21.0});
        }
    }
    return outcome;
}

} // namespace

std::vector<Case> coverage_cases()
{
    return {
        {9, "slivers", "Needle triangles 1/256 pixel high: z within the range of the vertices",
         with_and_without_samples({{"", {.k = 32, .size = grid_size}}}), slivers, "", false},
        {9, "closed sphere", "As many front as back faces in every sample, at the silhouette too",
         with_and_without_samples({{"", {.k = 16}}}), closed_sphere, "", false},
        {24, "MSAA edge",
         "Two abutting quads, alpha .5: .5 everywhere, no seam (.625 is the wrong answer)",
         with_and_without_samples({{"", {.k = 4}}}), abutting, "", false},
    };
}

} // namespace kb::hard
