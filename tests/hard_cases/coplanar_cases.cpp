// SPDX-License-Identifier: MIT
//
// Fragments of equal or nearly equal depth: none is lost, and their order is that of arrival.

#include "tests/hard_cases/cases.hpp"
#include "tests/hard_cases/model.hpp"

#include <array>
#include <utility>

namespace kb::hard
{

namespace
{

// What the cuts show: exact in eight bits, too.
constexpr double first_value = 1.0;
constexpr double second_value = 51.0 / 255.0;

/// 1. Both cuts have a fragment in every sample, but where they round differently one is in front
/// of the other. With alphas of a half all sums are exact.
Outcome two_triangulations(const Gl &gl, Method &method, const Shape &shape)
{
    const auto c = receding_plane();
    Scene scene{.projection = perspective()};
    append_quad(scene.mesh, c, {first_value, 0.5, 1});
    append_quad(scene.mesh, {c[1], c[2], c[3], c[0]}, {second_value, 0.5, 2});
    const SceneInGl in_gl(gl, scene);
    const Layers layers = method.draw(shape, [&] { in_gl.draw(); });

    const auto over = [](double front, double back) { return 0.5 * front + 0.25 * back; };
    const auto second = static_cast<double>(static_cast<float>(second_value));
    Outcome outcome{{"samples with 2 fragments, %", 100.0,
                     percentage(layers, [](const auto &f) { return f.size() == 2; })}};
    append_extremes(outcome, "alpha", 0.75, extremes(layers, coverage));
    outcome.push_back({"samples of a third color, %", 0.0, percentage(layers, [&](const auto &f) {
                           double color = 0.0;
                           double part = 1.0;
                           for (const Fragment &fragment : f)
                               color += static_cast<double>(fragment.value) * (part *= 0.5);
                           return color != over(first_value, second) &&
                                  color != over(second, first_value);
                       })});
    return outcome;
}

/// 2. The powers of 3/4 up to the fourth have 8 bits: exact.
Outcome duplicates(const Gl &gl, Method &method, const Shape &shape)
{
    Scene scene{.projection = perspective()};
    for (int i = 0; i < 4; ++i)
        append_quad(scene.mesh, receding_plane(), {1.0, 0.25, i + 1});
    const SceneInGl in_gl(gl, scene);
    const Layers layers = method.draw(shape, [&] { in_gl.draw(); });

    Outcome outcome;
    append_extremes(outcome, "alpha", 0.68359375, extremes(layers, coverage));
    outcome.push_back(
        {"samples with all 4 in order of arrival, %", 100.0,
         percentage(layers, [](const auto &f) { return f.size() == 4 && ids_count_from(f, 1); })});
    return outcome;
}

/// 3. Red (1), then blue (2).
Outcome ties_by_arrival(const Gl &gl, Method &method, const Shape &shape)
{
    Scene scene{.projection = perspective()};
    append_quad(scene.mesh, receding_plane(), {first_value, 0.5, 1});
    append_quad(scene.mesh, receding_plane(), {second_value, 0.5, 2});
    const SceneInGl in_gl(gl, scene);
    const bool first_in_front = shape.func == GL_LESS || shape.func == GL_GREATER;
    const std::pair<float, float> order =
        first_in_front ? std::pair(1.0F, 2.0F) : std::pair(2.0F, 1.0F);
    const auto right = [&](const Layers &layers) {
        return percentage(layers, [&](const auto &f) {
            return f.size() == 2 && std::pair(f[0].id, f[1].id) == order;
        });
    };
    const std::string what =
        first_in_front ? "red over blue, % of samples" : "blue over red, % of samples";

    Outcome outcome;
    Shape own = shape;
    for (const int k : {2, 3, 8}) {
        own.k = k;
        outcome.push_back({what + ", k = " + std::to_string(k), 100.0,
                           right(method.draw(own, [&] { in_gl.draw(); }))});
    }
    if (method.continues() && first_in_front) {
        own.k = 1;
        const auto passes = method.draw_passes(own, 3, [&] { in_gl.draw(); });
        outcome.push_back({what + ", two passes of k = 1", 100.0, right(join(passes))});
    }
    return outcome;
}

/// 4. What all passes found, one behind the other, is 1 to 40.
Outcome ties_across_passes(const Gl &gl, Method &method, const Shape &shape)
{
    constexpr int count = 40;
    Scene scene{.projection = perspective()};
    for (int i = 0; i < count; ++i)
        append_quad(scene.mesh, receding_plane(), {1.0, 0.5, i + 1});
    const SceneInGl in_gl(gl, scene);
    Shape own = shape;
    own.k = method.continues() ? 8 : count;
    const auto passes = method.draw_passes(own, count, [&] { in_gl.draw(); });
    const Layers all = join(passes);

    Outcome outcome{{"passes", method.continues() ? 5.0 : 1.0, static_cast<double>(passes.size())}};
    append_extremes(outcome, "fragments of a sample", count,
                    extremes(all, [](const auto &f) { return f.size(); }));
    outcome.push_back(
        {"samples with every id once, in order of arrival, %", 100.0,
         percentage(all, [](const auto &f) { return f.size() == count && ids_count_from(f, 1); })});
    return outcome;
}

} // namespace

std::vector<Case> coplanar_cases()
{
    return {
        {1, "coplanar, different triangulations",
         "One perspective plane cut along both diagonals, alpha .5 each: 2 fragments everywhere, "
         "alpha .75 exactly, one of the two orders and never a third color",
         with_and_without_samples({{"", {.k = 4}}}), two_triangulations, "", false},
        {2, "exact duplicates",
         "The same quad 4 times, alpha .25: alpha 1 - .75^4 = .68359375 exactly",
         with_and_without_samples({{"", {.k = 8}}}), duplicates},
        {3, "ties by arrival",
         "Two quads of equal depth, red then blue: LESS and GREATER red over blue, LEQUAL and "
         "GEQUAL blue over red, in every pass structure",
         with_and_without_samples({{"LESS", {.func = GL_LESS}},
                                   {"LEQUAL", {.func = GL_LEQUAL}},
                                   {"GREATER", {.func = GL_GREATER}},
                                   {"GEQUAL", {.func = GL_GEQUAL}}}),
         ties_by_arrival},
        {4, "ties across a pass boundary",
         "40 coplanar quads with ids of their own, k = 8, five passes: every id once, in order of "
         "arrival (a k-buffer program, which does not go on, takes one pass with k = 40)",
         with_and_without_samples({{"", {}}}), ties_across_passes},
    };
}

} // namespace kb::hard
