// SPDX-License-Identifier: MIT
//
// Wall-clock times of GL work. The drivers run on the CPU: glFinish at both ends bounds the work.

#pragma once

#include "gl.hpp"

#include <chrono>
#include <functional>
#include <span>

namespace kb
{

/// Order statistics of repeated measurements.
struct Spread {
    double median = 0.0;
    double p5 = 0.0;
    double p95 = 0.0;
};

/// Percentiles are interpolated between the nearest ranks. No values give zeros.
Spread spread_of(std::span<const double> values);

/// Milliseconds from glFinish to glFinish about the work.
double milliseconds(const Gl &gl, const std::function<void()> &work);

} // namespace kb
