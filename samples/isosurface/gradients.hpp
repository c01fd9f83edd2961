// SPDX-License-Identifier: MIT

#pragma once

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace kb
{

/// How a field changes about each of the points where it is known: the gradient of the linear
/// function that fits best, by least squares, to the points in the 27 cubes about it. There are
/// about as many cubes as points. Where points lie in a plane or in a line, so does the gradient.
/// Takes linear time, however the points are distributed.
std::vector<glm::vec3> estimate_gradients(std::span<const glm::vec3> points,
                                          std::span<const float> values);

} // namespace kb
