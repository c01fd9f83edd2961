// SPDX-License-Identifier: MIT

#include "volume/segment_texture.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace kb
{

static Texture make_texture(const Gl &gl, GLenum target, TableSize size,
                            const std::vector<glm::vec4> &texels, GLint filter)
{
    Texture texture(gl);
    gl.BindTexture(target, texture.id());
    gl.TexImage2D(target, 0, GL_RGBA32F, size.means, size.differences, 0, GL_RGBA, GL_FLOAT,
                  texels.data());
    gl.TexParameteri(target, GL_TEXTURE_MIN_FILTER, filter);
    gl.TexParameteri(target, GL_TEXTURE_MAG_FILTER, filter);
    gl.TexParameteri(target, GL_TEXTURE_MAX_LEVEL, 0);
    gl.TexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.TexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return texture;
}

static void bind_texture(const Texture &texture, GLenum target, int unit)
{
    const Gl &gl = texture.gl();
    gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    gl.BindTexture(target, texture.id());
    gl.ActiveTexture(GL_TEXTURE0);
}

/// vec2 place(from, to): of the texel, where the centers of the first and the last are at 1/2 and
/// at one less.
static std::string make_place_shader(TableSize size)
{
    const TablePlace place(size);
    return fmt::format("vec2 place(float from, float to)\n"
                       "{{\n"
                       "    float difference = to - from;\n"
                       "    return vec2(from + to, difference / (abs(difference) + {:.9e})) *\n"
                       "               vec2({:.9e}, {:.9e}) + vec2({:.9e}, {:.9e});\n"
                       "}}\n",
                       PreintegratedTable::half_difference, place.sum_scale, place.difference_scale,
                       place.sum_offset, place.difference_offset);
}

SegmentTextures::SegmentTextures(const Gl &gl, const PreintegratedTable &table)
    : thin_(make_texture(gl, GL_TEXTURE_2D, table.size(), table.thin(), GL_LINEAR)),
      fading_(make_texture(gl, GL_TEXTURE_2D, table.size(), table.fading(), GL_LINEAR))
{
}

void SegmentTextures::bind(int unit) const
{
    bind_texture(thin_, GL_TEXTURE_2D, unit);
    bind_texture(fading_, GL_TEXTURE_2D, unit + 1);
}

std::string SegmentTextures::shader(TableSize size)
{
    return make_place_shader(size) +
           fmt::format("uniform sampler2D thin;\n"
                       "uniform sampler2D fading;\n"
                       "vec4 look_up(float from, float to, out vec3 change)\n"
                       "{{\n"
                       "    vec2 texel = place(from, to) / vec2({}.0, {}.0);\n"
                       "    change = (to - from) * textureLod(fading, texel, 0.0).rgb;\n"
                       "    return textureLod(thin, texel, 0.0);\n"
                       "}}\n",
                       size.means, size.differences);
}

glm::vec4 PackedSegmentTexture::pack(const glm::vec4 &thin, const glm::vec4 &fading,
                                     double difference)
{
    glm::vec4 packed(0.0F, 0.0F, 0.0F, 0.5F * thin.w);
    const double range = change_range * std::max(std::abs(difference), least_difference);
    for (int c = 0; c < 3; ++c) {
        const double color = std::clamp(static_cast<double>(thin[c]), 0.0, 1.0);
        const double change = static_cast<double>(fading[c]) * difference / range + 0.5;
        // The sum has 24 bits.
        const double part = std::clamp(std::round(change * 4096.0) / 4096.0, 0.0, 2047.0 / 2048.0);
        packed[c] = static_cast<float>(std::round(color * color_steps) + part);
    }
    return packed;
}

static std::vector<glm::vec4> pack_all(const PreintegratedTable &table)
{
    std::vector<glm::vec4> packed(table.thin().size());
    for (std::size_t i = 0; i < packed.size(); ++i) {
        const auto row = static_cast<int>(i / static_cast<std::size_t>(table.size().means));
        packed[i] = PackedSegmentTexture::pack(table.thin()[i], table.fading()[i],
                                               PreintegratedTable::difference(table.size(), row));
    }
    return packed;
}

PackedSegmentTexture::PackedSegmentTexture(const Gl &gl, const PreintegratedTable &table)
    : segments_(make_texture(gl, GL_TEXTURE_RECTANGLE, table.size(), pack_all(table), GL_NEAREST))
{
}

void PackedSegmentTexture::bind(int unit) const
{
    bind_texture(segments_, GL_TEXTURE_RECTANGLE, unit);
}

std::string PackedSegmentTexture::shader(TableSize size)
{
    return make_place_shader(size) +
           fmt::format("uniform sampler2DRect segments;\n"
                       "vec4 unpack(vec2 place, float range, out vec3 change)\n"
                       "{{\n"
                       "    vec4 texel = texture(segments, place);\n"
                       "    vec3 whole = floor(texel.rgb);\n"
                       "    change = (texel.rgb - whole - 0.5) * range;\n"
                       "    return vec4(whole * {:.9e}, 2.0 * texel.a);\n"
                       "}}\n"
                       "vec4 look_up(float from, float to, out vec3 change)\n"
                       "{{\n"
                       "    float range = {:.9e} * max(abs(to - from), {:.9e});\n"
                       "    return unpack(place(from, to), range, change);\n"
                       "}}\n",
                       1.0 / color_steps, change_range, least_difference);
}

} // namespace kb
