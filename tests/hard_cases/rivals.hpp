// SPDX-License-Identifier: MIT
//
// What stock Mesa makes of the hard cases, by the methods of the benchmark and a few others. They
// draw pictures: what is measured is how many pixels are wrong and by how much.

#pragma once

#include "lib/gl/gl.hpp"
#include "tests/hard_cases/outcome.hpp"

namespace kb::hard
{

std::vector<Row> measure_rivals(const Gl &gl);

} // namespace kb::hard
