// SPDX-License-Identifier: MIT
//
// A broken promise ends the process at once, so that the fuzzer keeps the input that broke it.

#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

namespace kb::fuzz
{

template <class... Args>
[[noreturn]] void finding(fmt::format_string<Args...> format, Args &&...args)
{
    fmt::print(stderr, "finding: {}\n", fmt::format(format, std::forward<Args>(args)...));
    std::fflush(nullptr);
    std::abort();
}

} // namespace kb::fuzz
