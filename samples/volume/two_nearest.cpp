// SPDX-License-Identifier: MIT
//
// The fragment bubbles through those that wait: unless it is nearer than one, it takes that one's
// place, and goes on as that one. What comes out at the end is the nearest. With (d, v) the pair of
// depth and value:
//
//     (nearest, waiting[i]) = nearest.d < waiting[i].d ? (nearest, waiting[i])
//                                                      : (waiting[i], nearest)
//
// Of equal depths those farther on in the line have come first, and they leave first.

#include "volume/two_nearest.hpp"

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
    std::string text = "TEMP nearest, farther;\n"
                       "MOV nearest.xy, fragment.color;\n";
    for (int i = 0; i < k; ++i) {
        const int entry = first_entry + i / 2;
        const bool second = i % 2 == 1;
        // CMP tests for less than zero. What the entry keeps is the last operand: the compiler
        // makes one condition of this and of that the fragment is there at all.
        fmt::format_to(std::back_inserter(text),
                       "SGE farther.x, nearest.x, kbuffer[{0}].{1};\n"
                       "CMP result.kbuffer[{0}].{2}, -farther.x, nearest.xyxy, kbuffer[{0}];\n"
                       "CMP nearest.xy, -farther.x, kbuffer[{0}].{3}, nearest;\n",
                       entry, second ? "z" : "x", second ? "zw" : "xy", second ? "zwzw" : "xyxy");
    }
    return text;
}

} // namespace kb
