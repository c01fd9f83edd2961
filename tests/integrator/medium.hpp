// SPDX-License-Identifier: MIT
//
// What a scalar looks like: color and extinction, piecewise linear between control points.

#pragma once

#include <glm/vec3.hpp>

#include <vector>

namespace kb::integrator
{

struct ControlPoint {
    double value;
    glm::dvec3 color;
    double extinction; ///< Per unit length, at least 0; it may be infinite.
};

/// Color and extinction at one place.
struct Matter {
    glm::dvec3 color;
    double extinction;
};

/// One of the intervals that the control points cut the numbers into. Before the first point and
/// behind the last one matter is that of the point.
struct Piece {
    ControlPoint low;
    ControlPoint high;

    Matter at(double value) const;
};

class Medium
{
public:
    /// The points in the order of their values; equal values are a step. At least one point.
    explicit Medium(std::vector<ControlPoint> points);

    /// In the order of their values: without gaps from minus infinity to infinity.
    const std::vector<Piece> &pieces() const { return pieces_; }

private:
    std::vector<Piece> pieces_;
};

} // namespace kb::integrator
