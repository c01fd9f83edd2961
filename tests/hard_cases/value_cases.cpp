// SPDX-License-Identifier: MIT
//
// Numbers at the limits: NaN and infinity, alpha 0 and 1, many thin layers.

#include "tests/hard_cases/cases.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

namespace kb::hard
{

namespace
{

struct Odd {
    const char *name;
    std::uint32_t bits;
};
constexpr Odd odd_numbers[] = {
    {"NaN", 0x7fc00000}, {"-NaN", 0xffc00000}, {"inf", 0x7f800000}, {"-inf", 0xff800000}};

constexpr int odd_count = 8; ///< Fragments, of which the third is odd.
constexpr int odd_id = 2;

Layers draw_odd(const Gl &gl, Method &method, const Shape &shape, const std::string &statement)
{
    Scene scene{.fragment_statements = "    gl_FragDepth = gl_FragCoord.z;\n"
                                       "    if (surface.b == 2.0)\n        " +
                                       statement};
    for (int i = 0; i < odd_count; ++i)
        append_full(scene.mesh, (i + 1) / 16.0, {i / 8.0, 0.5, i});
    const SceneInGl in_gl(gl, scene);
    return method.draw(shape, [&] { in_gl.draw(); });
}

/// Layers that are not just as they were drawn, in all samples; `odd_value` is what the odd one
/// has.
std::size_t changed_fragments(const Layers &layers, std::uint32_t odd_value)
{
    std::size_t changed = 0;
    for (const auto &fragments : layers)
        for (const Fragment &fragment : fragments) {
            const auto value = static_cast<float>(fragment.id / 8.0F);
            const bool odd = fragment.id == static_cast<float>(odd_id);
            const bool same = std::bit_cast<std::uint32_t>(fragment.value) ==
                                  (odd ? odd_value : std::bit_cast<std::uint32_t>(value)) &&
                              fragment.alpha == 0.5F;
            changed += same ? 0 : 1;
        }
    return changed;
}

/// 10. Clamping to [0, 1] makes infinity 1, which is the empty depth, and its negative 0.
Outcome odd_depths(const Gl &gl, Method &method, const Shape &shape)
{
    Outcome outcome;
    for (const Odd &odd : odd_numbers) {
        const Layers layers = draw_odd(
            gl, method, shape, fmt::format("gl_FragDepth = uintBitsToFloat({}u);", odd.bits));
        const bool in_front = odd.bits == 0xff800000;
        append_extremes(outcome, fmt::format("depth {}: fragments", odd.name), in_front ? 8 : 7,
                        extremes(layers, [](const auto &f) { return f.size(); }));
        outcome.push_back({fmt::format("depth {}: samples with the others in place, %", odd.name),
                           100.0, percentage(layers, [&](auto f) {
                               if (in_front && !f.empty() && f.front().depth == 0.0 &&
                                   f.front().id == static_cast<float>(odd_id))
                                   f.erase(f.begin());
                               for (std::size_t i = 0; i < f.size(); ++i) {
                                   const auto id = static_cast<int>(i < odd_id ? i : i + 1);
                                   if (f[i].id != static_cast<float>(id) ||
                                       f[i].depth != (id + 1) / 16.0)
                                       return false;
                               }
                               return f.size() == odd_count - 1;
                           })});
        outcome.push_back({fmt::format("depth {}: fragments with a changed bit", odd.name), 0.0,
                           static_cast<double>(changed_fragments(
                               layers, std::bit_cast<std::uint32_t>(odd_id / 8.0F)))});
    }
    return outcome;
}

/// 10. Colors are moved, not computed with: they keep all bits.
Outcome odd_colors(const Gl &gl, Method &method, const Shape &shape)
{
    Outcome outcome;
    for (const Odd &odd : odd_numbers) {
        const Layers layers =
            draw_odd(gl, method, shape, fmt::format("color.r = uintBitsToFloat({}u);", odd.bits));
        outcome.push_back({fmt::format("color {}: samples with all 8 in order, %", odd.name), 100.0,
                           percentage(layers, [](const auto &f) {
                               return f.size() == odd_count && ids_count_from(f, 0);
                           })});
        outcome.push_back({fmt::format("color {}: fragments with a changed bit", odd.name), 0.0,
                           static_cast<double>(changed_fragments(layers, odd.bits))});
    }
    return outcome;
}

/// 12. Six layers, drawn in the order 0 5 4 3 2 1, after the third of them an extra one at each
/// rank. Adding 0 and multiplying by 1 changes no bit; behind alpha 1 everything is multiplied by
/// 0.
Outcome transparent_and_opaque(const Gl &gl, Method &method, const Shape &shape)
{
    constexpr int count = 6;
    constexpr Attributes extra{0.75, 0.0, count};
    const auto layer = [](int rank) { return Attributes{rank / 8.0, 0.25 + rank / 16.0, rank}; };
    SceneInGl in_gl(gl, {});
    const auto draw = [&](int at, double alpha) {
        Mesh mesh;
        for (int i = 0; i < count; ++i) {
            const int rank = i * 5 % count;
            append_full(mesh, (2 * rank + 2) / 32.0, layer(rank));
            if (i == 2 && at >= 0)
                append_full(mesh, (2 * at + 1) / 32.0, {extra.value, alpha, extra.id});
        }
        in_gl.replace(mesh);
        return method.draw(shape, [&] { in_gl.draw(); });
    };

    const auto exact = [&](int layers_in_front, bool opaque) {
        std::vector<Fragment> fragments;
        for (int rank = 0; rank < layers_in_front; ++rank) {
            const Attributes a = layer(rank);
            fragments.push_back({0.0, static_cast<float>(a.value), static_cast<float>(a.alpha),
                                 static_cast<float>(rank)});
        }
        if (opaque)
            fragments.push_back({0.0, static_cast<float>(extra.value), 1.0F, count});
        return composite_front_to_back(fragments);
    };
    const double without = percentage(draw(-1, 0.0), [&](const auto &f) {
        return composite_front_to_back(f) != exact(count, false);
    });
    double changed_by_0 = 0.0;
    double shown_behind_1 = 0.0;
    double lost = 0.0;
    for (int at = 0; at <= count; ++at) {
        const Layers transparent = draw(at, 0.0);
        lost += percentage(transparent, [](const auto &f) { return f.size() != count + 1; });
        changed_by_0 += percentage(transparent, [&](const auto &f) {
            return composite_front_to_back(f) != exact(count, false);
        });
        shown_behind_1 += percentage(draw(at, 1.0), [&](const auto &f) {
            return composite_front_to_back(f) != exact(at, true);
        });
    }
    return {{"without it: samples with another composite, %", 0.0, without},
            {"alpha 0 at 7 ranks: samples whose composite it changes, %", 0.0, changed_by_0},
            {"alpha 0 at 7 ranks: samples that have not all 7, %", 0.0, lost},
            {"alpha 1 at 7 ranks: samples that show anything behind, %", 0.0, shown_behind_1}};
}

/// 13. 1 - .01 in single precision is off by up to 2^-25, relative to it 2^-25 / .99, which 400
/// factors make 400 * 3.0e-8 * .018 = 2.2e-7; each product rounds by 2^-24 of less than 1 at first
/// and of .018 in the end: with 400 roundings of either sign the sum is 4e-7 in the mean; the
/// promise is 1e-6.
Outcome thin_layers(const Gl &gl, Method &method, const Shape &shape)
{
    constexpr int count = 400;
    constexpr double tolerance = 1e-6;
    const double expected = 1.0 - std::pow(0.99, count);
    SceneInGl in_gl(gl, {});
    const auto compose = [&](Direction direction) {
        Mesh mesh;
        for (int i = 0; i < count; ++i) {
            const int rank = direction == Direction::front_to_back ? i : count - 1 - i;
            append_full(mesh, (rank + 1) / 512.0, {1.0, 0.01, rank});
        }
        in_gl.replace(mesh);
        return method.compose(shape, direction, [&] { in_gl.draw(); });
    };
    const auto forwards = compose(Direction::front_to_back);
    const auto backwards = compose(Direction::back_to_front);
    Extremes alpha{1.0, 0.0};
    Extremes color{1.0, 0.0};
    double difference = 0.0;
    for (std::size_t i = 0; i < forwards.size(); ++i) {
        for (const Composite &sum : {forwards[i], backwards[i]}) {
            alpha = {std::min(alpha.least, double(sum.alpha)),
                     std::max(alpha.greatest, double(sum.alpha))};
            color = {std::min(color.least, double(sum.color)),
                     std::max(color.greatest, double(sum.color))};
        }
        difference =
            std::max({difference, std::abs(double(forwards[i].alpha) - double(backwards[i].alpha)),
                      std::abs(double(forwards[i].color) - double(backwards[i].color))});
    }
    Outcome outcome;
    append_extremes(outcome, "alpha", expected, alpha, tolerance);
    append_extremes(outcome, "color of white layers", expected, color, tolerance);
    outcome.push_back(
        {"front to back against back to front, greatest difference", 0.0, difference, tolerance});
    return outcome;
}

} // namespace

std::vector<Case> value_cases()
{
    constexpr Size small{20, 12}; // 400 layers of it.
    return {
        {10, "NaN and infinite depths",
         "NaN or infinite depth as the third of 8 fragments: NaN is never kept, infinity is the "
         "clear depth, its negative 0; the other 7 are bit-exact",
         with_and_without_samples({{"", {.k = 8}}}), odd_depths},
        {10, "NaN and infinite colors",
         "NaN or infinite color as the third of 8 fragments: all 8 are bit-exact",
         with_and_without_samples({{"", {.k = 8}}}), odd_colors},
        {12, "alpha 0 and 1",
         "Alpha 0 inserted anywhere changes no bit of the composite, alpha 1 hides all behind it",
         with_and_without_samples({{"", {.k = 8}}}), transparent_and_opaque},
        {13, "many thin layers",
         "400 layers of alpha .01: 1 - .99^400 = .98205 to 1e-6 in single precision, front to back "
         "and back to front agree to 1e-6",
         with_and_without_samples({{"", {.k = 256, .size = small}}}), thin_layers, "", false},
    };
}

} // namespace kb::hard
