// SPDX-License-Identifier: MIT

#include "tests/reference/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace kb::reference
{

namespace
{

constexpr double shader_rounding = 0x1p-22; ///< Of colors that two compilations interpolate.

using Finding = std::optional<std::string>;

/// What can be told apart in a channel: the format's rounding, or of values that pass unchanged
/// that of the shader.
double format_rounding(ColorFormat format, std::size_t channel, double value, bool flat)
{
    const double shader = flat ? 0.0 : shader_rounding * std::max(1.0, std::abs(value));
    switch (format) {
    case ColorFormat::rgba32f:
        return shader;
    case ColorFormat::rgba16f: // 11 bits; either neighbor, as GL allows; 2^-24 near zero.
        return shader + std::abs(value) * 0x1p-10 + 0x1p-24;
    case ColorFormat::rgba8:
    case ColorFormat::r8: // To the nearest, the product by 255 being rounded.
        return shader + (0.5 + 0x1p-14) / 255.0;
    case ColorFormat::rgb10_a2: // Stock llvmpipe rounds down.
        return shader + (1.0 + 0x1p-12) / (channel == 3 ? 3.0 : 1023.0);
    case ColorFormat::r32ui:
        break;
    }
    return 0.0;
}

double fit_format(ColorFormat format, double value)
{
    const bool has_sign = format == ColorFormat::rgba32f || format == ColorFormat::rgba16f;
    return has_sign ? value : std::clamp(value, 0.0, 1.0);
}

/// Of one operation on floats, with room for the errors of errors.
constexpr double rounding = 0x1p-23;

Estimate product(const Estimate &a, const Estimate &b)
{
    const double value = a.value * b.value;
    return {value, std::abs(a.value) * b.tolerance + std::abs(b.value) * a.tolerance +
                       a.tolerance * b.tolerance + rounding * std::abs(value)};
}

std::size_t channel_count(ColorFormat format)
{
    return format == ColorFormat::r8 || format == ColorFormat::r32ui ? 1 : 4;
}

class Checker
{
public:
    Checker(const Scene &scene, const Observation &seen, const RasterRules &rules, Fault fault,
            Statistics &statistics)
        : scene_(scene), seen_(seen), rules_(rules), fault_(fault), statistics_(statistics),
          samples_(static_cast<std::size_t>(scene.sample_count())),
          samples_a_layer_(std::size_t(scene.width) * std::size_t(scene.height) * samples_),
          k_(static_cast<std::size_t>(scene.k)), formats_(kept_colors(scene))
    {
        for (const Step &step : scene.steps) {
            for (const Triangle &triangle : step.triangles) {
                triangles_.push_back(&triangle);
                rasters_.emplace_back(scene, step.cull, triangle, rules);
                scissors_.push_back(step.scissor);
            }
        }
    }

    Finding run()
    {
        for (std::size_t t = 0; t < triangles_.size(); ++t) {
            if (auto found = check_triangle(t))
                return found;
        }
        statistics_.ties += seen_.a_buffer.has_ties() ? 1 : 0;
        for (std::size_t p = 0; p < seen_.passes.size(); ++p) {
            if (auto found = check_layers(p))
                return found;
        }
        if (auto found = check_passes())
            return found;
        for (std::size_t p = 0; p < seen_.passes.size(); ++p) {
            if (auto found = check_composite(p))
                return found;
        }
        return std::nullopt;
    }

private:
    std::string place(std::size_t sample) const
    {
        const std::size_t pixel = sample / samples_;
        const auto width = static_cast<std::size_t>(scene_.width);
        std::string text = fmt::format("pixel ({}, {})", pixel % width, pixel / width);
        if (samples_ > 1)
            text += fmt::format(" sample {}", sample % samples_);
        return text;
    }

    Finding check_triangle(std::size_t t)
    {
        const TriangleDump &dump = seen_.dumps[t];
        for (std::size_t i = 0; i < samples_a_layer_; ++i) {
            const std::size_t pixel = i / samples_;
            const int x = static_cast<int>(pixel % std::size_t(scene_.width));
            const int y = static_cast<int>(pixel / std::size_t(scene_.width));
            const SamplePosition sample = rules_.samples[i % samples_];
            // A mistake: all of it one step of 1/256 pixel beside.
            const int beside = fault_ == Fault::coverage ? 1 : 0;
            Coverage coverage = rasters_[t].coverage(x, y, {sample.x + beside, sample.y});
            if (scissors_[t] && !scissors_[t]->contains(x, y))
                coverage = Coverage::no;
            ++statistics_.samples;
            statistics_.undecided += coverage == Coverage::undecided ? 1 : 0;
            if (coverage != Coverage::undecided && dump.covers(i) != (coverage == Coverage::yes))
                return fmt::format("coverage: {}: triangle {} {} it, the driver says otherwise",
                                   place(i), triangles_[t]->id,
                                   coverage == Coverage::yes ? "covers" : "does not cover");
            if (!dump.covers(i))
                continue;
            if (dump.count[i] > 1 && !rasters_[t].is_clipped())
                return fmt::format("coverage: {}: triangle {} covers it {} times", place(i),
                                   triangles_[t]->id, dump.count[i]);
            statistics_.doubled += dump.count[i] > 1 ? 1 : 0;
            ++statistics_.fragments;
            if (auto found = check_depth(t, i, rasters_[t].depth(x, y, sample)))
                return found;
            if (auto found = check_color(t, i, x, y))
                return found;
        }
        return std::nullopt;
    }

    Finding check_depth(std::size_t t, std::size_t i, Estimate exact)
    {
        const DepthFormat format = kept_depth(scene_);
        const auto [low, high] = std::minmax(scene_.depth_range[0], scene_.depth_range[1]);
        const double measured =
            std::clamp(decode_depth(format, seen_.dumps[t].depth[i]), low, high);
        // Integer formats round to the nearest, or down.
        exact.tolerance +=
            depth_step(format) * (format == DepthFormat::d16 ? rules_.steps_of_16_bits : 1);
        if (fault_ == Fault::depth)
            exact.value += 1e-3;
        if (!std::isfinite(exact.tolerance))
            ++statistics_.unbounded_depths;
        if (exact.agrees_with(measured))
            return std::nullopt;
        return fmt::format(
            "depth: {}: that of triangle {} is {:.9g}, it should be {:.9g} +- {:.2g}", place(i),
            triangles_[t]->id, measured, exact.value, exact.tolerance);
    }

    Finding check_color(std::size_t t, std::size_t i, int x, int y)
    {
        for (std::size_t c = 0; c < 4; ++c) {
            const Estimate exact = rasters_[t].color(x, y, c);
            const auto measured = static_cast<double>(seen_.dumps[t].color[i][c]);
            if (!std::isfinite(exact.tolerance))
                ++statistics_.unbounded_colors;
            if (!exact.agrees_with(measured))
                return fmt::format(
                    "color: {}: channel {} of triangle {} is {:.9g}, it should be {:.9g} +- {:.2g}",
                    place(i), c, triangles_[t]->id, measured, exact.value, exact.tolerance);
        }
        return std::nullopt;
    }

    /// The fragment that pass p has in a layer; null behind the last one.
    const Fragment *expected(std::size_t p, std::size_t layer, std::size_t sample) const
    {
        const auto &fragments = seen_.a_buffer.at(sample);
        const std::size_t rank = p * k_ + layer;
        if (rank >= fragments.size() || (fault_ == Fault::layers && layer + 1 == k_))
            return nullptr;
        return &fragments[rank];
    }

    Finding check_layers(std::size_t p)
    {
        const Pass &pass = seen_.passes[p];
        const DepthFormat format = kept_depth(scene_);
        const double clear =
            scene_.extension == Extension::peeling ? static_cast<double>(scene_.clear_depth) : 1.0;
        const std::uint32_t empty = encode_depth(format, clear);
        ++statistics_.passes;
        for (std::size_t layer = 0; layer < k_; ++layer) {
            for (std::size_t i = 0; i < samples_a_layer_; ++i) {
                if (seen_.doubled[i])
                    continue;
                const Fragment *fragment = expected(p, layer, i);
                const std::uint32_t stored = pass.depth[layer * samples_a_layer_ + i];
                if (stored != (fragment ? fragment->depth : empty))
                    return fmt::format("layers: pass {} layer {} {}: depth {:.9g}, it should be {}",
                                       p, layer, place(i), decode_depth(format, stored),
                                       fragment ? fmt::format("{:.9g} of triangle {}",
                                                              decode_depth(format, fragment->depth),
                                                              triangles_[fragment->triangle]->id)
                                                : "empty");
                statistics_.layers += fragment ? 1 : 0;
                for (std::size_t a = 0; a < formats_.size(); ++a) {
                    if (auto found =
                            check_stored(a, fragment, pass.colors[a][layer * samples_a_layer_ + i]))
                        return fmt::format("layers: pass {} layer {} {}: {}", p, layer, place(i),
                                           *found);
                }
            }
        }
        return std::nullopt;
    }

    Finding check_stored(std::size_t a, const Fragment *fragment, const Color &stored) const
    {
        if (!fragment && scene_.extension == Extension::program)
            return std::nullopt; // Empty is what the depth says.
        const ColorFormat format = formats_[a];
        for (std::size_t c = 0; c < channel_count(format); ++c) {
            double value = 0.0; // That of the clear, which a mask keeps.
            if (fragment && scene_.color_mask[c])
                value = format == ColorFormat::r32ui
                            ? static_cast<double>(triangles_[fragment->triangle]->id)
                            : static_cast<double>(fragment->color[source_channel(a, c)]);
            if (format != ColorFormat::r32ui)
                value = fit_format(format, value);
            if (keeps_no_alpha() && c == 3)
                value = static_cast<double>(constant_alpha);
            const auto measured = static_cast<double>(stored[c]);
            if (!(std::abs(measured - value) <= format_rounding(format, c, value, scene_.flat)))
                return fmt::format(
                    "channel {} of attachment {} is {:.9g}, it should be {:.9g}{}", c, a, measured,
                    value,
                    fragment ? fmt::format(" of triangle {}", triangles_[fragment->triangle]->id)
                             : " as cleared");
        }
        return std::nullopt;
    }

    bool keeps_no_alpha() const
    {
        return scene_.extension == Extension::program && scene_.layout == EntryLayout::rgbz;
    }

    /// OVERFLOW may be non-zero for less than a loss, but is zero only without one. So a loop may
    /// take one pass more than there are fragments for, and none less.
    Finding check_passes() const
    {
        if (scene_.extension == Extension::program || !seen_.knows_all())
            return std::nullopt;
        const std::size_t deepest = seen_.a_buffer.deepest();
        const std::size_t count = seen_.passes.size();
        const bool lost = deepest > count * k_ || seen_.overflow_before_clear;
        if (lost && !seen_.passes.back().overflow)
            return fmt::format("overflow: it is zero after pass {}, but {} fragments of a sample "
                               "are more than fit",
                               count - 1, deepest);
        const std::size_t needed = std::max<std::size_t>((deepest + k_ - 1) / k_, 1);
        if (scene_.all_passes && (seen_.passes.back().overflow || count > needed + 1))
            return fmt::format("passes: {} came, but {} or {} have all {} fragments", count, needed,
                               needed + 1, deepest);
        return std::nullopt;
    }

    /// A channel of what the layer holds.
    Estimate composed_channel(const Fragment &fragment, std::size_t sample, std::size_t c) const
    {
        if (keeps_no_alpha() && c == 3)
            return {static_cast<double>(constant_alpha), 0.0};
        if (!scene_.color_mask[c])
            return {0.0, 0.0};
        const std::size_t pixel = sample / samples_;
        const auto width = static_cast<std::size_t>(scene_.width);
        Estimate value = rasters_[fragment.triangle].color(static_cast<int>(pixel % width),
                                                           static_cast<int>(pixel / width), c);
        // A plane that is lost in rounding says nothing about the composite.
        if (value.tolerance > 1e-3)
            value = {static_cast<double>(fragment.color[c]), 0.0};
        value.value = fit_format(formats_[0], value.value);
        value.tolerance += format_rounding(formats_[0], c, value.value, scene_.flat);
        return value;
    }

    /// Front to back over black. color += T a c and T *= 1 - a round each of their operations by
    /// half of 2^-23 of the result; errors of the colors and alphas, and of T, go along.
    Finding check_composite(std::size_t p)
    {
        const Pass &pass = seen_.passes[p];
        const auto samples = static_cast<double>(samples_);
        for (std::size_t pixel = 0; pixel < pass.composite.size(); ++pixel) {
            std::array<double, 4> sum{};
            std::array<double, 4> error{};
            bool known = true;
            for (std::size_t s = 0; s < samples_; ++s) {
                const std::size_t sample = pixel * samples_ + s;
                known = known && !seen_.doubled[sample];
                Estimate through{1.0, 0.0};
                for (std::size_t layer = 0; layer < k_; ++layer) {
                    const Fragment *fragment = expected(p, layer, sample);
                    if (!fragment)
                        break;
                    const Estimate alpha = composed_channel(*fragment, sample, 3);
                    const Estimate weight = product(through, alpha);
                    for (std::size_t c = 0; c < 3; ++c) {
                        const Estimate part =
                            product(weight, composed_channel(*fragment, sample, c));
                        sum[c] += part.value;
                        error[c] += part.tolerance + rounding * std::abs(sum[c]);
                    }
                    through = product(through,
                                      {1.0 - alpha.value,
                                       alpha.tolerance + rounding * std::abs(1.0 - alpha.value)});
                }
                sum[3] += through.value;
                error[3] += through.tolerance + rounding * std::abs(sum[3]);
            }
            for (std::size_t c = 0; c < 4 && known; ++c) {
                const double exact = sum[c] / samples + (fault_ == Fault::composite ? 1e-2 : 0.0);
                // Adding up the samples rounds sums, and dividing them, once more.
                const double tolerance =
                    error[c] / samples + (samples + 1.0) * rounding * std::abs(exact);
                const auto measured = static_cast<double>(pass.composite[pixel][c]);
                if (!(std::abs(measured - exact) <= tolerance))
                    return fmt::format(
                        "composite: pass {} {}: channel {} is {:.9g}, it should be {:.9g} +- "
                        "{:.2g}",
                        p, place(pixel * samples_), c, measured, exact, tolerance);
            }
        }
        statistics_.composites += pass.composite.empty() ? 0 : 1;
        return std::nullopt;
    }

    const Scene &scene_;
    const Observation &seen_;
    const RasterRules &rules_;
    Fault fault_;
    Statistics &statistics_;
    std::size_t samples_;
    std::size_t samples_a_layer_;
    std::size_t k_;
    std::vector<ColorFormat> formats_;
    std::vector<const Triangle *> triangles_;
    std::vector<TriangleRaster> rasters_;
    std::vector<std::optional<Box>> scissors_;
};

std::size_t sample_count(const Scene &scene)
{
    return std::size_t(scene.width) * std::size_t(scene.height) * std::size_t(scene.sample_count());
}

/// Sends the fragments of a dump through the scene's commands.
void fill(Observation &seen, const Scene &scene, Empty empty)
{
    const auto samples = static_cast<std::size_t>(scene.sample_count());
    const std::size_t count = sample_count(scene);
    ABuffer &buffer = seen.a_buffer = ABuffer(count);
    const auto overflows = [&] {
        ABuffer sorted = buffer;
        sorted.sort(scene.func, empty);
        return sorted.deepest() > static_cast<std::size_t>(scene.k);
    };
    std::size_t triangle = 0;
    for (const Step &step : scene.steps) {
        if (step.clear) {
            seen.overflow_before_clear = seen.overflow_before_clear || overflows();
            for (std::size_t i = 0; i < count; ++i) {
                const std::size_t pixel = i / samples;
                const int x = static_cast<int>(pixel % std::size_t(scene.width));
                const int y = static_cast<int>(pixel / std::size_t(scene.width));
                if (!step.scissor || step.scissor->contains(x, y))
                    buffer.clear(i);
            }
        }
        for (std::size_t t = 0; t < step.triangles.size(); ++t, ++triangle) {
            const TriangleDump &dump = seen.dumps[triangle];
            // Without the depth mask peeling inserts nothing; programs have no depth buffer.
            if (!step.depth_mask && scene.extension == Extension::peeling)
                continue;
            for (std::size_t i = 0; i < count; ++i) {
                if (dump.covers(i))
                    buffer.add(i, {dump.depth[i], triangle, dump.color[i]});
            }
        }
    }
    buffer.sort(scene.func, empty);
}

} // namespace

Result<Fault> parse_fault(const std::string &name)
{
    static constexpr std::array<std::pair<std::string_view, Fault>, 7> names{
        {{"none", Fault::none},
         {"coverage", Fault::coverage},
         {"depth", Fault::depth},
         {"ties", Fault::ties},
         {"layers", Fault::layers},
         {"composite", Fault::composite},
         {"crash", Fault::crash}}};
    for (const auto &[text, fault] : names) {
        if (text == name)
            return fault;
    }
    return Error{fmt::format("no such fault: {}", name)};
}

Statistics &Statistics::operator+=(const Statistics &other)
{
    samples += other.samples;
    undecided += other.undecided;
    fragments += other.fragments;
    doubled += other.doubled;
    unbounded_depths += other.unbounded_depths;
    unbounded_colors += other.unbounded_colors;
    ties += other.ties;
    layers += other.layers;
    passes += other.passes;
    composites += other.composites;
    return *this;
}

Result<Observation> observe(SceneDrawer &drawer, const Scene &scene)
{
    if (auto supported = drawer.check_support(scene); !supported)
        return supported.error();
    Observation seen;
    auto dumps = drawer.dump(scene);
    if (!dumps)
        return dumps.error();
    seen.dumps = std::move(*dumps);
    auto passes = drawer.draw(scene);
    if (!passes)
        return passes.error();
    seen.passes = std::move(*passes);
    seen.doubled.resize(sample_count(scene));
    for (const TriangleDump &dump : seen.dumps) {
        for (std::size_t i = 0; i < dump.count.size(); ++i)
            seen.doubled[i] = seen.doubled[i] || dump.count[i] > 1;
    }
    const double clear =
        scene.extension == Extension::peeling ? static_cast<double>(scene.clear_depth) : 1.0;
    fill(seen, scene, {encode_depth(kept_depth(scene), clear)});
    return seen;
}

Result<std::optional<std::string>> check(SceneDrawer &drawer, const Scene &scene, Fault fault,
                                         Statistics &statistics)
{
    if (fault == Fault::crash)
        std::abort();
    auto rules = drawer.rules(scene);
    if (!rules)
        return rules.error();
    Scene model = scene;
    auto seen = observe(drawer, scene);
    if (!seen)
        return seen.error();
    if (fault == Fault::ties) {
        // Equal depths the other way round.
        constexpr std::array<Func, 4> other{Func::lequal, Func::less, Func::gequal, Func::greater};
        model.func = other[static_cast<std::size_t>(scene.func)];
        const double clear =
            scene.extension == Extension::peeling ? static_cast<double>(scene.clear_depth) : 1.0;
        fill(*seen, model, {encode_depth(kept_depth(scene), clear)});
    }
    return Checker(scene, *seen, *rules, fault, statistics).run();
}

} // namespace kb::reference
