// SPDX-License-Identifier: MIT

#pragma once

#include "lib/io/tet_grid.hpp"
#include "lib/scene/camera.hpp"
#include "tests/integrator/box.hpp"

namespace kb::hard
{

/// What one pixel of a box is to show.
struct Chord {
    double least; ///< Lengths: of rays moved by as much as corners are snapped.
    double greatest;
    double middle;
    double volume_factor; ///< From a length to the pixel's part of the volume.
};

/// Of a grid that fills a box about the origin with equal sides along the axes.
class BoxChords
{
public:
    BoxChords(const TetGrid &box, const OrbitCamera &camera, Size size);

    double volume() const;
    Chord at(int x, int y) const;

private:
    integrator::Interval cross(glm::dvec2 place) const;
    double per_depth(glm::dvec2 place) const;
    double length(glm::dvec2 place) const { return cross(place).depth() * per_depth(place); }

    integrator::View view_;
    double eye_distance_;
    double half_side_ = 0.0;
};

} // namespace kb::hard
