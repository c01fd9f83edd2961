// SPDX-License-Identifier: MIT

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kb
{

/// The first word of a line; empty if it has none.
std::string_view first_word(std::string_view line);

/// A word in quotation marks for messages: cut off if it is long, without what cannot be printed.
std::string quoted(std::string_view word);

/// Whether a word is a keyword (which is given in capitals); the format has no case.
bool is_keyword(std::string_view word, std::string_view keyword);

/// Words and blocks of numbers of a legacy VTK file, from front to back. The first thing that is
/// wrong is kept as the error and ends the text: what is read after it is empty, zero and of no
/// meaning.
class VtkText
{
public:
    explicit VtkText(std::string_view text) : rest_(text) {}

    bool is_binary = false;
    bool is_little_endian = false; ///< Binary numbers, against the format.

    void fail(const std::string &reason);
    bool failed() const { return !error_.empty(); }
    const std::string &error() const { return error_; }

    bool at_end() const { return rest_.empty(); }
    /// The rest of the line that has begun.
    std::string_view line();
    /// The next word; empty at the end.
    std::string_view word();
    /// The first word of the rest of this line, or of the next one, which is not taken.
    std::string_view next_on_this_line() const;
    std::string_view next_line_begin() const;
    std::size_t count(const char *of_what);

    /// A block of items with so many components, stored as the named type. What ASCII files call
    /// floats is read with all of its digits.
    std::vector<double> reals(std::string_view type, std::size_t items, std::size_t components = 1);
    std::vector<std::int64_t> integers(std::string_view type, std::size_t items);

    /// Whether items of that type are no numbers but text.
    static bool is_text(std::string_view type);
    /// A block of so many pieces of text.
    void skip_texts(std::string_view type, std::size_t items, std::size_t components = 1);

private:
    template <class T>
    std::vector<T> numbers(std::string_view type, std::size_t wanted);
    std::vector<double> binary_bits(std::size_t wanted);
    std::size_t binary_text_size();
    template <class Stored, class T>
    std::vector<T> stored_as(std::size_t wanted);
    template <class Stored, class T>
    std::vector<T> binary_numbers(std::size_t wanted);
    template <class Stored, class T>
    std::vector<T> ascii_numbers(std::size_t wanted);

    std::string_view rest_;
    std::string error_;
};

} // namespace kb
