// SPDX-License-Identifier: MIT
//
// Lines, words and numbers of a text that is in memory. Numbers have a decimal point, whatever the
// locale.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kb
{

/// Takes the next line off the text, without its end (LF or CR LF); none if the text is at its end.
std::optional<std::string_view> take_line(std::string_view &text);

/// Takes the next word off the line; empty if there is none.
std::string_view take_word(std::string_view &line);

/// Without the blanks at both ends.
std::string_view trim(std::string_view text);

/// In small letters, of ASCII.
std::string to_lower(std::string_view text);

/// The number that a whole word is, "nan" and "inf" included; none if it is something else or
/// beyond the range of doubles.
std::optional<double> parse_number(std::string_view word);

/// The integer that a whole word is.
std::optional<std::int64_t> parse_integer(std::string_view word);

} // namespace kb
