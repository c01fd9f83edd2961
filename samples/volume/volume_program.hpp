// SPDX-License-Identifier: MIT
//
// Entries of the k-buffer of a volume:
//
//     0     red, green, blue, alpha of what is in front
//     1     depth and scalar (a CodedScalar without its tag) of the last fragment that left those
//           that wait, the front end of the next segment; how many times the ray is inside the
//           grid there; the length of the pixel's ray from depth 0 to 1
//     2     the last segment, which is composited with the next fragment: its texel's place, its
//           length, and its range, by which the change of color is multiplied; of one that is cut
//           the scalars (CodedScalars without tags) of its front and back end, and half of the
//           length of a part
//     3...  fragments that wait, two an entry
//
// (The two parts of the program, to put a fragment among those that wait, and to look a segment up
// and composite it, are long chains of operations. That one does not need what the other has found
// just now lets a processor work on both at once.)
//
// All are 0 at first, but the length. Segments of which the front end is outside of the grid add
// nothing.

#pragma once

#include "volume/segment_lookup.hpp"

#include <string>

namespace kb
{

/// Entries of a k-buffer in which k fragments wait.
int volume_entries(int k);

/// The k that a k-buffer of this many entries has room for.
int max_waiting(int entries);

/// The k-buffer program that clears the entries: the ray's length is `fragment.color.x`.
std::string make_clear_program(int k);

/// The k-buffer program that puts a fragment among those that wait, and composites the segment that
/// ends at the one that leaves. A fragment is its depth and its CodedScalar. The lookup's texture
/// is in texture unit 0, or the textures in units 0 and 1.
std::string make_volume_program(int k, SegmentLookup lookup);

/// The same in GLSL 3.30, for fragments that come in order: declares
///
///     void start(vec4 entry0, vec4 entry1)
///     void add_optics(vec4 optics, vec3 change, float segment)    as look_up gives them, length
///     void add_cut(float from, float to, float segment)           CodedScalars, length
///     void add(vec2 fragment)                                     depth, CodedScalar
///     vec4 color;                entry 0
///     vec4 front;                entry 1
///
/// to stand behind the shader of SegmentTextures or of a PackedSegmentTexture. Unless `cuts` is 0 a
/// segment is cut where its scalars are further apart than 1 / cuts, and once more where that is
/// opaque: the table neglects that extinction bends within opaque segments.
std::string make_volume_shader(int cuts);

} // namespace kb
