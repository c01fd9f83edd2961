// SPDX-License-Identifier: MIT

#include "lib/io/vtk_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <concepts>
#include <cstring>
#include <limits>
#include <optional>
#include <type_traits>

namespace kb
{

static const char *const blanks = " \t\r";

std::string_view first_word(std::string_view line)
{
    line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
    return line.substr(0, line.find_first_of(blanks));
}

std::string quoted(std::string_view word)
{
    std::string text(word.substr(0, 40));
    const auto is_unprintable = [](unsigned char c) { return c < ' ' || c > '~'; };
    std::ranges::replace_if(text, is_unprintable, '?');
    return '\'' + text + '\'';
}

bool is_keyword(std::string_view word, std::string_view keyword)
{
    const auto same = [](char a, char b) {
        return (a >= 'a' && a <= 'z' ? a - 'a' + 'A' : a) == b;
    };
    return std::ranges::equal(word, keyword, same);
}

template <class T>
static std::optional<T> to_number(std::string_view word)
{
    if (word.starts_with('+'))
        word.remove_prefix(1);
    if constexpr (std::floating_point<T>) {
        // 1.#INF, -1.#IND, 1.#QNAN: as Windows used to print what is not finite.
        if (const auto mark = word.find(".#"); mark != std::string_view::npos)
            return word.substr(mark) == ".#INF" ? std::numeric_limits<T>::infinity()
                                                : std::numeric_limits<T>::quiet_NaN();
    }
    T value{};
    const char *const end = word.data() + word.size();
    const auto result = std::from_chars(word.data(), end, value);
    if (result.ptr != end || word.empty())
        return std::nullopt;
    if constexpr (std::floating_point<T>) {
        // Too small for the type, or too large: the check of the grid finds what is not finite.
        if (result.ec == std::errc::result_out_of_range)
            return word.find_first_of("eE") != std::string_view::npos &&
                           word.find("-", 1) != std::string_view::npos
                       ? T{}
                       : std::numeric_limits<T>::infinity();
    }
    return result.ec == std::errc{} ? std::optional(value) : std::nullopt;
}

void VtkText::fail(const std::string &reason)
{
    if (error_.empty())
        error_ = reason;
    rest_ = {};
}

std::string_view VtkText::line()
{
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    const std::string_view taken = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    return taken;
}

std::string_view VtkText::word()
{
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size()));
    const std::string_view taken = rest_.substr(0, rest_.find_first_of(" \t\r\n"));
    rest_.remove_prefix(taken.size());
    return taken;
}

std::string_view VtkText::next_on_this_line() const
{
    return first_word(rest_.substr(0, rest_.find('\n')));
}

std::string_view VtkText::next_line_begin() const
{
    VtkText next(rest_);
    next.line();
    return next.next_on_this_line();
}

std::size_t VtkText::count(const char *of_what)
{
    const std::string_view digits = word();
    if (const auto number = to_number<std::int64_t>(digits); number && *number >= 0)
        return static_cast<std::size_t>(*number);
    fail(digits.empty() ? "it ends early"
                        : fmt::format("the number of {} is {}", of_what, quoted(digits)));
    return 0;
}

template <class Stored, class T>
std::vector<T> VtkText::binary_numbers(std::size_t wanted)
{
    line(); // The block begins after the end of the line that announces it.
    if (wanted > rest_.size() / sizeof(Stored)) {
        fail(fmt::format("a block of {} binary numbers is cut off", wanted));
        return {};
    }
    std::vector<T> numbers(wanted);
    for (std::size_t i = 0; i < wanted; ++i) {
        std::array<char, sizeof(Stored)> bytes{};
        std::memcpy(bytes.data(), rest_.data() + i * sizeof(Stored), sizeof(Stored));
        if (is_little_endian != (std::endian::native == std::endian::little))
            std::ranges::reverse(bytes);
        numbers[i] = static_cast<T>(std::bit_cast<Stored>(bytes));
    }
    rest_.remove_prefix(wanted * sizeof(Stored));
    return numbers;
}

/// Eight in a byte, the first one in its highest bit.
std::vector<double> VtkText::binary_bits(std::size_t wanted)
{
    const auto bytes = binary_numbers<unsigned char, unsigned char>(wanted / 8 + (wanted % 8 != 0));
    std::vector<double> bits(failed() ? 0 : wanted);
    for (std::size_t i = 0; i < bits.size(); ++i)
        bits[i] = bytes[i / 8] >> (7 - i % 8) & 1;
    return bits;
}

