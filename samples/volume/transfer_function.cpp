// SPDX-License-Identifier: MIT

#include "volume/transfer_function.hpp"

#include "lib/io/file.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <sstream>

namespace kb
{

namespace
{

struct Named {
    std::string_view name;
    std::string_view text;
};

constexpr std::array<Named, 2> built_in{{
    {"haze", "normalized\n"
             "0.00  0.05 0.10 0.60  0.3\n"
             "0.25  0.00 0.60 0.90  0.6\n"
             "0.50  0.30 0.80 0.20  1.5\n"
             "0.75  1.00 0.70 0.00  4.0\n"
             "1.00  0.90 0.00 0.00  8.0\n"},
    {"shells", "normalized\n"
               "0.00  0.10 0.20 0.80  0\n"
               "0.15  0.10 0.20 0.80  0\n"
               "0.18  0.10 0.40 0.90  6\n"
               "0.21  0.10 0.60 0.80  0\n"
               "0.30  0.20 0.80 0.40  0\n"
               "0.34  0.30 0.90 0.20  8\n"
               "0.38  0.70 0.90 0.10  0\n"
               "0.50  1.00 0.80 0.10  0\n"
               "0.55  1.00 0.70 0.00  15\n"
               "0.60  1.00 0.50 0.00  0\n"
               "0.72  1.00 0.20 0.00  0\n"
               "0.80  0.90 0.00 0.10  30\n"
               "1.00  0.80 0.00 0.20  30\n"},
}};

constexpr std::array<std::string_view, 2> names{built_in[0].name, built_in[1].name};

Error at_line(int line, std::string_view what)
{
    return Error{fmt::format("transfer function, line {}: {}", line, what)};
}

/// A point of a line: five numbers, no more. The offset is taken off the value.
Result<TransferPoint> parse_point(const std::string &line, double offset)
{
    std::istringstream stream(line);
    std::vector<std::string> words{std::istream_iterator<std::string>(stream), {}};
    if (words.size() != 5)
        return Error{
            fmt::format("value red green blue extinction are wanted, not {} words", words.size())};
    std::array<double, 5> numbers{};
    for (std::size_t i = 0; i < words.size(); ++i) {
        char *end = nullptr;
        numbers[i] = std::strtod(words[i].c_str(), &end);
        if (*end != '\0')
            return Error{fmt::format("{} is not a number", words[i])};
    }
    const auto number = [&numbers](std::size_t i) { return static_cast<float>(numbers[i]); };
    return TransferPoint{
        static_cast<float>(numbers[0] - offset), {number(1), number(2), number(3)}, number(4)};
}

std::string without_comment(std::string line)
{
    line.resize(std::min(line.find('#'), line.size()));
    return line;
}

bool is_blank(const std::string &line)
{
    return line.find_first_not_of(" \t\r") == std::string::npos;
}

} // namespace

Result<TransferFunction> TransferFunction::make(std::vector<TransferPoint> points, double offset)
{
    if (points.empty())
        return Error{"the transfer function has no points"};
    for (std::size_t i = 0; i < points.size(); ++i) {
        const TransferPoint &point = points[i];
        const auto in_units = [offset](float value) {
            return offset == 0.0 ? fmt::format("{}", value)
                                 : fmt::format("{:.12g}", offset + value);
        };
        if (!std::isfinite(point.value))
            return Error{fmt::format("transfer function, point {}: the value {} is not finite",
                                     i + 1, in_units(point.value))};
        if (i > 0 && point.value < points[i - 1].value)
            return Error{fmt::format("transfer function, point {}: values must ascend, {} follows "
                                     "{}",
                                     i + 1, in_units(point.value), in_units(points[i - 1].value))};
        for (int c = 0; c < 3; ++c) {
            if (!(point.color[c] >= 0.0F && point.color[c] <= 1.0F))
                return Error{fmt::format("transfer function, point {}: {} is no color from 0 to 1",
                                         i + 1, point.color[c])};
        }
        if (!(point.extinction >= 0.0F))
            return Error{fmt::format("transfer function, point {}: {} is no extinction from 0",
                                     i + 1, point.extinction)};
    }
    return TransferFunction(std::move(points));
}

TransferPoint TransferFunction::at(float value) const
{
    const auto after =
        std::upper_bound(points_.begin(), points_.end(), value,
                         [](float v, const TransferPoint &point) { return v < point.value; });
    if (after == points_.begin())
        return {value, after->color, after->extinction};
    const TransferPoint &a = *std::prev(after);
    if (after == points_.end())
        return {value, a.color, a.extinction};
    const TransferPoint &b = *after;
    if (value == a.value)
        return a; // The infinite extinction of b begins behind it.
    const float part = (value - a.value) / (b.value - a.value);
    return {value, glm::mix(a.color, b.color, part),
            a.extinction == b.extinction ? a.extinction
                                         : std::lerp(a.extinction, b.extinction, part)};
}

TransferFunction TransferFunction::normalized(float low, float high) const
{
    TransferFunction result(*this);
    for (TransferPoint &point : result.points_)
        point.value = (point.value - low) / (high - low);
    return result;
}

Result<TransferFunction> parse_transfer_function(std::string_view text, ScalarRange range)
{
    std::istringstream stream{std::string(text)};
    std::vector<TransferPoint> points;
    bool normalized = false;
    int number = 0;
    for (std::string line; std::getline(stream, line);) {
        ++number;
        line = without_comment(line);
        if (is_blank(line))
            continue;
        if (points.empty() && !normalized && line.find("normalized") != std::string::npos) {
            std::istringstream words(line);
            std::string first;
            std::string second;
            words >> first >> second;
            if (first != "normalized" || !second.empty())
                return at_line(number, "nothing may stand beside the word normalized");
            normalized = true;
            continue;
        }
        const auto point = parse_point(line, normalized ? 0.0 : range.offset);
        if (!point)
            return at_line(number, point.error().message);
        points.push_back(*point);
    }
    auto function = TransferFunction::make(std::move(points), normalized ? 0.0 : range.offset);
    if (!function || normalized)
        return function;
    return function->normalized(range.low, range.high);
}

Result<TransferFunction> load_transfer_function(const std::filesystem::path &path,
                                                ScalarRange range)
{
    const auto text = read_file(path);
    if (!text)
        return Error{fmt::format("cannot read {}: {}", path.string(), text.error().message)};
    auto function = parse_transfer_function(*text, range);
    if (!function)
        return Error{fmt::format("{}: {}", path.string(), function.error().message)};
    return function;
}

Result<TransferFunction> find_transfer_function(std::string_view name)
{
    for (const Named &named : built_in) {
        if (named.name == name)
            return parse_transfer_function(named.text, {});
    }
    return Error{
        fmt::format("there is no transfer function {} (built in are haze and shells)", name)};
}

std::span<const std::string_view> transfer_function_names()
{
    return names;
}

} // namespace kb
