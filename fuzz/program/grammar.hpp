// SPDX-License-Identifier: MIT
//
// Random sentences of the language of k-buffer programs, most of them valid: mutations that stay
// within the grammar come further than those of single bytes.

#pragma once

#include "fuzz/random.hpp"

#include <string>

namespace kb::fuzz
{

/// A declaration or an instruction, with its semicolon.
std::string random_statement(Random &random);

/// An operand of an instruction, without a sign or a swizzle.
std::string random_source(Random &random);

/// What an instruction writes to, without a mask.
std::string random_destination(Random &random);

} // namespace kb::fuzz