template <class Stored, class T>
std::vector<T> VtkText::ascii_numbers(std::size_t wanted)
{
    // Each number needs a digit and a blank.
    if (wanted > rest_.size() / 2 + 1) {
        fail("it ends early");
        return {};
    }
    // Characters are written as numbers, and what is said to be floats may have more digits.
    using Written = std::conditional_t<std::floating_point<T>, T, Stored>;
    std::vector<T> numbers(wanted);
    for (T &number : numbers) {
        const std::string_view digits = word();
        const auto read = to_number<Written>(digits);
        if (!read) {
            fail(digits.empty() ? "it ends early"
                                : fmt::format("{} is no number of its type{}", quoted(digits),
                                              digits.find(',') == std::string_view::npos
                                                  ? ""
                                                  : ": numbers have a point, no comma"));
            return {};
        }
        number = static_cast<T>(*read);
    }
    return numbers;
}

template <class Stored, class T>
std::vector<T> VtkText::stored_as(std::size_t wanted)
{
    return is_binary ? binary_numbers<Stored, T>(wanted) : ascii_numbers<Stored, T>(wanted);
}

template <class T>
std::vector<T> VtkText::numbers(std::string_view type, std::size_t wanted)
{
    if (is_keyword(type, "INT") || is_keyword(type, "VTKIDTYPE") ||
        is_keyword(type, "VTKTYPEINT32"))
        return stored_as<std::int32_t, T>(wanted);
    if (is_keyword(type, "UNSIGNED_INT"))
        return stored_as<std::uint32_t, T>(wanted);
    if (is_keyword(type, "LONG") || is_keyword(type, "VTKTYPEINT64"))
        return stored_as<std::int64_t, T>(wanted);
    if constexpr (std::floating_point<T>) {
        if (is_keyword(type, "BIT"))
            return is_binary ? binary_bits(wanted) : ascii_numbers<unsigned char, T>(wanted);
        if (is_keyword(type, "FLOAT"))
            return stored_as<float, T>(wanted);
        if (is_keyword(type, "DOUBLE"))
            return stored_as<double, T>(wanted);
        if (is_keyword(type, "UNSIGNED_LONG") || is_keyword(type, "VTKTYPEUINT64"))
            return stored_as<std::uint64_t, T>(wanted);
        if (is_keyword(type, "SHORT"))
            return stored_as<std::int16_t, T>(wanted);
        if (is_keyword(type, "UNSIGNED_SHORT"))
            return stored_as<std::uint16_t, T>(wanted);
        if (is_keyword(type, "CHAR") || is_keyword(type, "SIGNED_CHAR"))
            return stored_as<signed char, T>(wanted);
        if (is_keyword(type, "UNSIGNED_CHAR"))
            return stored_as<unsigned char, T>(wanted);
    }
    fail(type.empty() ? "it ends early" : fmt::format("it has numbers of type {}", quoted(type)));
    return {};
}

std::vector<double> VtkText::reals(std::string_view type, std::size_t items, std::size_t components)
{
    // Such a product may be larger than any number; no file is. A byte has eight bits.
    if (components != 0 && items > 8 * rest_.size() / components) {
        fail("it ends early");
        return {};
    }
    return numbers<double>(type, items * components);
}

std::vector<std::int64_t> VtkText::integers(std::string_view type, std::size_t items)
{
    return numbers<std::int64_t>(type, items);
}

bool VtkText::is_text(std::string_view type)
{
    return is_keyword(type, "STRING") || is_keyword(type, "UTF8_STRING") ||
           is_keyword(type, "VARIANT");
}

/// The number of bytes that follow: the two highest bits of the first byte say in how many bytes
/// it is written (3: 1, 2: 2, 1: 4, 0: 8), the others are its first digits.
std::size_t VtkText::binary_text_size()
{
    const auto byte = [this](std::size_t i) { return static_cast<unsigned char>(rest_[i]); };
    const std::size_t bytes = rest_.empty() ? 1 : std::size_t(1) << (3 - (byte(0) >> 6));
    if (bytes > rest_.size()) {
        fail("it ends early");
        return 0;
    }
    std::size_t size = byte(0) & 0x3FU;
    for (std::size_t i = 1; i < bytes; ++i)
        size = size << 8 | byte(i);
    rest_.remove_prefix(bytes);
    return size;
}

void VtkText::skip_texts(std::string_view type, std::size_t items, std::size_t components)
{
    line(); // The block begins after the end of the line that announces it.
    if (components != 0 && items > rest_.size() / components)
        return fail("it ends early");
    const bool has_sizes = is_binary && !is_keyword(type, "VARIANT");
    for (std::size_t i = 0; i < items * components && !failed(); ++i) {
        if (rest_.empty())
            return fail("it ends early");
        if (!has_sizes) {
            line(); // What would break it is encoded.
            continue;
        }
        const std::size_t size = binary_text_size();
        if (size > rest_.size())
            return fail("it ends early");
        rest_.remove_prefix(size);
    }
}

} // namespace kb
