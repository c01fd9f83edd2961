// SPDX-License-Identifier: MIT

#include "volume/eye_place.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace kb
{

namespace
{

/// A face relative to a point.
struct Triangle {
    glm::dvec3 a;
    glm::dvec3 b;
    glm::dvec3 c;
};

double squared_distance_of_edge(const glm::dvec3 &a, const glm::dvec3 &b)
{
    const glm::dvec3 edge = b - a;
    const double along = std::clamp(-glm::dot(a, edge) / glm::dot(edge, edge), 0.0, 1.0);
    const glm::dvec3 nearest = a + along * edge;
    return glm::dot(nearest, nearest);
}

double squared_distance(const Triangle &t)
{
    const glm::dvec3 normal = glm::cross(t.b - t.a, t.c - t.a);
    const auto inside = [&normal](const glm::dvec3 &a, const glm::dvec3 &b) {
        return glm::dot(glm::cross(a, b), normal) >= 0.0;
    };
    if (inside(t.a, t.b) && inside(t.b, t.c) && inside(t.c, t.a)) {
        const double height = glm::dot(t.a, normal);
        return height * height / glm::dot(normal, normal);
    }
    return std::min({squared_distance_of_edge(t.a, t.b), squared_distance_of_edge(t.b, t.c),
                     squared_distance_of_edge(t.c, t.a)});
}

/// Where a line through the eye meets a face: the places of corners are those across the line, and
/// along it.
struct Hit {
    double along;
    double scalar;
    bool leaves; ///< Goes through it in the direction from which it is clockwise.
};

std::optional<Hit> hit(const Triangle &t, const glm::dvec3 &scalars)
{
    const auto cross = [](const glm::dvec3 &p, const glm::dvec3 &q) {
        return p.x * q.y - q.x * p.y;
    };
    // Barycentric coordinates; the same for both faces of an edge but for the sign.
    const glm::dvec3 shares(cross(t.b, t.c), cross(t.c, t.a), cross(t.a, t.b));
    const bool leaves = shares.x > 0.0;
    if ((shares.y > 0.0) != leaves || (shares.z > 0.0) != leaves)
        return std::nullopt;
    const double sum = shares.x + shares.y + shares.z;
    if (sum == 0.0)
        return std::nullopt;
    return Hit{glm::dot(shares, {t.a.z, t.b.z, t.c.z}) / sum, glm::dot(shares, scalars) / sum,
               leaves};
}

/// The columns are two directions across a line, and its own. It is no axis and no diagonal of
/// anything: it meets no edge.
glm::dmat3 make_line()
{
    const glm::dvec3 along = glm::normalize(glm::dvec3(0.4123, 0.7241, 0.5527));
    const glm::dvec3 across = glm::normalize(glm::cross(along, glm::dvec3(0.0, 0.0, 1.0)));
    return {across, glm::cross(along, across), along};
}

} // namespace

EyePlace find_eye(const glm::dvec3 &eye, std::span<const glm::vec4> corners,
                  std::span<const glm::uvec3> faces, std::size_t interior_count, float boundary_tag)
{
    const glm::dmat3 to_line = glm::transpose(make_line());
    double nearest = std::numeric_limits<double>::infinity();
    std::optional<Hit> before; // The last hit before the eye, and the first one behind it.
    std::optional<Hit> behind;
    bool inside = false;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const bool boundary = i >= interior_count;
        const auto &a = corners[faces[i].x];
        const auto &b = corners[faces[i].y];
        const auto &c = corners[faces[i].z];
        const auto place = [&](const glm::vec4 &corner) {
            return to_line * (glm::dvec3(corner) - eye);
        };
        const Triangle triangle{place(a), place(b), place(c)};
        nearest = std::min(nearest, squared_distance(triangle));
        const auto found =
            hit(triangle, glm::dvec3(a.w, b.w, c.w) - double(boundary ? boundary_tag : 0.0F));
        if (!found)
            continue;
        if (found->along >= 0.0 && (!behind || found->along < behind->along)) {
            behind = found;
            inside = !boundary || found->leaves;
        } else if (found->along < 0.0 && (!before || found->along > before->along)) {
            before = found;
        }
    }
    EyePlace place{std::sqrt(nearest), std::nullopt};
    // The scalar is linear between the two, which are faces of one cell.
    if (inside && before)
        place.scalar = static_cast<float>(glm::mix(
            before->scalar, behind->scalar, -before->along / (behind->along - before->along)));
    return place;
}

} // namespace kb
