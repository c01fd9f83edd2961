// SPDX-License-Identifier: MIT

#include "volume/scalar_range.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kb
{

ScalarRange range_of(std::span<const float> values)
{
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    if (low == values.end())
        return {};
    if (*high > *low)
        return {*low, *high};
    return {*low, *low + std::max(1.0F, std::abs(*low)), 0.0, false};
}

ScalarRange range_of(const ScalarField &field)
{
    ScalarRange range = range_of(field.values);
    range.offset = field.offset;
    return range;
}

std::string describe_value(double value, const ScalarRange &range)
{
    // Six digits of the extent, and those before it.
    const double most = std::max({std::abs(range.in_units(range.low)),
                                  std::abs(range.in_units(range.high)), std::abs(value)});
    const double extent = double(range.high) - double(range.low);
    const double before = range.varies ? std::log10(std::max(most / extent, 1.0)) : 0.0;
    return fmt::format("{:.{}g}", value, std::min(6 + static_cast<int>(before), 17));
}

static std::string describe_range(const ScalarRange &range)
{
    const std::string low = describe_value(range.in_units(range.low), range);
    if (!range.varies)
        return fmt::format("is {} everywhere", low);
    return fmt::format("from {} to {}", low, describe_value(range.in_units(range.high), range));
}

std::string describe_field(const ScalarField &field)
{
    return fmt::format("{}field '{}' {}", field.components > 1 ? "magnitude of the " : "",
                       field.name, describe_range(range_of(field)));
}

std::string list_fields(std::span<const ScalarField> fields)
{
    std::string lines;
    for (const ScalarField &field : fields)
        lines += fmt::format("{}: {}{}\n", field.name,
                             field.components > 1
                                 ? fmt::format("magnitude of {} components, ", field.components)
                                 : "",
                             field.fault.empty() ? describe_range(range_of(field))
                                                 : "cannot be drawn: " + field.fault);
    return lines;
}

} // namespace kb
