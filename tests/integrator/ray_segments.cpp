// SPDX-License-Identifier: MIT
//
// With the ray of a pixel through clip coordinates (X w, Y w, w), a point of clip coordinates
// (x, y, w) is at (u, v) = (x - X w, y - Y w) as seen along the ray, and an edge from a to b passes
// it on the side that the sign of u_a v_b - u_b v_a tells. A face is hit if the ray is on the same
// side of its three edges, and there the edges' values are the barycentric coordinates.
//
// Everything about an edge or a face is computed from its points in the order of their numbers: all
// cells that have it find the same, bit for bit. So rays slip through no gap, and find no face
// twice. A ray that meets an edge is moved aside by as much as nothing, always the same way
// (Edelsbrunner and Muecke, Simulation of Simplicity).

#include "tests/integrator/ray_segments.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace kb::integrator
{

namespace
{

/// A point as seen along a ray.
struct Seen {
    double u;
    double v;
    double w;
    double scalar;
};

/// On which side an edge passes the ray, and how far.
struct Passage {
    double value;
    bool left;
};

Passage pass(const Seen &a, const Seen &b)
{
    const double value = a.u * b.v - b.u * a.v;
    // Moved aside by e and up by e^2 the ray has u - e w in the place of u, and v - e^2 w.
    const double by_e = b.w * a.v - a.w * b.v;
    const double by_e_squared = a.w * b.u - b.w * a.u;
    return {value, (value != 0.0 ? value : by_e != 0.0 ? by_e : by_e_squared) > 0.0};
}

struct Hit {
    double depth;
    double scalar;
};

/// Where the ray meets a face.
std::optional<Hit> hit_face(const Seen &a, const Seen &b, const Seen &c, const Passage &ab,
                            const Passage &bc, const Passage &ac)
{
    if (ab.left != bc.left || ab.left == ac.left)
        return std::nullopt;
    // All of one sign: nothing cancels.
    const double of_a = bc.value;
    const double of_b = -ac.value;
    const double of_c = ab.value;
    const double sum = of_a + of_b + of_c;
    // The ray is in the face's plane, and so is the eye: a ray moved aside does not meet it. (That
    // the signs agree, then, is rounding.)
    if (sum == 0.0)
        return std::nullopt;
    return Hit{(of_a * a.w + of_b * b.w + of_c * c.w) / sum,
               (of_a * a.scalar + of_b * b.scalar + of_c * c.scalar) / sum};
}

} // namespace

glm::dvec2 View::device_coordinates(glm::dvec2 place) const
{
    return {2.0 * place.x / size.width - 1.0, 1.0 - 2.0 * place.y / size.height};
}

double View::length_per_depth(glm::dvec2 device) const
{
    // Of a point of the ray in the coordinates of the eye, which looks along -z, over w.
    const double x = (device.x + projection[2][0]) / projection[0][0];
    const double y = (device.y + projection[2][1]) / projection[1][1];
    return std::sqrt(x * x + y * y + 1.0);
}

double View::pixel_area() const
{
    return 2.0 / (size.width * projection[0][0]) * 2.0 / (size.height * projection[1][1]);
}

View make_view(const OrbitCamera &camera, Size size)
{
    return {glm::dmat4(camera.view()), glm::dmat4(camera.projection(size)), size};
}

RaySegments::RaySegments(const Cells &cells, const View &view, glm::dvec2 offset)
    : cells_(cells), view_(view), offset_(offset)
{
    const glm::dmat4 all = view.projection * view.view;
    clip_.reserve(cells.points.size());
    for (const glm::vec3 &point : cells.points)
        clip_.push_back(all * glm::dvec4(glm::dvec3(point), 1.0));
}

glm::dvec2 RaySegments::device_coordinates(int x, int y) const
{
    return view_.device_coordinates(glm::dvec2(x + 0.5, y + 0.5) + offset_);
}

RaySegments::Box RaySegments::pixels_about(const glm::uvec4 &cell) const
{
    const int width = view_.size.width;
    const int height = view_.size.height;
    glm::dvec2 low(std::numeric_limits<double>::infinity());
    glm::dvec2 high = -low;
    for (int i = 0; i < 4; ++i) {
        const glm::dvec4 &point = clip_[cell[i]];
        if (point.w <= 0.0) // Beside or behind the eye: it can be seen anywhere.
            return {0, width - 1, 0, height - 1};
        const glm::dvec2 place((point.x / point.w + 1.0) * 0.5 * width - offset_.x,
                               (1.0 - point.y / point.w) * 0.5 * height - offset_.y);
        low = glm::min(low, place);
        high = glm::max(high, place);
    }
    // A pixel more on each side, for the rounding.
    const auto clamped = [](double place, int count) {
        return static_cast<int>(std::clamp(std::floor(place), -2.0, count + 1.0));
    };
    return {std::max(clamped(low.x, width) - 1, 0), std::min(clamped(high.x, width), width - 1),
            std::max(clamped(low.y, height) - 1, 0), std::min(clamped(high.y, height), height - 1)};
}

std::vector<std::vector<RaySegment>> RaySegments::find(int first_row, int row_count) const
{
    const auto width = static_cast<std::size_t>(view_.size.width);
    std::vector<std::vector<RaySegment>> segments(width * static_cast<std::size_t>(row_count));
    for (std::size_t number = 0; number < cells_.cells.size(); ++number) {
        glm::uvec4 cell = cells_.cells[number];
        std::sort(&cell.x, &cell.x + 4);
        const Box box = pixels_about(cell);
        for (int y = std::max(box.top, first_row);
             y <= std::min(box.bottom, first_row + row_count - 1); ++y) {
            for (int x = box.left; x <= box.right; ++x) {
                const glm::dvec2 ray = device_coordinates(x, y);
                std::array<Seen, 4> p{};
                for (int i = 0; i < 4; ++i) {
                    const glm::dvec4 &c = clip_[cell[i]];
                    p[std::size_t(i)] = {c.x - ray.x * c.w, c.y - ray.y * c.w, c.w,
                                         static_cast<double>(cells_.scalars[cell[i]])};
                }
                const Passage e01 = pass(p[0], p[1]);
                const Passage e02 = pass(p[0], p[2]);
                const Passage e03 = pass(p[0], p[3]);
                const Passage e12 = pass(p[1], p[2]);
                const Passage e13 = pass(p[1], p[3]);
                const Passage e23 = pass(p[2], p[3]);
                std::array<Hit, 4> hits{};
                std::size_t count = 0;
                for (const auto &hit : {hit_face(p[0], p[1], p[2], e01, e12, e02),
                                        hit_face(p[0], p[1], p[3], e01, e13, e03),
                                        hit_face(p[0], p[2], p[3], e02, e23, e03),
                                        hit_face(p[1], p[2], p[3], e12, e23, e13)})
                    if (hit)
                        hits[count++] = *hit;
                if (count != 2) // Past the cell, or through a corner of it.
                    continue;
                auto [front, back] = hits[0].depth <= hits[1].depth ? std::pair(hits[0], hits[1])
                                                                    : std::pair(hits[1], hits[0]);
                if (back.depth <= view_.near)
                    continue;
                if (front.depth < view_.near) {
                    const double share = (view_.near - front.depth) / (back.depth - front.depth);
                    front = {view_.near, front.scalar + share * (back.scalar - front.scalar)};
                }
                segments[std::size_t(y - first_row) * width + std::size_t(x)].push_back(
                    {front.depth, back.depth, front.scalar, back.scalar,
                     static_cast<std::uint32_t>(number)});
            }
        }
    }
    // Of segments that do not overlap the middles are in order, also where one has no length.
    for (auto &ray : segments)
        std::ranges::sort(ray, {}, [](const RaySegment &s) { return s.front + s.back; });
    return segments;
}

} // namespace kb::integrator
