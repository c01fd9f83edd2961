// SPDX-License-Identifier: MIT
//
// The k-buffer program. Fragments (distance from the eye, scalar) come about in order; those that
// leave the k-buffer come in order, and each makes a ray segment with the one that left before it.
// If there is an iso-value between the scalars of its ends, linear interpolation gives the distance
// of the surface, which then must pass a depth test: against an entry of the k-buffer.
//
// Entries: first those of make_take_nearest, then
//
//     front     x = distance and y = scalar of the last one that left, z = in how many grids it was
//     surface   x = 1 / distance of the nearest surface, y = its iso-value
//
// Everything is cleared to 0: no fragment has left, the surface is infinitely far away.

#pragma once

#include "isosurface/iso_values.hpp"
#include "programs/kbuffer_program.hpp"

#include <string>

namespace kb
{

/// Which ray segments have something inside.
enum class Medium {
    grid,      ///< Those between the faces that tags say the grid begins and ends at.
    particles, ///< Those no longer than a gap.
};

/// Where the entries are.
int front_entry(int k);
int surface_entry(int k);
int isosurface_entries(int k); ///< How many there are.

/// Two fragments wait in an entry.
inline constexpr int max_isosurface_k = 2 * (max_kbuffer_entries - 2);

/// The program reads the table of iso-values from texture unit 0 and its parameters from
/// program.local[0] and [1].
std::string make_isosurface_program(int k, Medium medium);

struct IsosurfaceParameters {
    glm::vec4 table; ///< program.local[0]: takes a scalar less the base to texture coordinates.
    glm::vec4 rest;  ///< program.local[1]: the base, and the gap.
};
IsosurfaceParameters isosurface_parameters(const IsoTable &table, float gap);

} // namespace kb
