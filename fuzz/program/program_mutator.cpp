// SPDX-License-Identifier: MIT
//
// Mutations of program strings: of statements where that is possible, else of bytes and of words
// of the dictionary, as libFuzzer does them.

#include "fuzz/program/grammar.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t *data, std::size_t size, std::size_t max_size);

namespace kb::fuzz
{

namespace
{

/// The string in pieces that end with a semicolon or a line end; whatever it is.
std::vector<std::string> split(std::string_view text)
{
    std::vector<std::string> statements;
    while (!text.empty()) {
        const std::size_t length = std::min(text.find_first_of(";\n"), text.size() - 1) + 1;
        statements.emplace_back(text.substr(0, length));
        text.remove_prefix(length);
    }
    return statements;
}

std::string join(const std::vector<std::string> &statements)
{
    std::string text;
    for (const std::string &statement : statements)
        text += statement;
    return text;
}

/// Another number where there is one, else another operand.
void change_word(Random &random, std::string &statement)
{
    const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
    const std::size_t from = random.below(statement.size());
    const auto digit = std::find_if(statement.begin() + long(from), statement.end(), is_digit);
    if (digit != statement.end() && !random.one_in(3)) {
        const auto end = std::find_if_not(digit, statement.end(), is_digit);
        statement.replace(digit, end, std::to_string(random.below(random.one_in(4) ? 300 : 9)));
        return;
    }
    const std::size_t comma = statement.find(',', from);
    if (comma != std::string::npos)
        statement.replace(comma + 1, statement.find_first_of(",;", comma + 1) - comma - 1,
                          ' ' + random_source(random));
}

void mutate_statements(Random &random, std::vector<std::string> &statements)
{
    using Difference = std::vector<std::string>::difference_type;
    const auto place = [&] {
        return statements.begin() + Difference(random.below(statements.size()));
    };

    if (statements.empty()) {
        statements = {"!!ARBfp1.0\n", "OPTION MESA_kbuffer_program;\n", "TEMP t, u, v;\n",
                      random_statement(random), "\nEND\n"};
        return;
    }
    switch (random.below(8)) {
    case 0:
        statements.erase(place());
        break;
    case 1: {
        const std::string copy = *place();
        statements.insert(place(), copy);
        break;
    }
    case 2:
        std::iter_swap(place(), place());
        break;
    case 3:
        *place() = random_statement(random) + '\n';
        break;
    case 4:
    case 5:
        change_word(random, *place());
        break;
    default:
        // Behind the header and the option, where statements may stand.
        statements.insert(std::max(place(), statements.begin() + Difference(std::min<std::size_t>(
                                                                     statements.size(), 3))),
                          random_statement(random) + '\n');
    }
}

} // namespace

} // namespace kb::fuzz

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t *data, std::size_t size,
                                               std::size_t max_size, unsigned seed)
{
    kb::fuzz::Random random(seed);
    if (random.one_in(3))
        return LLVMFuzzerMutate(data, size, max_size);

    auto statements = kb::fuzz::split({reinterpret_cast<const char *>(data), size});
    for (std::size_t i = 1 + random.below(4); i > 0; --i)
        kb::fuzz::mutate_statements(random, statements);
    const std::string text = kb::fuzz::join(statements);
    if (text.size() > max_size)
        return LLVMFuzzerMutate(data, size, max_size);
    std::memcpy(data, text.data(), text.size());
    return text.size();
}
