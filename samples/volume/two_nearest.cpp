// SPDX-License-Identifier: MIT
//
// The fragment bubbles through those that wait: from each it takes the place if it is farther, and
// goes on as that one if not. What comes out at the end is the nearest. Equal depths need no
// swap. With (d, v) the pair of depth and value:
//
//     swapped = waiting[i].d < nearest.d;  (nearest, waiting[i]) = swapped ? (waiting[i], nearest)
//                                                                          : (nearest, waiting[i])

#include "two_nearest.hpp"

#include <fmt/format.h>

#include <iterator>

namespace kb
{

int waiting_entries(int k)
{
    return (k + 1) / 2;
}

std::string make_take_nearest(int k, int first_entry)
{
    std::string text = "TEMP nearest, waiting, swapped;\n"
                       "MOV nearest.xy, fragment.color;\n";
    for (int i = 0; i < k; ++i) {
        const int entry = first_entry + i / 2;
        const bool second = i % 2 == 1;
        // CMP tests for less than zero.
        fmt::format_to(std::back_inserter(text),
                       "SUB swapped.x, kbuffer[{0}].{1}, nearest.x;\n"
                       "CMP result.kbuffer[{0}].{2}, swapped.x, nearest.{3}, kbuffer[{0}];\n"
                       "CMP nearest.xy, swapped.x, kbuffer[{0}].{4}, nearest;\n",
                       entry, second ? "z" : "x", second ? "zw" : "xy", second ? "xyxy" : "xyxy",
                       second ? "zwzw" : "xyxy");
    }
    return text;
}

} // namespace kb
