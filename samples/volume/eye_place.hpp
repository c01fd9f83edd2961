// SPDX-License-Identifier: MIT

#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace kb
{

/// Where the eye is among the faces of a grid.
struct EyePlace {
    double clearance;            ///< Distance of the nearest face.
    std::optional<float> scalar; ///< At the eye, if it is inside of the grid.
};

/// A corner of a face is (x, y, z, s), and those behind the interior faces, of which the scalar is
/// larger by `boundary_tag`, are the boundary, counterclockwise seen from outside.
EyePlace find_eye(const glm::dvec3 &eye, std::span<const glm::vec4> corners,
                  std::span<const glm::uvec3> faces, std::size_t interior_count,
                  float boundary_tag);

} // namespace kb
