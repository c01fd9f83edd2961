// SPDX-License-Identifier: MIT
//
// Takes the place of malloc and its kin for the whole process, and lets one allocation fail that
// some source files make, be it directly or through one of Mesa's functions that allocate for their
// caller. Which code is those files' is read from the debugging information of the library.

#pragma once

#include "lib/result.hpp"

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace kb::test
{

/// Looks through a shared library that is loaded. From now on the allocations count that these
/// files (by their path in the source tree) make in it.
Status watch_allocations(const std::string &library, std::span<const std::string> files,
                         std::span<const std::string> helpers);

/// The n-th allocation from now on fails, n counting from 0, and no other; those of all threads
/// count.
void fail_allocation(int n);

struct Allocations {
    bool failed = false;                ///< The n-th was reached.
    std::uintptr_t site = 0;            ///< Where it failed.
    std::vector<std::uintptr_t> places; ///< All call sites that were reached.
};

/// Ends that: no allocation fails any more.
Allocations stop_failing();

/// "function (file:line)" of a call site.
std::string describe_site(std::uintptr_t site);

} // namespace kb::test
