// SPDX-License-Identifier: MIT

#pragma once

#include <glm/vec3.hpp>

#include <span>

namespace kb
{

/// Moves and scales the points so that their bounding sphere about the middle of their box is the
/// unit sphere.
void fit_to_unit_sphere(std::span<glm::vec3> points);

} // namespace kb
