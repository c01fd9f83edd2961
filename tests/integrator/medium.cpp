// SPDX-License-Identifier: MIT

#include "tests/integrator/medium.hpp"

#include <cassert>
#include <cmath>
#include <limits>

namespace kb::integrator
{

static constexpr double infinity = std::numeric_limits<double>::infinity();

Matter Piece::at(double value) const
{
    if (std::isinf(low.value))
        return {high.color, high.extinction};
    if (std::isinf(high.value))
        return {low.color, low.extinction};
    const double t = (value - low.value) / (high.value - low.value);
    const glm::dvec3 color = low.color + t * (high.color - low.color);
    // Infinity less infinity, and 0 times it, would be NaN.
    if (t <= 0.0 || t >= 1.0)
        return {color, t <= 0.0 ? low.extinction : high.extinction};
    if (std::isinf(low.extinction) || std::isinf(high.extinction))
        return {color, infinity};
    return {color, low.extinction + t * (high.extinction - low.extinction)};
}

Medium::Medium(std::vector<ControlPoint> points)
{
    assert(!points.empty());
    ControlPoint before = points.front();
    before.value = -infinity;
    ControlPoint behind = points.back();
    behind.value = infinity;
    for (const ControlPoint &point : points) {
        if (point.value > before.value)
            pieces_.push_back({before, point});
        before = point;
    }
    pieces_.push_back({before, behind});
}

} // namespace kb::integrator
