// SPDX-License-Identifier: MIT

#pragma once

#include <glm/vec3.hpp>

#include <span>

namespace kb
{

/// The middle of a box about points, and how far the farthest of them is from it.
struct BoundingSphere {
    glm::vec3 center = glm::vec3(0.0F);
    float radius = 0.0F;
};

BoundingSphere bounding_sphere(std::span<const glm::vec3> points);

/// Moves and scales the points so that their bounding sphere is the unit sphere; the sphere that
/// they had. Points that are all in one place are only moved.
BoundingSphere fit_to_unit_sphere(std::span<glm::vec3> points);

} // namespace kb
