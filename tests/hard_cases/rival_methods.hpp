// SPDX-License-Identifier: MIT
//
// Methods of stock Mesa that the benchmark does not have, each for one case.

#pragma once

#include "lib/gl/gl.hpp"
#include "tests/hard_cases/outcome.hpp"

namespace kb::hard
{

/// Case 13: 400 layers of alpha .01 from back to front by glBlendFunc into RGBA8.
Outcome blend_in_eight_bits(const Gl &gl);

/// Case 24: classic depth peeling with 4 samples. The shader runs once for each pixel, so that it
/// compares the pixel's depth with that of one sample, the first.
Outcome peel_edge_with_samples(const Gl &gl);

} // namespace kb::hard
