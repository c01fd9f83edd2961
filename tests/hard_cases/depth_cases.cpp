// SPDX-License-Identifier: MIT
//
// Depths that differ by little, or by much, or not at all.

#include "tests/hard_cases/cases.hpp"

#include <algorithm>
#include <cmath>

namespace kb::hard
{

namespace
{

constexpr int plane_count = 16;

/// 5. Planes 2^-24 apart from .75 up. Floats there are 2^-24 apart: the planes are exact. Codes of
/// 24 bits are 2^-24 (1 + 2^-24) apart: 16 codes. Codes of 32 bits are finer than floats. A code of
/// 16 bits is 2^-16 (1 + 2^-16) wide: .75 * 65535 = 49151.25, and the last plane lies 15/256 of a
/// code further, so all round to 49151, and stay in order of arrival.
Outcome neighbours(const Gl &gl, Method &method, const Shape &shape)
{
    std::vector<int> order;
    for (int i = 0; i < plane_count; ++i)
        order.push_back(i);
    shuffle(order, 5);
    Scene scene;
    const auto depth_of = [](int i) { return 0.75 + std::ldexp(i, -24); };
    for (const int i : order)
        append_full(scene.mesh, depth_of(i), {1.0, 0.5, i});
    const SceneInGl in_gl(gl, scene);
    const Layers layers = method.draw(shape, [&] { in_gl.draw(); });

    const double greatest = greatest_code(shape.depth_format);
    const auto stored = [greatest](double depth) {
        return greatest == 0.0 ? depth : std::round(depth * greatest) / greatest;
    };
    if (shape.depth_format != GL_DEPTH_COMPONENT16)
        std::ranges::sort(order);
    Outcome outcome;
    append_extremes(outcome, "layers", plane_count,
                    extremes(layers, [](const auto &f) { return f.size(); }));
    outcome.push_back(
        {"samples with the predicted order, %", 100.0, percentage(layers, [&](const auto &f) {
             return std::ranges::equal(f, order, {}, &Fragment::id,
                                       [](int id) { return static_cast<float>(id); });
         })});
    double error = 0.0;
    for (const auto &fragments : layers)
        for (const Fragment &fragment : fragments)
            error = std::max(
                error, std::abs(fragment.depth - stored(depth_of(static_cast<int>(fragment.id)))));
    // Codes of 32 bits may be made of what single precision holds: half of 2^-24 off. With samples
    // a shader reads them, which makes floats of codes by a few roundings: 4 ulp.
    const double tolerance = greatest > 0.0 && shape.samples > 0          ? std::ldexp(1.0, -22)
                             : shape.depth_format == GL_DEPTH_COMPONENT32 ? std::ldexp(1.0, -25)
                                                                          : 0.0;
    outcome.push_back({"depth, greatest error", 0.0, error, tolerance});
    return outcome;
}

/// 6. At .9 floats are 2^-24 apart. Each depth is rounded once from the plane's, which is kept in
/// the scene with the precision of [-1, 1]: no more than half of 2^-24 each.
Outcome no_epsilon(const Gl &gl, Method &method, const Shape &shape)
{
    Scene scene;
    append_full(scene.mesh, 0.9 + 1e-7, {1.0, 0.5, 1});
    append_full(scene.mesh, 0.9, {1.0, 0.5, 0});
    const SceneInGl in_gl(gl, scene);
    const Layers layers = method.draw(shape, [&] { in_gl.draw(); });

    Outcome outcome{
        {"samples with 2 layers, nearer plane first, %", 100.0,
         percentage(layers, [](const auto &f) { return f.size() == 2 && ids_count_from(f, 0); })}};
    append_extremes(
        outcome, "distance of the layers", 1e-7,
        extremes(layers,
                 [](const auto &f) { return f.size() == 2 ? f[1].depth - f[0].depth : 0.0; }),
        std::ldexp(1.0, -24));
    return outcome;
}

/// 7. The window's z is near / w. The driver rounds 1/w, its product with near, near itself and the
/// sum with an offset of 0: each within half an ulp, but 1/w within 1 ulp if it is approximated and
/// refined; 4 ulp of 2^-23 are enough.
Outcome reversed_z(const Gl &gl, Method &method, const Shape &shape)
{
    constexpr float near = 0.01F;
    Scene scene;
    scene.projection = glm::mat4(0.0F);
    scene.projection[0][0] = scene.projection[1][1] = 1.0F;
    scene.projection[2][3] = -1.0F;
    scene.projection[3][2] = near;
    const std::vector order{3, 6, 0, 5, 1, 4, 2};
    for (const int i : order) {
        const auto w = static_cast<float>(std::pow(10.0, i));
        append_triangle(scene.mesh, {{{-w, -w, -w}, {3.0F * w, -w, -w}, {-w, 3.0F * w, -w}}},
                        {1.0, 0.5, i});
    }
    const SceneInGl in_gl(gl, scene);
    gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    const Layers layers = method.draw(shape, [&] { in_gl.draw(); });
    gl.ClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);

