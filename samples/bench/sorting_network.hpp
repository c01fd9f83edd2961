// SPDX-License-Identifier: MIT
//
// GLSL that sorts the fragments of a pixel in registers. In llvmpipe a sorting network is faster
// than an insertion sort, whose indexed local array goes to memory pixel by pixel.
//
// Slot i is a pair of variables, `float z<i>` and `uint item<i>`; nearest first, and where depths
// are equal the smaller item first. Slots without a fragment are behind all others.
#pragma once

#include <string>
#include <string_view>

namespace kb::bench
{

/// Statements that declare empty slots: `count` of them from `first`.
std::string declare_slots_glsl(int first, int count);

/// Statements that fill slots and sort them by Batcher's odd-even mergesort. `load` is a format
/// string of statements for slot {0}, of which {1} is the number within these slots. The expression
/// `filled` says how many slots they fill; what only more would need is skipped.
std::string load_sorted_glsl(int first, int count, std::string_view filled, std::string_view load);

/// Statements that put the `count` nearest of two sorted runs of slots, which follow each other
/// from slot 0, into the first run, sorted. `count` is a power of two.
std::string merge_nearest_glsl(int count);

/// Statements that composite the first slots into `vec4 color`, over the background. The expression
/// `item_color` gives the color of slot {0} as four bytes; `filled` is as above.
std::string composite_sorted_glsl(int count, std::string_view filled, std::string_view item_color);

} // namespace kb::bench
