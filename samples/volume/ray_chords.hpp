// SPDX-License-Identifier: MIT

#pragma once

#include "lib/io/tet_grid.hpp"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace kb
{

struct Ray {
    glm::vec3 origin;
    glm::vec3 direction; ///< Of length 1. Rays go on behind their origin, too.
};

/// What a ray has of a cell.
struct RayChord {
    double begin; ///< Along the ray, from its origin.
    double end;
    double front; ///< The scalar where it begins.
    double back;
    std::uint32_t cell;
};

/// The chords of each ray in all cells, from front to back. Looks at each cell for each ray, but
/// only at its bounding sphere if that is missed. `scalars` has one a point.
std::vector<std::vector<RayChord>> find_chords(const TetGrid &grid, std::span<const double> scalars,
                                               std::span<const Ray> rays);

} // namespace kb
