// SPDX-License-Identifier: MIT

#include "unit_sphere.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>

namespace kb
{

BoundingSphere bounding_sphere(std::span<const glm::vec3> points)
{
    if (points.empty())
        return {};
    constexpr double largest = std::numeric_limits<float>::max();
    glm::vec3 low(std::numeric_limits<float>::max());
    glm::vec3 high(std::numeric_limits<float>::lowest());
    for (const glm::vec3 &p : points) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    BoundingSphere sphere{0.5F * low + 0.5F * high, 0.0F};
    // In doubles: squares of large and of small floats are no floats.
    double radius = 0.0;
    for (const glm::vec3 &p : points)
        radius = std::max(radius, glm::distance(glm::dvec3(p), glm::dvec3(sphere.center)));
    sphere.radius = static_cast<float>(std::min(radius, largest));
    return sphere;
}

BoundingSphere fit_to_unit_sphere(std::span<glm::vec3> points)
{
    const BoundingSphere sphere = bounding_sphere(points);
    const double scale = sphere.radius > 0.0F ? 1.0 / sphere.radius : 1.0;
    for (glm::vec3 &p : points)
        p = glm::vec3((glm::dvec3(p) - glm::dvec3(sphere.center)) * scale);
    return sphere;
}

} // namespace kb
