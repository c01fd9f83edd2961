// SPDX-License-Identifier: MIT
//
// The table of the integrals over segments as textures, and how programs look up in them.

#pragma once

#include "lib/gl/gl_objects.hpp"
#include "volume/preintegration.hpp"

#include <string>

namespace kb
{

/// Two textures, 2D, RGBA32F, between the texels of which lookups interpolate.
class SegmentTextures
{
public:
    SegmentTextures(const Gl &gl, const PreintegratedTable &table);

    /// Binds `thin` to a texture unit and `fading` to the next.
    void bind(int unit) const;

    /// GLSL 3.30: declares the uniforms sampler2D thin and fading, and
    ///
    ///     vec4 look_up(float from, float to, out vec3 change)
    ///
    /// which is thin color and extinction of the segment with these scalars at its ends, and
    /// thick - thin color.
    static std::string shader(TableSize size);

private:
    Texture thin_;
    Texture fading_;
};

/// One texture, a rectangle, RGBA32F: a lookup is one nearest texel, which takes less than a third
/// of the time. In each of the first three components is a whole number and a part of 1:
///
///     thin color = whole / color_steps
///     thick - thin color = (part - 1/2) change_range max(|difference|, least_difference)
///
/// and in the fourth half of the extinction. A part is a multiple of 1/4096 (1/2048 where color is
/// 1): colors are within 1/8192, and the change, which hardly matters but in opaque segments, is
/// within 1/256 of the difference of the scalars.
class PackedSegmentTexture
{
public:
    static constexpr double color_steps = 4096.0;
    static constexpr double least_difference = 1.0 / 16.0;
    static constexpr double change_range = 2.0 / least_difference;

    PackedSegmentTexture(const Gl &gl, const PreintegratedTable &table);

    void bind(int unit) const;

    /// GLSL 3.30: the same, of the uniform sampler2DRect segments, and
    ///
    ///     vec4 unpack(vec2 place, float range, out vec3 change)
    ///
    /// for the texel at a place, where range is change_range max(|difference|, least_difference).
    static std::string shader(TableSize size);

    /// A texel, of what the table holds for a difference of the scalars.
    static glm::vec4 pack(const glm::vec4 &thin, const glm::vec4 &fading, double difference);

private:
    Texture segments_;
};

} // namespace kb
