// SPDX-License-Identifier: MIT
//
// All of the other cases at random, against a model.

#include "tests/hard_cases/cases.hpp"

#include "tests/hard_cases/model.hpp"

#include <cmath>

namespace kb::hard
{

namespace
{

/// 25. Colors are flat, and depths are those that the same triangle gets alone: all bits are
/// predicted.
Outcome mixture(const Gl &gl, Method &method, const Shape &shape)
{
    const Scene scene = make_mixture(25);
    const SceneInGl in_gl(gl, scene);
    const Layers model = sorted_fragments(gl, scene, in_gl, shape);
    const auto layer_count = static_cast<int>(deepest(model));

    Outcome outcome;
    double wrong = 0.0;
    for (const int k : {1, 7, 64})
        wrong += [&] {
            Shape own = shape;
            own.k = k;
            return differing(method.draw(own, [&] { in_gl.draw(); }), cut_out(model, 0, k));
        }();
    outcome.push_back({"samples with a layer unlike the model's, k = 1, 7, 64, %", 0.0, wrong});
    outcome.push_back({"layers of the deepest sample (more than 32, all in 64)", 48.0,
                       static_cast<double>(layer_count), 16.0});
    if (method.continues() && (shape.func == GL_LESS || shape.func == GL_GREATER)) {
        Shape own = shape;
        own.k = 9;
        const auto passes = method.draw_passes(own, layer_count, [&] { in_gl.draw(); });
        double wrong_later = 0.0;
        for (std::size_t p = 0; p < passes.size(); ++p)
            wrong_later +=
                differing(passes[p].layers, cut_out(model, own.k * static_cast<int>(p), own.k));
        outcome.push_back(
            {"samples with a layer unlike the model's, all passes of k = 9, %", 0.0, wrong_later});
        outcome.push_back(
            {"passes of k = 9", std::ceil(layer_count / 9.0), static_cast<double>(passes.size())});
    }
    return outcome;
}

} // namespace

std::vector<Case> mixture_cases()
{
    constexpr Size strip{70, 24}; // Two tiles of llvmpipe.
    return {{25, "many coplanar, wide range",
             "A mixture of all above at random, with NaN depths, alpha 0 and 1, coplanar and "
             "repeated planes: every layer is that of a model that sorts the fragments of "
             "triangles drawn alone",
             with_and_without_samples(
                 {{"LESS, 32F", {.func = GL_LESS, .size = strip}},
                  {"LEQUAL, 32F", {.func = GL_LEQUAL, .size = strip}},
                  {"GREATER, 24 bits",
                   {.func = GL_GREATER, .depth_format = GL_DEPTH_COMPONENT24, .size = strip}},
                  {"LESS, 16 bits",
                   {.func = GL_LESS, .depth_format = GL_DEPTH_COMPONENT16, .size = strip}}}),
             mixture}};
}

} // namespace kb::hard
