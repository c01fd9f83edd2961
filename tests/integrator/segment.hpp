// SPDX-License-Identifier: MIT
//
// The light of a piece of a ray along which the scalar changes linearly.

#pragma once

#include "tests/integrator/medium.hpp"

namespace kb::integrator
{

/// What leaves a piece of a ray towards the eye: emission is extinction times color,
///
///     color = integral over s of extinction(s) color(s) exp(-optical depth from the eye to s) ds
struct Light {
    glm::dvec3 color{0.0};
    double optical_depth = 0.0;

    /// Puts what is behind it.
    void append(const Light &behind);

    /// 1 - transmittance.
    double alpha() const;
};

/// In double precision and to its rounding: see segment.cpp for the bound. `length` is at least 0.
Light integrate_segment(const Medium &medium, double scalar_front, double scalar_back,
                        double length);

} // namespace kb::integrator
