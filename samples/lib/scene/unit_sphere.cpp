// SPDX-License-Identifier: MIT

#include "lib/scene/unit_sphere.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kb
{

/// A power of two of the size of the points where squares of their coordinates would be no floats,
/// else 1.
static float unit_of(const glm::vec3 &half_size)
{
    const float largest = std::max({half_size.x, half_size.y, half_size.z});
    if (largest == 0.0F || (largest > 0x1p-50F && largest < 0x1p50F))
        return 1.0F;
    return std::ldexp(1.0F, std::ilogb(largest));
}

/// Also the unit in which its radius was computed.
static BoundingSphere find_sphere(std::span<const glm::vec3> points, float &unit)
{
    glm::vec3 low(std::numeric_limits<float>::max());
    glm::vec3 high(std::numeric_limits<float>::lowest());
    for (const glm::vec3 &p : points) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    BoundingSphere sphere{0.5F * low + 0.5F * high, 0.0F};
    unit = unit_of(0.5F * high - 0.5F * low);
    for (const glm::vec3 &p : points)
        sphere.radius = std::max(sphere.radius, glm::distance(p / unit, sphere.center / unit));
    sphere.radius = std::min(sphere.radius * unit, std::numeric_limits<float>::max());
    return sphere;
}

BoundingSphere bounding_sphere(std::span<const glm::vec3> points)
{
    float unit = 1.0F;
    return points.empty() ? BoundingSphere{} : find_sphere(points, unit);
}

BoundingSphere fit_to_unit_sphere(std::span<glm::vec3> points)
{
    if (points.empty())
        return {};
    float unit = 1.0F;
    const BoundingSphere sphere = find_sphere(points, unit);
    const float radius = sphere.radius / unit;
    const float scale = radius > 0.0F ? 1.0F / radius : 1.0F;
    for (glm::vec3 &p : points)
        p = (p - sphere.center) / unit * scale;
    return sphere;
}

} // namespace kb
