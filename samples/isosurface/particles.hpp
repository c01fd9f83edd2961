// SPDX-License-Identifier: MIT

#pragma once

#include "lib/io/tet_grid.hpp"

#include <glm/vec3.hpp>

#include <cstddef>
#include <span>

namespace kb
{

/// About `count` particles that fill the unit ball, each somewhere in a cube of a lattice, with the
/// field "density" of a few drops that run into one another. The same on every machine.
PointSet make_particles(std::size_t count);

/// The mean distance of neighbours if the points fill their box evenly, or the plane or line that
/// the box is.
float mean_spacing(std::span<const glm::vec3> points);

} // namespace kb
