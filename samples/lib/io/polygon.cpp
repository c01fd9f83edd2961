// SPDX-License-Identifier: MIT

#include "lib/io/polygon.hpp"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>

namespace kb
{

namespace
{

/// Twice the area of a triangle, positive if it turns left.
double turn(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The corners in the plane in which the polygon is largest, so that it turns left.
std::vector<glm::dvec2> flatten(std::span<const glm::dvec3> points,
                                std::span<const std::uint32_t> corners)
{
    const glm::dvec3 origin = points[corners[0]];
    glm::dvec3 normal(0.0);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        normal += glm::cross(points[corners[i]] - origin, points[corners[i + 1]] - origin);
    const glm::dvec3 size = glm::abs(normal);
    const int dropped = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    int u = (dropped + 1) % 3;
    int v = (dropped + 2) % 3;
    if (normal[dropped] < 0.0)
        std::swap(u, v);

    std::vector<glm::dvec2> flat;
    for (const std::uint32_t corner : corners)
        flat.emplace_back(points[corner][u] - origin[u], points[corner][v] - origin[v]);
    return flat;
}

bool is_convex(std::span<const glm::dvec2> flat)
{
    const std::size_t count = flat.size();
    for (std::size_t i = 0; i < count; ++i) {
        if (turn(flat[i], flat[(i + 1) % count], flat[(i + 2) % count]) < 0.0)
            return false;
    }
    return true;
}

/// Whether the triangle at a corner can be cut off: it turns left and no other corner is in it.
bool is_ear(std::span<const glm::dvec2> flat, std::span<const std::size_t> left, std::size_t i)
{
    const std::size_t count = left.size();
    const glm::dvec2 a = flat[left[(i + count - 1) % count]];
    const glm::dvec2 b = flat[left[i]];
    const glm::dvec2 c = flat[left[(i + 1) % count]];
    if (!(turn(a, b, c) > 0.0))
        return false;
    return std::none_of(left.begin(), left.end(), [&](std::size_t other) {
        const glm::dvec2 p = flat[other];
        return p != a && p != b && p != c && turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 &&
               turn(c, a, p) >= 0.0;
    });
}

} // namespace

void triangulate(std::span<const glm::dvec3> points, std::span<const std::uint32_t> corners,
                 std::vector<std::uint32_t> &triangles)
{
    std::vector<std::size_t> left(corners.size());
    for (std::size_t i = 0; i < left.size(); ++i)
        left[i] = i;
    if (corners.size() > 3) {
        const std::vector<glm::dvec2> flat = flatten(points, corners);
        const bool convex = is_convex(flat);
        // Where no corner is an ear (of what has no area, or cuts itself) the rest becomes a fan.
        for (std::size_t i = 0; !convex && left.size() > 3 && i < left.size();) {
            if (!is_ear(flat, left, i)) {
                ++i;
                continue;
            }
            const std::size_t count = left.size();
            for (const std::size_t corner : {(i + count - 1) % count, i, (i + 1) % count})
                triangles.push_back(corners[left[corner]]);
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
            i = 0;
        }
    }
    for (std::size_t i = 1; i + 1 < left.size(); ++i)
        for (const std::size_t corner : {std::size_t(0), i, i + 1})
            triangles.push_back(corners[left[corner]]);
}

} // namespace kb
