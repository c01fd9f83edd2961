// SPDX-License-Identifier: MIT
//
// Wall-clock times of GL work. The drivers run on the CPU: glFinish at both ends bounds the work.

#pragma once

#include "lib/gl/gl.hpp"

#include <chrono>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace kb
{

/// Order statistics of repeated measurements.
struct Spread {
    double median = 0.0;
    double p5 = 0.0;
    double p95 = 0.0;
    std::size_t count = 0; ///< Of the measurements.
};

/// Percentiles are interpolated between the nearest ranks. No values give zeros.
Spread spread_of(std::span<const double> values);

/// For people: "1.50 ms", and what several measurements say more in brackets, with what is `also`
/// to be said there.
std::string describe(const Spread &milliseconds, std::string_view also = "");

/// Milliseconds from glFinish to glFinish about the work.
double milliseconds(const Gl &gl, const std::function<void()> &work);

} // namespace kb
