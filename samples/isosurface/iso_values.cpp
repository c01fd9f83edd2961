// SPDX-License-Identifier: MIT

#include "isosurface/iso_values.hpp"

#include "lib/scene/color.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace kb
{

Result<IsoRequest> parse_iso_value(const std::string &text)
{
    const auto equals = text.find('=');
    const std::string number = text.substr(0, equals);
    IsoRequest request;
    char *end = nullptr;
    request.value = std::strtod(number.c_str(), &end);
    if (number.empty() || *end != '\0' || !std::isfinite(request.value))
        return Error{fmt::format("{} is not a finite number", number.empty() ? text : number)};
    if (equals == std::string::npos)
        return request;

    const auto color = parse_color(text.substr(equals + 1));
    if (!color)
        return Error{fmt::format("{}: {}", text, color.error().message)};
    request.has_color = true;
    request.color = *color;
    return request;
}

float normalized(float scalar, const ScalarRange &range)
{
    return (scalar - range.low) / (range.high - range.low);
}

std::vector<IsoValue> normalized(std::span<const IsoValue> values, const ScalarRange &range)
{
    std::vector<IsoValue> inside;
    for (const IsoValue &iso : values) {
        // As the scalars are.
        const auto scalar = static_cast<float>(iso.value - range.offset);
        if (scalar >= range.low && scalar <= range.high)
            inside.push_back({iso.value, iso.color, normalized(scalar, range)});
    }
    return inside;
}

glm::vec3 palette_color(float position)
{
    static constexpr glm::vec3 stops[] = {{0.30F, 0.55F, 0.95F},
                                          {0.25F, 0.80F, 0.80F},
                                          {0.50F, 0.82F, 0.35F},
                                          {0.95F, 0.75F, 0.25F},
                                          {0.95F, 0.40F, 0.35F}};
    constexpr int last = static_cast<int>(std::size(stops)) - 1;
    const float place = std::clamp(position, 0.0F, 1.0F) * static_cast<float>(last);
    const int i = std::min(static_cast<int>(place), last - 1);
    const float t = place - static_cast<float>(i);
    return stops[i] * (1.0F - t) + stops[i + 1] * t;
}

/// The distance of the two nearest of ascending values, and an error if it takes too many texels.
static Result<double> texel_width(std::span<const IsoValue> values, int max_texels)
{
    if (values.size() < 2)
        return 1.0; // Any would do.
    std::size_t nearest = 1;
    const auto distance = [values](std::size_t i) {
        return double(values[i].scalar) - double(values[i - 1].scalar);
    };
    for (std::size_t i = 2; i < values.size(); ++i) {
        if (distance(i) < distance(nearest))
            nearest = i;
    }
    // A texel and half of one at either end are two widths: less than three hold one value at most.
    const double width = distance(nearest) / 3.0;
    const double extent = double(values.back().scalar) - double(values.front().scalar);
    if (!(extent / width + 3.0 <= max_texels) || !std::isnormal(static_cast<float>(width)))
        return Error{fmt::format("the iso-values {} and {} are nearer to each other than {:.2g} of "
                                 "the extent of all",
                                 values[nearest - 1].value, values[nearest].value,
                                 3.0 / max_texels)};
    return width;
}

Result<IsoTable> make_iso_table(std::span<const IsoValue> values, int max_texels)
{
    std::vector<IsoValue> sorted(values.begin(), values.end());
    for (const IsoValue &iso : sorted) {
        if (!std::isfinite(iso.scalar))
            return Error{fmt::format("the iso-value {} is not finite", iso.value)};
    }
    const auto less = [](const IsoValue &a, const IsoValue &b) { return a.scalar < b.scalar; };
    const auto same = [](const IsoValue &a, const IsoValue &b) { return a.scalar == b.scalar; };
    std::stable_sort(sorted.begin(), sorted.end(), less);
    sorted.erase(std::unique(sorted.begin(), sorted.end(), same), sorted.end());

    const auto width = texel_width(sorted, max_texels);
    if (!width)
        return width.error();
    // The first value is in the middle of texel 1, the last one has a texel behind it.
    const double first = sorted.empty() ? 0.0 : double(sorted.front().scalar);
    const double extent = sorted.empty() ? 0.0 : double(sorted.back().scalar) - first;
    const auto texels = static_cast<std::size_t>(std::floor(extent / *width + 0.5)) + 3;

    IsoTable table;
    table.base = static_cast<float>(first); // Exactly: large values may be near to each other.
    table.scale = static_cast<float>(1.0 / (static_cast<double>(texels) * *width));
    table.offset = static_cast<float>(1.5 / static_cast<double>(texels));
    const auto value_at = [&sorted](std::ptrdiff_t i) {
        if (i < 0)
            return -IsoTable::no_value;
        return i < std::ssize(sorted) ? sorted[std::size_t(i)].scalar : IsoTable::no_value;
    };
    std::ptrdiff_t inside = 0; // The first one that is not below what the texel knows.
    for (std::size_t i = 0; i < texels; ++i) {
        const double begin = first + (static_cast<double>(i) - 2.0) * *width;
        while (inside < std::ssize(sorted) && double(value_at(inside)) < begin)
            ++inside;
        table.neighbours.emplace_back(value_at(inside - 1), value_at(inside), value_at(inside + 1),
                                      0.0F);
        table.colors.emplace_back(inside < std::ssize(sorted) ? sorted[std::size_t(inside)].color
                                                              : glm::vec3(0.0F),
                                  1.0F);
    }
    return table;
}

} // namespace kb
