// SPDX-License-Identifier: MIT
//
// With A the optical depth up to a point, the segment between two points adds
//
//     color (exp(-A_front) - exp(-A_back)) = color (alpha_back - alpha_front)
//
// Alphas telescope, however short the segments: the sum of what they add is 1 - exp(-A) of the
// whole to the rounding of A, and a segment of no length adds nothing at all.

#include "volume_program.hpp"

#include "preintegration.hpp"
#include "sorted_faces.hpp"
#include "two_nearest.hpp"

#include <fmt/format.h>

#include <cmath>

namespace kb
{

namespace
{

constexpr int first_waiting = 2;

/// Texel i of n has its center at (i + 0.5) / n.
struct TableScale {
    double scale;
    double offset;
};
constexpr TableScale scale_of(int texels)
{
    return {static_cast<double>(texels - 1) / texels, 0.5 / texels};
}

constexpr double log2_of_e = 1.4426950408889634;

} // namespace

int volume_entries(int k)
{
    return first_waiting + waiting_entries(k);
}

int max_waiting(int entries)
{
    return 2 * (entries - first_waiting);
}

std::string make_volume_program(int k, float max_length)
{
    const TableScale scalar = scale_of(PreintegratedTable::scalars);
    const TableScale length = scale_of(PreintegratedTable::lengths);
    std::string text = "!!ARBfp1.0\n"
                       "OPTION MESA_kbuffer_program;\n";
    text +=
        fmt::format("# Puts in order what is no more than {} places from where it belongs.\n", k);
    text += make_take_nearest(k, first_waiting);
    text += fmt::format("TEMP tag, segment, place, optics, depth;\n"
                        // The tag of an entry is +1, that of an exit -1.
                        "MAD tag.x, nearest.y, {0}, 0.5;\n"
                        "FLR tag.x, tag.x;\n"
                        "MAD nearest.y, tag.x, {1}, nearest.y;\n"
                        "ADD result.kbuffer[1].z, kbuffer[1].z, tag.x;\n"
                        // One that comes too late is the end of no segment: the farthest stays.
                        "SUB segment.x, nearest.x, kbuffer[1].x;\n"
                        "MAX result.kbuffer[1].x, nearest.x, kbuffer[1].x;\n"
                        "CMP result.kbuffer[1].y, segment.x, kbuffer[1].y, nearest.y;\n"
                        "MAX segment.x, segment.x, 0.0;\n"
                        "SLT segment.y, 0.5, kbuffer[1].z;\n"
                        "MUL segment.x, segment.x, segment.y;\n",
                        1.0F / SortedFaces::boundary_tag, -SortedFaces::boundary_tag);
    text += fmt::format("MAD place.x, kbuffer[1].y, {0}, {1};\n"
                        "MAD place.y, nearest.y, {0}, {1};\n"
                        // sqrt(x) = x rsqrt(x), without the reciprocal of 0.
                        "MAX place.w, segment.x, 1e-20;\n"
                        "RSQ place.z, place.w;\n"
                        "MUL place.z, place.z, place.w;\n"
                        "MAD place.z, place.z, {2}, {3};\n"
                        "TEX optics, place, texture[0], 3D;\n",
                        scalar.scale, scalar.offset, length.scale / std::sqrt(max_length),
                        length.offset);
    text += fmt::format("MUL depth.x, optics.w, segment.x;\n"
                        "ADD depth.x, depth.x, kbuffer[1].w;\n"
                        "MOV result.kbuffer[1].w, depth.x;\n"
                        "MUL depth.y, depth.x, {};\n"
                        "EX2 depth.y, depth.y;\n"
                        "SUB depth.y, 1.0, depth.y;\n"
                        "MOV result.kbuffer[0].w, depth.y;\n"
                        "SUB depth.z, depth.y, kbuffer[0].w;\n"
                        "MAD result.kbuffer[0].xyz, optics, depth.z, kbuffer[0];\n"
                        "END\n",
                        -log2_of_e);
    return text;
}

std::string make_volume_shader(float max_length)
{
    const TableScale scalar = scale_of(PreintegratedTable::scalars);
    const TableScale length = scale_of(PreintegratedTable::lengths);
    return fmt::format("uniform sampler3D segment_table;\n"
                       "const float tag = {:.1f};\n"
                       "const vec3 table_scale = vec3({:.9f}, {:.9f}, {:.9f});\n"
                       "const vec3 table_offset = vec3({:.9f}, {:.9f}, {:.9f});\n",
                       SortedFaces::boundary_tag, scalar.scale, scalar.scale,
                       length.scale / std::sqrt(max_length), scalar.offset, scalar.offset,
                       length.offset) +
           R"(
vec4 color;
vec4 front;

void start(vec4 entry0, vec4 entry1)
{
    color = entry0;
    front = entry1;
}

void add(vec2 fragment)
{
    float inside = floor(fragment.y / tag + 0.5);
    float scalar = fragment.y - inside * tag;
    float segment = fragment.x - front.x;
    if (segment > 0.0 && front.z > 0.5) {
        vec3 place = vec3(front.y, scalar, sqrt(segment)) * table_scale + table_offset;
        vec4 optics = textureLod(segment_table, place, 0.0);
        front.w += optics.w * segment;
        float alpha = 1.0 - exp(-front.w);
        color = vec4(color.rgb + optics.rgb * (alpha - color.a), alpha);
    }
    front.z += inside;
    if (segment >= 0.0)
        front.xy = vec2(fragment.x, scalar);
}
)";
}

} // namespace kb
