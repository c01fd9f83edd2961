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

#include <array>

namespace kb
{

namespace
{

constexpr int first_waiting = 2;
constexpr double log2_of_e = 1.4426950408889634;

/// From what a segment has to texture coordinates: texel i of n has its center at (i + 0.5) / n.
/// The sum of the scalars, scaled, is the place of their mean; a difference d is d / (|d| + half),
/// scaled.
struct TableScale {
    explicit TableScale(TableSize size)
        : mean_scale(0.5 * span(size.means)), mean_offset(0.5 / size.means),
          difference_scale(0.5 * span(size.differences) *
                           (1.0 + PreintegratedTable::half_difference))
    {
    }

    static double span(int texels) { return static_cast<double>(texels - 1) / texels; }

    double mean_scale;
    double mean_offset;
    double difference_scale;
};

/// c[3] x^4 + c[2] x^3 + c[1] x^2 + c[0] x + last.
std::string polynomial(const std::string &result, const std::string &x,
                       const std::array<double, 4> &c, double last)
{
    return fmt::format("MAD {0}, {1}, {2}, {3};\n"
                       "MAD {0}, {0}, {1}, {4};\n"
                       "MAD {0}, {0}, {1}, {5};\n"
                       "MAD {0}, {0}, {1}, {6};\n",
                       result, x, c[3], c[2], c[1], c[0], last);
}

} // namespace

int volume_entries(int k)
{
    return first_waiting + waiting_entries(k);
}

int max_waiting(int entries)
{
    return 2 * (entries - first_waiting);
}

std::string make_volume_program(int k, TableSize table)
{
    const TableScale scale(table);
    std::string text = "!!ARBfp1.0\n"
                       "OPTION MESA_kbuffer_program;\n";
    text +=
        fmt::format("# Puts in order what is no more than {} places from where it belongs.\n", k);
    text += make_take_nearest(k, first_waiting);
    text += fmt::format("TEMP tag, segment, place, optics, fading, depth, alpha;\n"
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
    text += fmt::format("ADD place.x, nearest.y, kbuffer[1].y;\n"
                        "MAD place.x, place.x, {}, {};\n"
                        "SUB segment.y, nearest.y, kbuffer[1].y;\n"
                        "ABS segment.z, segment.y;\n"
                        "ADD segment.z, segment.z, {};\n"
                        "RCP segment.z, segment.z;\n"
                        "MUL segment.z, segment.y, segment.z;\n"
                        "MAD place.y, segment.z, {}, 0.5;\n"
                        "TEX optics, place, texture[0], 2D;\n"
                        "TEX fading, place, texture[1], 2D;\n"
                        "MUL depth.x, optics.w, segment.x;\n",
                        scale.mean_scale, scale.mean_offset, PreintegratedTable::half_difference,
                        scale.difference_scale);
    text += polynomial("depth.y", "depth.x", fade_numerator, 0.0);
    text += polynomial("depth.z", "depth.x", fade_denominator, 1.0);
    text += fmt::format("RCP depth.z, depth.z;\n"
                        "MUL depth.y, depth.y, depth.z;\n"
                        "MUL depth.y, depth.y, segment.y;\n"
                        "MAD optics.xyz, fading, depth.y, optics;\n"
                        "ADD depth.x, depth.x, kbuffer[1].w;\n"
                        "MOV result.kbuffer[1].w, depth.x;\n"
                        "MUL alpha.x, depth.x, {};\n"
                        "EX2 alpha.x, alpha.x;\n"
                        "SUB alpha.x, 1.0, alpha.x;\n"
                        "MOV result.kbuffer[0].w, alpha.x;\n"
                        "SUB alpha.y, alpha.x, kbuffer[0].w;\n"
                        "MAD result.kbuffer[0].xyz, optics, alpha.y, kbuffer[0];\n"
                        "END\n",
                        -log2_of_e);
    return text;
}

std::string make_volume_shader(TableSize table, int cuts)
{
    const TableScale scale(table);
    const auto vector = [](const std::array<double, 4> &c) {
        return fmt::format("vec4({:.9f}, {:.9f}, {:.9f}, {:.9f})", c[0], c[1], c[2], c[3]);
    };
    return fmt::format("uniform sampler2D thin;\n"
                       "uniform sampler2D fading;\n"
                       "const float cuts = {}.0;\n"
                       "const float tag = {:.1f};\n"
                       "const float half_difference = {:.9f};\n"
                       "const vec2 table_scale = vec2({:.9f}, {:.9f});\n"
                       "const vec2 table_offset = vec2({:.9f}, 0.5);\n"
                       "const vec4 fade_numerator = {};\n"
                       "const vec4 fade_denominator = {};\n",
                       cuts, SortedFaces::boundary_tag, PreintegratedTable::half_difference,
                       scale.mean_scale, scale.difference_scale, scale.mean_offset,
                       vector(fade_numerator), vector(fade_denominator)) +
           R"(
vec4 color;
vec4 front;

void start(vec4 entry0, vec4 entry1)
{
    color = entry0;
    front = entry1;
}

float polynomial(float x, vec4 c)
{
    return x * (c.x + x * (c.y + x * (c.z + x * c.w)));
}

void add_segment(float from, float to, float segment)
{
    float difference = to - from;
    vec2 place = vec2(from + to, difference / (abs(difference) + half_difference)) *
                     table_scale + table_offset;
    vec4 optics = textureLod(thin, place, 0.0);
    float depth = optics.w * segment;
    float fade = polynomial(depth, fade_numerator) / (1.0 + polynomial(depth, fade_denominator));
    optics.rgb += fade * difference * textureLod(fading, place, 0.0).rgb;
    front.w += depth;
    float alpha = 1.0 - exp(-front.w);
    color = vec4(color.rgb + optics.rgb * (alpha - color.a), alpha);
}

void add(vec2 fragment)
{
    float inside = floor(fragment.y / tag + 0.5);
    float scalar = fragment.y - inside * tag;
    float segment = fragment.x - front.x;
    if (segment > 0.0 && front.z > 0.5) {
        float parts = max(ceil(abs(scalar - front.y) * cuts), 1.0);
        float from = front.y;
        for (float i = 1.0; i < parts; ++i) {
            float to = mix(front.y, scalar, i / parts);
            add_segment(from, to, segment / parts);
            from = to;
        }
        add_segment(from, scalar, segment / parts);
    }
    front.z += inside;
    if (segment >= 0.0)
        front.xy = vec2(fragment.x, scalar);
}
)";
}

} // namespace kb
