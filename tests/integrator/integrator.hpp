// SPDX-License-Identifier: MIT
//
// The picture of a tetrahedral grid in double precision, cell by cell along each pixel's ray: the
// reference for samples/volume, of which it uses nothing.

#pragma once

#include "tests/integrator/medium.hpp"
#include "tests/integrator/ray_segments.hpp"

#include "lib/io/image.hpp"

#include <glm/vec4.hpp>

namespace kb::integrator
{

struct Volume {
    Cells cells;
    View view;
    Medium medium;
    glm::dvec3 background{0.0};
};

/// Colors in front of the background, and 1 - transmittance. The first row is the top one.
using Picture = Image<glm::dvec4>;

/// Through the centers of the pixels, moved by `offset` pixels.
Picture integrate(const Volume &volume, glm::dvec2 offset = {0.0, 0.0});

/// What a drawing may show whose corners are not further from where they belong than a distance in
/// pixels: from the least to the greatest value over the rays through the pixel's center and the
/// corners of a square about it.
struct Bounds {
    Picture low;
    Picture high;
};
Bounds integrate_bounds(const Volume &volume, double distance);

ImageRgbaF to_floats(const Picture &picture);

} // namespace kb::integrator
