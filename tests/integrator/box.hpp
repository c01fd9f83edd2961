// SPDX-License-Identifier: MIT

#pragma once

#include "tests/integrator/ray_segments.hpp"

namespace kb::integrator
{

/// Where a ray is inside, in w.
struct Interval {
    double front;
    double back;

    /// 0 if the ray passes by.
    double depth() const { return back > front ? back - front : 0.0; }
};

/// The ray through a place of the picture and a box about the origin: by the planes of its sides,
/// which is another way than that of RaySegments.
Interval cross_box(const View &view, glm::dvec2 device, double half_side);

} // namespace kb::integrator
