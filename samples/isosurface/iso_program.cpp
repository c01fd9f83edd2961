// SPDX-License-Identifier: MIT

#include "isosurface/iso_program.hpp"

#include "volume/two_nearest.hpp"

#include <fmt/format.h>

namespace kb
{

int front_entry(int k)
{
    return waiting_entries(k);
}

int surface_entry(int k)
{
    return waiting_entries(k) + 1;
}

int isosurface_entries(int k)
{
    return waiting_entries(k) + 2;
}

/// What is behind the nearest surface cannot be seen, nor can what is between two such fragments.
static constexpr const char *reject_hidden = R"(
TEMP t;
MAD t.x, -fragment.color.x, kbuffer[{surface}].x, 1.0;
KIL t.x;
)";

/// Gives back.xy, untagged, and inside.x: 1 if there is something between front and back. A tag is
/// added to the scalar where the ray enters the grid and subtracted where it leaves it.
static constexpr const char *grid_segment = R"(
TEMP back, inside;
MAD t.x, nearest.y, {untag}, 0.5;
FLR t.x, t.x;
MOV back.x, nearest.x;
MAD back.y, t.x, -{tag}, nearest.y;
ADD result.kbuffer[{front}].z, kbuffer[{front}].z, t.x;
SGE inside.x, kbuffer[{front}].z, 0.5;
)";

/// No particle has left yet if the front is at 0.
static constexpr const char *particle_segment = R"(
TEMP back, inside;
MOV back.xy, nearest;
SUB t.x, nearest.x, kbuffer[{front}].x;
SGE inside.x, program.local[1].y, t.x;
SLT inside.y, 0.0, kbuffer[{front}].x;
MUL inside.x, inside.x, inside.y;
)";

/// The next iso-value from the front's scalar in the direction of the back's is crossed if it is
/// no farther than that. Segments include both ends: what two of them find at a common end is the
/// same. The division is by 1e-37 at least, so that it gives 0 where both scalars are the
/// iso-value. A fragment that comes too late, nearer than the front, does not become the front.
static constexpr const char *find_surface = R"(
TEMP iso, extent, next, found, seen;
SUB t.x, kbuffer[{front}].y, program.local[1].x;
MAD t, t.x, program.local[0].xyyy, program.local[0].zwww;
TEX iso, t, texture[0], 2D;
SUB extent.xy, back, kbuffer[{front}];
SGE t.x, iso.y, kbuffer[{front}].y;
SGE t.y, kbuffer[{front}].y, iso.y;
CMP next.x, -t.x, iso.y, iso.z;
CMP next.y, -t.y, iso.y, iso.x;
CMP found.y, extent.y, next.y, next.x;
SUB t.x, found.y, kbuffer[{front}].y;
ABS t.x, t.x;
ABS t.y, extent.y;
SGE seen.x, t.y, t.x;
MUL seen.x, seen.x, inside.x;
MAX t.y, t.y, 1e-37;
RCP t.y, t.y;
MUL_SAT t.x, t.x, t.y;
MAD t.x, t.x, extent.x, kbuffer[{front}].x;
RCP found.x, t.x;
SLT seen.y, kbuffer[{surface}].x, found.x;
MUL seen.x, seen.x, seen.y;
CMP result.kbuffer[{surface}].xy, -seen.x, found, kbuffer[{surface}];
CMP result.kbuffer[{front}].xy, extent.x, kbuffer[{front}], back;
END
)";

std::string make_isosurface_program(int k, Medium medium)
{
    const auto place = [k](const char *text) {
        return fmt::format(fmt::runtime(text), fmt::arg("front", front_entry(k)),
                           fmt::arg("surface", surface_entry(k)),
                           fmt::arg("tag", SortedFaces::boundary_tag),
                           fmt::arg("untag", 1.0F / SortedFaces::boundary_tag));
    };
    return "!!ARBfp1.0\nOPTION MESA_kbuffer_program;\n" + place(reject_hidden) +
           make_take_nearest(k, 0) +
           place(medium == Medium::grid ? grid_segment : particle_segment) + place(find_surface);
}

IsosurfaceParameters isosurface_parameters(const IsoTable &table, float gap)
{
    // The neighbours are row 0 of two.
    return {{table.scale, 0.0F, table.offset, 0.25F}, {table.base, gap, 0.0F, 0.0F}};
}

} // namespace kb
