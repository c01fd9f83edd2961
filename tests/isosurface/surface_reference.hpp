// SPDX-License-Identifier: MIT
//
// The nearest surface of each pixel, from the cells that its ray goes through, in double precision.

#pragma once

#include "tests/integrator/ray_segments.hpp"

#include <optional>
#include <span>
#include <vector>

namespace kb::test
{

struct SurfacePoint {
    double distance; ///< From the eye.
    double value;
};

/// Of all iso-values, the point of the ray nearest to the eye at which the scalar has one of them.
std::optional<SurfacePoint> find_nearest(std::span<const integrator::RaySegment> segments,
                                         double length_per_depth, std::span<const double> values);

/// The same for each pixel, row by row from the top one, of rays that are moved by `offset` pixels.
std::vector<std::optional<SurfacePoint>> find_surfaces(const integrator::Cells &cells,
                                                       const integrator::View &view,
                                                       std::span<const double> values,
                                                       glm::dvec2 offset = {0.0, 0.0});

} // namespace kb::test
