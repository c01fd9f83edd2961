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
    glm::vec3 low(std::numeric_limits<float>::max());
    glm::vec3 high(std::numeric_limits<float>::lowest());
    for (const glm::vec3 &p : points) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    BoundingSphere sphere{0.5F * low + 0.5F * high, 0.0F};
    for (const glm::vec3 &p : points)
        sphere.radius = std::max(sphere.radius, glm::distance(p, sphere.center));
    return sphere;
}

BoundingSphere fit_to_unit_sphere(std::span<glm::vec3> points)
{
    const BoundingSphere sphere = bounding_sphere(points);
    const float scale = sphere.radius > 0.0F ? 1.0F / sphere.radius : 1.0F;
    for (glm::vec3 &p : points)
        p = (p - sphere.center) * scale;
    return sphere;
}

} // namespace kb