    double error = 0.0;
    for (const auto &fragments : layers)
        for (const Fragment &fragment : fragments)
            error = std::max(
                error, std::abs(fragment.depth * std::pow(10.0, static_cast<double>(fragment.id)) /
                                    static_cast<double>(near) -
                                1.0));
    return {{"samples with 7 layers in order, %", 100.0,
             percentage(
                 layers,
                 [&](const auto &f) { return f.size() == order.size() && ids_count_from(f, 0); })},
            {"depth, greatest relative error", 0.0, error, 4.0 * std::ldexp(1.0, -23)}};
}

/// 8. A depth range of nothing maps all depths to one, which is a float's .3.
Outcome flat_depth_range(const Gl &gl, Method &method, const Shape &shape)
{
    constexpr int count = 12;
    Scene scene;
    for (int i = 0; i < count; ++i) {
        const auto z = static_cast<float>(i * 5 % count + 1) / 16.0F;
        append_triangle(scene.mesh,
                        {{{-1.0F, -1.0F, z}, {3.0F, -1.0F, z / 2.0F}, {-1.0F, 3.0F, z / 3.0F}}},
                        {1.0, 0.5, i});
    }
    const SceneInGl in_gl(gl, scene);
    gl.DepthRange(0.3, 0.3);
    const Layers layers = method.draw(shape, [&] { in_gl.draw(); });
    gl.DepthRange(0.0, 1.0);

    Outcome outcome{
        {"samples with all 12 in order of arrival, %", 100.0, percentage(layers, [](const auto &f) {
             return f.size() == count && ids_count_from(f, 0);
         })}};
    double error = 0.0;
    for (const auto &fragments : layers)
        for (const Fragment &fragment : fragments)
            error = std::max(error, std::abs(fragment.depth - static_cast<double>(0.3F)));
    outcome.push_back({"depth, greatest difference from .3", 0.0, error});
    return outcome;
}

} // namespace

std::vector<Case> depth_cases()
{
    return {
        {5, "neighbours in depth",
         "16 planes 2^-24 apart from .75 on, shuffled: 16 layers in order in 32F, 24 and 32 bits; "
         "in 16 bits the predicted merges, and none lost",
         with_and_without_samples(
             {{"32F", {.k = plane_count + 1, .depth_format = GL_DEPTH_COMPONENT32F}},
              {"24 bits", {.k = plane_count + 1, .depth_format = GL_DEPTH_COMPONENT24}},
              {"32 bits", {.k = plane_count + 1, .depth_format = GL_DEPTH_COMPONENT32}},
              {"16 bits", {.k = plane_count + 1, .depth_format = GL_DEPTH_COMPONENT16}}}),
         neighbours},
        {6, "no epsilon", "Planes 1.0e-7 apart at z = .9: 2 layers",
         with_and_without_samples({{"", {.k = 3}}}), no_epsilon},
        {7, "reversed Z, infinite far plane",
         "Planes at w = 10^i, i = 0 to 6, near plane .01, ZERO_TO_ONE, GREATER: 7 layers in order",
         with_and_without_samples({{"", {.func = GL_GREATER}}}), reversed_z},
        {8, "flat depth", "glDepthRange(.3, .3): all depths are equal, order of arrival",
         with_and_without_samples({{"", {.k = 16}}}), flat_depth_range},
    };
}

} // namespace kb::hard
