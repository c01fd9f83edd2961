// SPDX-License-Identifier: MIT

#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace kb
{

/// Gives each vertex whose normal is zero or not finite that of the triangles that meet in its
/// place, each weighted by its area. Positions lie in the unit sphere; `normals` has one a vertex.
void complete_normals(std::span<const glm::dvec3> positions, std::span<const std::uint32_t> indices,
                      std::vector<glm::vec3> &normals);

} // namespace kb
