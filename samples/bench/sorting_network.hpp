// SPDX-License-Identifier: MIT
//
// GLSL that sorts the fragments of a pixel in registers. llvmpipe runs a sorting network several
// times as fast as an insertion or shell sort, whose indexed local array it scatters into memory
// pixel by pixel.
#pragma once

#include <string>
#include <string_view>

namespace kb::bench
{

/// Statements that declare `float z0...` and `uint color0...` and sort them by z, nearest first, by
/// Batcher's odd-even mergesort. An `int count` says how many fragments there are; what only more
/// would need is skipped. `load` is a format string of statements that set `z{0}` and `color{0}`,
/// for a slot that is below the count.
std::string load_sorted_glsl(int slots, std::string_view load);

/// Statements that composite what load_sorted_glsl sorted into `vec4 color`, over the background.
std::string composite_sorted_glsl(int slots);

} // namespace kb::bench
