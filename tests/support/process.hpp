// SPDX-License-Identifier: MIT

#pragma once

#include <map>
#include <string>
#include <vector>

namespace kb::test
{

struct ProcessResult {
    int status = -1; ///< Exit status; 128 + signal if it was killed.
    std::string out;
    std::string err;
};

/// Runs a program to its end. `environment` is added to that of this process.
ProcessResult run(const std::vector<std::string> &arguments,
                  const std::map<std::string, std::string> &environment = {});

/// The environment that makes a program use the Mesa of a prefix.
std::map<std::string, std::string> mesa_environment(const std::string &prefix);

/// The patched Mesa: KBUFFER_PREFIX, else the one that this was built against.
std::string patched_prefix();

/// The stock Mesa: KBUFFER_STOCK_PREFIX; empty if there is none.
std::string stock_prefix();

} // namespace kb::test
