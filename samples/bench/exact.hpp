// SPDX-License-Identifier: MIT
//
// What the exact image of the first k fragments shows in a pixel, in double precision on the CPU.

#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <limits>
#include <span>

namespace kb::bench
{

/// One fragment as the rasterizer made it.
struct Fragment {
    glm::vec4 color; ///< Not premultiplied.
    float z;         ///< In the window.
};

/// What shines through where transparency ends.
inline constexpr glm::dvec3 background{0.16, 0.18, 0.22};

/// The k of a picture of all fragments.
inline constexpr int all_fragments = std::numeric_limits<int>::max();

/// Nearest first; fragments of equal depth stay in order of arrival.
void sort_by_depth(std::span<Fragment> fragments);

/// The first k of sorted fragments composited front to back over the background. With k = 0 the
/// first is opaque: what a z-buffer shows.
glm::dvec3 composite(std::span<const Fragment> sorted, int k);

} // namespace kb::bench
