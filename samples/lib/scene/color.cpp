// SPDX-License-Identifier: MIT

#include "lib/scene/color.hpp"

#include "lib/io/text_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <map>
#include <optional>

namespace kb
{

/// The basic names of CSS 2.1, and what CSS 3 also calls three of them.
static std::optional<std::uint32_t> rgb_named(std::string_view name)
{
    static const std::map<std::string_view, std::uint32_t> names{
        {"aqua", 0x00FFFF},    {"black", 0x000000},   {"blue", 0x0000FF},   {"cyan", 0x00FFFF},
        {"fuchsia", 0xFF00FF}, {"gray", 0x808080},    {"green", 0x008000},  {"grey", 0x808080},
        {"lime", 0x00FF00},    {"magenta", 0xFF00FF}, {"maroon", 0x800000}, {"navy", 0x000080},
        {"olive", 0x808000},   {"orange", 0xFFA500},  {"purple", 0x800080}, {"red", 0xFF0000},
        {"silver", 0xC0C0C0},  {"teal", 0x008080},    {"white", 0xFFFFFF},  {"yellow", 0xFFFF00}};
    const auto found = names.find(name);
    return found == names.end() ? std::nullopt : std::optional(found->second);
}

static std::optional<std::uint32_t> rgb_of_digits(std::string_view digits)
{
    if (digits.starts_with('#'))
        digits.remove_prefix(1);
    std::string six(digits);
    if (digits.size() == 3)
        six = fmt::format("{0}{0}{1}{1}{2}{2}", digits[0], digits[1], digits[2]);
    std::uint32_t rgb = 0;
    const auto [end, code] = std::from_chars(six.data(), six.data() + six.size(), rgb, 16);
    if (six.size() != 6 || code != std::errc() || end != six.data() + six.size())
        return std::nullopt;
    return rgb;
}

static std::optional<glm::vec3> color_of_numbers(std::string_view text)
{
    glm::vec3 color;
    for (int i = 0; i < 3; ++i) {
        const auto comma = text.find(',');
        const auto number = parse_number(trim(text.substr(0, comma)));
        if (!number || !(*number >= 0.0 && *number <= 1.0) ||
            (comma == std::string_view::npos) != (i == 2))
            return std::nullopt;
        color[i] = static_cast<float>(*number);
        text.remove_prefix(std::min(comma, text.size() - 1) + 1);
    }
    return color;
}

Result<glm::vec3> parse_color(const std::string &text)
{
    auto rgb = rgb_named(to_lower(text));
    if (!rgb)
        rgb = rgb_of_digits(text);
    if (rgb)
        return glm::vec3(*rgb >> 16U, *rgb >> 8U & 255U, *rgb & 255U) / 255.0F;
    if (const auto color = color_of_numbers(text))
        return *color;
    return Error{fmt::format("{} is no color: one is a name as red or navy, #rrggbb, or three "
                             "numbers from 0 to 1 as 1,0.5,0",
                             text)};
}

} // namespace kb
