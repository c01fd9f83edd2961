// SPDX-License-Identifier: MIT
//
// The study itself: which worker draws what, in which order, and what becomes of it.

#pragma once

#include "bench/options.hpp"
#include "bench/report.hpp"

namespace kb::bench
{

struct Study {
    nlohmann::json machine;
    std::vector<Row> rows;
};

/// Measures all that the options ask for, with progress on the standard error output. Throws
/// std::runtime_error when a worker cannot do its part.
Study run_study(const Options &options);

} // namespace kb::bench
