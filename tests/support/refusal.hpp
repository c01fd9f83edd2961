// SPDX-License-Identifier: MIT

#pragma once

#include "tests/support/process.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace kb::test
{

/// A program that refuses its input says so in one line, with its name and what is wrong, and
/// nothing else.
inline void expect_refused(const ProcessResult &result, const std::string &program,
                           const std::string &mention, int status = 2)
{
    EXPECT_EQ(result.status, status);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err.find(program + ": "), 0U) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_NE(result.err.find(mention), std::string::npos) << result.err;
}

} // namespace kb::test
