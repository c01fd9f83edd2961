// SPDX-License-Identifier: MIT
//
// The rays through the centers of the pixels of IsosurfaceTest's pictures, in double precision.

#pragma once

#include "tests/isosurface/isosurface_test.hpp"

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

namespace kb::test
{

struct Ray {
    glm::dvec3 eye;
    glm::dvec3 direction; ///< Of length 1.

    glm::dvec3 at(double distance) const { return eye + distance * direction; }
    double distance_from_origin() const { return glm::length(glm::cross(direction, eye)); }
};

/// In the coordinates of the eye, at depth 1.
inline glm::dvec3 slope_of(const OrbitCamera &camera, int x, int y)
{
    const glm::dmat4 projection(camera.projection(size));
    return {(2.0 * (x + 0.5) / size.width - 1.0) / projection[0][0],
            (1.0 - 2.0 * (y + 0.5) / size.height) / projection[1][1], -1.0};
}

inline double length_per_depth(const OrbitCamera &camera, int x, int y)
{
    return glm::length(slope_of(camera, x, y));
}

inline Ray ray_through(const OrbitCamera &camera, int x, int y)
{
    const glm::dmat4 to_scene = glm::inverse(glm::dmat4(camera.view()));
    return {glm::dvec3(to_scene[3]), glm::normalize(glm::dmat3(to_scene) * slope_of(camera, x, y))};
}

} // namespace kb::test
