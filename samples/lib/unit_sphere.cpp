// SPDX-License-Identifier: MIT

#include "unit_sphere.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>

namespace kb
{

void fit_to_unit_sphere(std::span<glm::vec3> points)
{
    if (points.empty())
        return;
    glm::vec3 low(std::numeric_limits<float>::max());
    glm::vec3 high(std::numeric_limits<float>::lowest());
    for (const auto &p : points) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::vec3 center = 0.5F * low + 0.5F * high;
    float radius = 0.0F;
    for (const auto &p : points)
        radius = std::max(radius, glm::distance(p, center));
    const float scale = radius > 0.0F ? 1.0F / radius : 1.0F;
    for (auto &p : points)
        p = (p - center) * scale;
}

} // namespace kb
