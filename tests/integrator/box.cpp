// SPDX-License-Identifier: MIT

#include "tests/integrator/box.hpp"

#include <algorithm>
#include <limits>

namespace kb::integrator
{

Interval cross_box(const View &view, glm::dvec2 device, double half_side)
{
    // In the eye's coordinates, for w = 1.
    const glm::dvec3 along((device.x + view.projection[2][0]) / view.projection[0][0],
                           (device.y + view.projection[2][1]) / view.projection[1][1], -1.0);
    const glm::dmat4 inverse = glm::inverse(view.view);
    const glm::dvec3 eye(inverse[3]);
    const glm::dvec3 ray = glm::dmat3(inverse) * along;
    Interval inside{-std::numeric_limits<double>::infinity(),
                    std::numeric_limits<double>::infinity()};
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (-half_side - eye[axis]) / ray[axis];
        const double b = (half_side - eye[axis]) / ray[axis];
        inside.front = std::max(inside.front, std::min(a, b));
        inside.back = std::min(inside.back, std::max(a, b));
    }
    return inside;
}

} // namespace kb::integrator
