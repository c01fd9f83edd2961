// SPDX-License-Identifier: MIT

#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace kb
{

/// Cuts a polygon of three or more corners, convex or not, into triangles of its winding and
/// appends their indices: corners - 2 triangles. Corners are indices of points that exist. A
/// polygon that cuts itself is cut somehow.
void triangulate(std::span<const glm::dvec3> points, std::span<const std::uint32_t> corners,
                 std::vector<std::uint32_t> &triangles);

} // namespace kb
