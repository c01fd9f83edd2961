// SPDX-License-Identifier: MIT
//
// What a segment adds to what is in front of it, of which 1 - alpha is left to be seen:
//
//     color += (1 - alpha_before) (thin color * alpha + (thick - thin color) * fading)
//     alpha += (1 - alpha_before) * alpha
//
// alpha and fading are those of segment_opacity.hpp: of a segment of no length both are 0, and that
// adds nothing at all.

#include "volume/volume_program.hpp"

#include "volume/face_program.hpp"
#include "volume/segment_opacity.hpp"
#include "volume/segment_texture.hpp"
#include "volume/two_nearest.hpp"

#include <fmt/format.h>

#include <iterator>

namespace kb
{

static constexpr int first_waiting = 3;
static constexpr const char *header = "!!ARBfp1.0\n"
                                      "OPTION MESA_kbuffer_program;\n";

int volume_entries(int k)
{
    return first_waiting + waiting_entries(k);
}

int max_waiting(int entries)
{
    return 2 * (entries - first_waiting);
}

std::string make_clear_program(int k)
{
    std::string text = header;
    for (int entry = 0; entry < volume_entries(k); ++entry)
        fmt::format_to(std::back_inserter(text), "MOV result.kbuffer[{}], 0.0;\n", entry);
    return text + "MOV result.kbuffer[1].w, fragment.color.x;\n"
                  "END\n";
}

/// Composites the segment of entry 2. What needs it is the longest chain: it comes first.
static std::string make_composite()
{
    return "TEMP optics, whole, depth, opacity, weight;\n"
           "TEX optics, kbuffer[2], texture[0], RECT;\n"
           "MUL depth.x, optics.w, kbuffer[2].z;\n" +
           make_opacity_program() +
           fmt::format("SUB weight.w, 1.0, kbuffer[0].w;\n"
                       "MAD result.kbuffer[0].w, weight.w, opacity.x, kbuffer[0].w;\n"
                       "MUL weight.x, weight.w, {};\n"
                       "MUL weight.y, weight.w, kbuffer[2].w;\n"
                       "MUL weight.xy, weight, opacity;\n"
                       "FLR whole.xyz, optics;\n"
                       "SUB optics.xyz, optics, whole;\n"
                       "SUB optics.xyz, optics, 0.5;\n"
                       "MUL optics.xyz, optics, weight.y;\n"
                       "MAD optics.xyz, whole, weight.x, optics;\n"
                       "ADD result.kbuffer[0].xyz, kbuffer[0], optics;\n",
                       1.0 / PackedSegmentTexture::color_steps);
}

/// Composites the parts of the segment of entry 2, front to back. They are of one length and of one
/// difference, so that only the sum of the scalars at their ends differs.
static std::string make_composite_parts(int parts, TableSize table)
{
    const TablePlace place(table);
    constexpr double scale = CodedScalar::scale;
    std::string text = fmt::format(
        "TEMP segment_place, texel, optics, change, depth, opacity, weight, sum;\n"
        "PARAM to_texel = {{ {}, {}, 0.0, 0.0 }};\n"
        "PARAM first_texel = {{ {}, {}, 0.0, 0.0 }};\n"
        "ADD segment_place.x, kbuffer[2].x, kbuffer[2].y;\n"
        "SUB segment_place.w, kbuffer[2].y, kbuffer[2].x;\n"
        "MUL segment_place.w, segment_place.w, {};\n" // The difference of a part.
        "ABS segment_place.z, segment_place.w;\n"
        "ADD segment_place.z, segment_place.z, {};\n"
        "RCP segment_place.z, segment_place.z;\n"
        "MUL segment_place.y, segment_place.w, segment_place.z;\n"
        "MAD segment_place.xy, segment_place, to_texel, first_texel;\n"
        "MUL segment_place.z, segment_place.w, {};\n" // From a part to the next.
        "MOV texel, segment_place;\n"
        "MOV sum, kbuffer[0];\n",
        place.sum_scale / scale / table.means, place.difference_scale / table.differences,
        (place.sum_offset - 2.0 * CodedScalar::offset * place.sum_scale / scale) / table.means,
        place.difference_offset / table.differences, 1.0 / (parts * scale),
        PreintegratedTable::half_difference, 2.0 * place.sum_scale / table.means);
    for (int i = 0; i < parts; ++i)
        text += fmt::format("MAD texel.x, segment_place.z, {}, segment_place.x;\n"
                            "TEX optics, texel, texture[0], 2D;\n"
                            "TEX change, texel, texture[1], 2D;\n"
                            "MUL depth.x, optics.w, kbuffer[2].z;\n",
                            i - 0.5 * (parts - 1)) +
                make_opacity_program() +
                "SUB weight.w, 1.0, sum.w;\n"
                "MUL weight.xy, opacity, weight.w;\n"
                "MUL weight.z, weight.y, segment_place.w;\n"
                "MAD sum.xyz, optics, weight.x, sum;\n"
                "MAD sum.xyz, change, weight.z, sum;\n"
                "ADD sum.w, sum.w, weight.x;\n";
    return text + "MOV result.kbuffer[0], sum;\n";
}

/// Makes entry 1 of the nearest fragment. Leaves the length of the segment between the two in
/// `segment.x`, 0 if there is none, and the scalar of its back end in `nearest.y`.
static std::string make_take_segment()
{
    return "TEMP tag, segment;\n"
           "FLR tag.x, nearest.y;\n"
           "SUB nearest.y, nearest.y, tag.x;\n"
           "ADD result.kbuffer[1].z, kbuffer[1].z, tag.x;\n"
           // One that comes too late is the end of no segment: the farthest stays.
           "SUB segment.x, nearest.x, kbuffer[1].x;\n"
           "SGE segment.y, nearest.x, kbuffer[1].x;\n"
           "CMP result.kbuffer[1].xy, -segment.y, nearest, kbuffer[1];\n"
           "MAX segment.x, segment.x, 0.0;\n"
           "CMP segment.x, -kbuffer[1].z, segment.x, 0.0;\n";
}

/// Makes entry 2 of that segment.
static std::string make_keep_parts(int parts)
{
    return fmt::format("MUL segment.x, segment.x, kbuffer[1].w;\n"
                       "MUL result.kbuffer[2].z, segment.x, {};\n"
                       "MOV result.kbuffer[2].x, kbuffer[1].y;\n"
                       "MOV result.kbuffer[2].y, nearest.y;\n",
                       0.5 / parts);
}

static std::string make_keep_whole(TableSize table)
{
    using Packed = PackedSegmentTexture;
    const TablePlace place(table);
    // A scalar is (code - offset) / scale.
    constexpr double scale = CodedScalar::scale;
    return fmt::format("MUL result.kbuffer[2].z, segment.x, kbuffer[1].w;\n"
                       "ADD segment.x, nearest.y, kbuffer[1].y;\n"
                       "MAD result.kbuffer[2].x, segment.x, {}, {};\n"
                       "SUB segment.x, nearest.y, kbuffer[1].y;\n"
                       "ABS segment.y, segment.x;\n"
                       "MAX segment.z, segment.y, {};\n"
                       "MUL result.kbuffer[2].w, segment.z, {};\n"
                       "ADD segment.y, segment.y, {};\n"
                       "RCP segment.y, segment.y;\n"
                       "MUL segment.x, segment.x, segment.y;\n"
                       "MAD result.kbuffer[2].y, segment.x, {}, {};\n",
                       place.sum_scale / scale,
                       place.sum_offset - 2.0 * CodedScalar::offset * place.sum_scale / scale,
                       Packed::least_difference * scale, Packed::change_range / scale,
                       PreintegratedTable::half_difference * scale, place.difference_scale,
                       place.difference_offset);
}

std::string make_volume_program(int k, SegmentLookup lookup)
{
    const TableSize table = table_size(lookup);
    const bool cut = lookup.interpolates();
    return header +
           fmt::format("# Puts in order what is no more than {} places from where it belongs.\n",
                       k) +
           (cut ? make_composite_parts(lookup.parts, table) : make_composite()) +
           make_take_nearest(k, first_waiting) + make_take_segment() +
           (cut ? make_keep_parts(lookup.parts) : make_keep_whole(table)) + "END\n";
}

std::string make_volume_shader(int cuts)
{
    return fmt::format("const float cuts = {}.0;\n"
                       "const float scalar_scale = {:.9e};\n"
                       "const float scalar_offset = {:.9e};\n",
                       cuts, CodedScalar::scale, CodedScalar::offset) +
           make_opacity_shader() + R"(
vec4 color;
vec4 front;

void start(vec4 entry0, vec4 entry1)
{
    color = entry0;
    front = entry1;
}

vec4 light_of(vec4 optics, vec3 change, float segment)
{
    vec2 opacities = opacity(0.5 * optics.a * segment);
    return vec4(optics.rgb * opacities.x + change * opacities.y, opacities.x);
}

void add_optics(vec4 optics, vec3 change, float segment)
{
    color += (1.0 - color.a) * light_of(optics, change, segment);
}

// Between scalars that are no further apart than 1 / cuts. What its parts let through is multiplied
// before it is added to what there is: a sum of many thin parts would stay below 1. Primes, as cuts
// is one: no part ends at 1/2, 1/4, 1/10, where transfer functions have their steps.
void add_segment(float from, float to, float segment)
{
    vec3 change;
    vec4 optics = look_up(from, to, change);
    float wanted = cuts > 0.0 ? 4.0 * sqrt(optics.a * segment) : 1.0;
    float parts = wanted > 7.0 ? 17.0 : wanted > 1.0 ? 7.0 : 1.0;
    if (!(parts > 1.0)) {
        add_optics(optics, change, segment);
        return;
    }
    vec3 added = vec3(0.0);
    float through = 1.0;
    for (float i = 0.0; i < parts; ++i) {
        optics = look_up(mix(from, to, i / parts), mix(from, to, (i + 1.0) / parts), change);
        vec4 light = light_of(optics, change, segment / parts);
        added += through * light.rgb;
        through *= 1.0 - light.a;
    }
    color += (1.0 - color.a) * vec4(added, 1.0 - through);
}

void add_cut(float from_code, float to_code, float segment)
{
    float from = (from_code - scalar_offset) / scalar_scale;
    float to = (to_code - scalar_offset) / scalar_scale;
    float parts = max(ceil(abs(to - from) * cuts), 1.0);
    segment /= parts;
    float first = from;
    for (float i = 1.0; i < parts; ++i) {
        float end = mix(first, to, i / parts);
        add_segment(from, end, segment);
        from = end;
    }
    add_segment(from, to, segment);
}

void add(vec2 fragment)
{
    float tag = floor(fragment.y);
    float untagged = fragment.y - tag;
    float segment = fragment.x - front.x;
    if (segment > 0.0 && front.z > 0.5)
        add_cut(front.y, untagged, segment * front.w);
    front.z += tag;
    if (segment >= 0.0)
        front.xy = vec2(fragment.x, untagged);
}
)";
}

} // namespace kb
