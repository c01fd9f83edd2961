// SPDX-License-Identifier: MIT

#include "lib/io/text_fields.hpp"

#include <algorithm>
#include <charconv>

namespace kb
{

static constexpr std::string_view blanks = " \t\r\v\f";

std::optional<std::string_view> take_line(std::string_view &text)
{
    if (text.empty())
        return std::nullopt;
    const auto end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.ends_with('\r'))
        line.remove_suffix(1);
    return line;
}

std::string_view take_word(std::string_view &line)
{
    const auto begin = std::min(line.find_first_not_of(blanks), line.size());
    const auto end = std::min(line.find_first_of(blanks, begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

std::string_view trim(std::string_view text)
{
    const auto begin = text.find_first_not_of(blanks);
    if (begin == std::string_view::npos)
        return {};
    return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

std::string to_lower(std::string_view text)
{
    std::string lower(text);
    for (char &c : lower)
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return lower;
}

template <class T>
static std::optional<T> parse(std::string_view word)
{
    if (word.starts_with('+') && !word.starts_with("+-"))
        word.remove_prefix(1);
    T value{};
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (code != std::errc() || end != word.data() + word.size())
        return std::nullopt;
    return value;
}

std::optional<double> parse_number(std::string_view word)
{
    return parse<double>(word);
}

std::optional<std::int64_t> parse_integer(std::string_view word)
{
    return parse<std::int64_t>(word);
}

} // namespace kb
