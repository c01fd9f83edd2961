// SPDX-License-Identifier: MIT
//
// Entries of the k-buffer of a volume:
//
//     0     red, green, blue, alpha of what is in front
//     1     distance and scalar of the last fragment that left those that wait, the front end of
//           the next segment; how many times the ray is inside the grid there; optical depth
//     2...  fragments that wait, two an entry
//
// All are 0 at first. Segments of which the front end is outside of the grid add nothing.

#pragma once

#include "preintegration.hpp"

#include <string>

namespace kb
{

/// Entries of a k-buffer in which k fragments wait.
int volume_entries(int k);

/// The k that a k-buffer of this many entries has room for.
int max_waiting(int entries);

/// The k-buffer program: puts a fragment among those that wait, and composites the segment that
/// ends at the one that leaves. The table is in texture units 0 and 1.
std::string make_volume_program(int k, TableSize table);

/// The same in GLSL 3.30, for fragments that come in order: declares
///
///     void start(vec4 entry0, vec4 entry1)
///     void add(vec2 fragment)    distance, tagged scalar
///     vec4 color;                entry 0
///     vec4 front;                entry 1
///
/// and the uniforms sampler2D thin and fading, the table. A segment is cut where its scalars are
/// further apart than 1 / cuts, unless that is 0: the table neglects that extinction bends within
/// opaque segments.
std::string make_volume_shader(TableSize table, int cuts);

} // namespace kb
