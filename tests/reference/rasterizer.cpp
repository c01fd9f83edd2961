// SPDX-License-Identifier: MIT
//
// Rounding. Every operation of a driver on floats is off by at most u = 2^-24 of its result. Window
// coordinates are made of clip coordinates by a division, a multiplication and an addition: they
// are off by less than 4 u (|scale| + |translation|). A driver interpolates a quantity a that is
// linear in window coordinates by
//
//     gx = (A1 e2y - A2 e1y) / D,  gy = (A2 e1x - A1 e2x) / D,  D = e1x e2y - e2x e1y
//     a(x, y) = (a0 - (gx x0 + gy y0)) + gx x + gy y
//
// where A1, A2 and e1, e2 are the differences of the corners' values and positions. Let p be the
// error of positions and q that of values. Then
//
//     error of D:   2 p (|e1x| + |e1y| + |e2x| + |e2y|) + 4 u (|e1x e2y| + |e2x e1y|) =: r |D|
//     error of gx:  (2 p (|A1| + |A2|) + 2 q (|e1y| + |e2y|) + 6 u (|A1 e2y| + |A2 e1y|)) / |D|,
//                   and r |gx|; all of that over 1 - r
//     error of a:   (error of gx) |x - x0| + (error of gy) |y - y0| + p (|gx| + |gy|) + q
//                   + 4 u (|a0| + |gx| (|x0| + |x|) + |gy| (|y0| + |y|))
//
// (gx is off by the same amount where a0 is taken to the origin and where it is brought back to the
// sample; hence the difference of positions and not the positions). Which corner a driver starts
// from is its business: the farthest counts. With r above 1/4 there is no bound.
//
// Colors are ratios of two such quantities, color / w and 1 / w.

#include "tests/reference/rasterizer.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace kb::reference
{

namespace
{

constexpr double u = 0x1p-24;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// A vertex in clip coordinates with the error that clipping has given it.
struct ClipVertex {
    std::array<double, 4> position;
    std::array<double, 4> color;
    double error = 0.0; ///< Of each component of the position, and of the color.
};

/// How far inside a plane of the clip volume: x, y and z from below and from above.
double plane_distance(const std::array<double, 4> &p, int plane, bool zero_to_one)
{
    const double coordinate = p[std::size_t(plane / 2)];
    if (plane % 2 == 1)
        return p[3] - coordinate;
    return plane == 4 && zero_to_one ? coordinate : p[3] + coordinate;
}

double largest(const ClipVertex &a, const ClipVertex &b)
{
    double most = 1.0; // No color is above.
    for (std::size_t c = 0; c < 4; ++c)
        most = std::max({most, std::abs(a.position[c]), std::abs(b.position[c])});
    return most;
}

/// The point of an edge on a plane. The distances from the plane are off by what the ends are, and
/// 2 u of the coordinates; their quotient moves the point along the edge.
ClipVertex cut(const ClipVertex &in, const ClipVertex &out, double d_in, double d_out)
{
    const double t = d_in / (d_in - d_out);
    const double size = largest(in, out);
    ClipVertex vertex;
    double length = 0.0;
    for (std::size_t c = 0; c < 4; ++c) {
        vertex.position[c] = in.position[c] + t * (out.position[c] - in.position[c]);
        vertex.color[c] = in.color[c] + t * (out.color[c] - in.color[c]);
        length = std::max({length, std::abs(out.position[c] - in.position[c]),
                           std::abs(out.color[c] - in.color[c])});
    }
    const double from_ends = std::max(in.error, out.error);
    vertex.error =
        from_ends + 4.0 * u * size + length * (2.0 * from_ends + 6.0 * u * size) / (d_in - d_out);
    return vertex;
}

std::vector<ClipVertex> clip(std::vector<ClipVertex> polygon, bool zero_to_one)
{
    for (int plane = 0; plane < 6; ++plane) {
        std::vector<ClipVertex> kept;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const ClipVertex &here = polygon[i];
            const ClipVertex &next = polygon[(i + 1) % polygon.size()];
            const double d_here = plane_distance(here.position, plane, zero_to_one);
            const double d_next = plane_distance(next.position, plane, zero_to_one);
            if (d_here >= 0.0)
                kept.push_back(here);
            if (d_here >= 0.0 && d_next < 0.0)
                kept.push_back(cut(here, next, d_here, d_next));
            else if (d_here < 0.0 && d_next >= 0.0)
                kept.push_back(cut(next, here, d_next, d_here));
        }
        polygon = std::move(kept);
    }
    return polygon;
}

Corner to_window(const Scene &scene, const ClipVertex &vertex)
{
    const auto &[x, y, z, w] = vertex.position;
    const double half_width = scene.viewport.width / 2.0;
    const double half_height = scene.viewport.height / 2.0;
    const auto [near, far] = scene.depth_range;
    const double z_scale = scene.zero_to_one ? far - near : (far - near) / 2.0;
    const double z_shift = scene.zero_to_one ? near : (far + near) / 2.0;

    Corner corner;
    corner.at = {x / w * half_width + half_width + scene.viewport.x,
                 y / w * half_height + half_height + scene.viewport.y};
    corner.z = z / w * z_scale + z_shift;
    corner.inverse_w = 1.0 / w;
    corner.color = vertex.color;
    // x / w of a vertex whose x and w are off by e is off by at most e (1 + |x / w|) / w; inside of
    // the clip volume that is 2 e / w. A w that may be zero leaves nothing.
    const double from_clip =
        vertex.error < w / 4.0 ? 2.0 * vertex.error / (w - vertex.error) : infinite;
    const double window = std::max(half_width + std::abs(half_width + scene.viewport.x),
                                   half_height + std::abs(half_height + scene.viewport.y));
    corner.position_error = std::max(half_width, half_height) * from_clip + 4.0 * u * window;
    corner.z_error = std::abs(z_scale) * from_clip + 4.0 * u * (std::abs(z_scale) + z_shift);
    corner.relative_error = from_clip + 4.0 * u;
    return corner;
}

double cross(Point a, Point b)
{
    return a.x * b.y - a.y * b.x;
}

Point operator-(Point a, Point b)
{
    return {a.x - b.x, a.y - b.y};
}

double length(Point a)
{
    return std::hypot(a.x, a.y);
}

double signed_area(const std::vector<Corner> &corners)
{
    double area = 0.0;
    for (std::size_t i = 2; i < corners.size(); ++i)
        area += cross(corners[i - 1].at - corners[0].at, corners[i].at - corners[0].at);
    return area;
}

double distance_to_segment(Point p, Point a, Point b)
{
    const Point ab = b - a;
    const Point ap = p - a;
    const double square = ab.x * ab.x + ab.y * ab.y;
    const double t =
        square > 0.0 ? std::clamp((ap.x * ab.x + ap.y * ab.y) / square, 0.0, 1.0) : 0.0;
    return std::hypot(ap.x - t * ab.x, ap.y - t * ab.y);
}

/// A quantity that is linear in window coordinates, by its values at three corners. The formulas
/// are those at the head of this file.
Estimate interpolate(std::span<const Point, 3> p, std::span<const double, 3> a,
                     double position_error, double value_error, Point at)
{
    const Point e1 = p[1] - p[0];
    const Point e2 = p[2] - p[0];
    const double a1 = a[1] - a[0];
    const double a2 = a[2] - a[0];
    const double d = cross(e1, e2);
    const double sum = std::abs(e1.x * e2.y) + std::abs(e2.x * e1.y);
    const double d_error =
        2.0 * position_error * (std::abs(e1.x) + std::abs(e1.y) + std::abs(e2.x) + std::abs(e2.y)) +
        4.0 * u * sum;
    if (!(d_error < std::abs(d) / 4.0))
        return {};
    const double r = d_error / std::abs(d);
    const double gx = (a1 * e2.y - a2 * e1.y) / d;
    const double gy = (a2 * e1.x - a1 * e2.x) / d;

    const auto slope_error = [&](double slope, double w1, double w2) {
        const double sums = 2.0 * position_error * (std::abs(a1) + std::abs(a2)) +
                            2.0 * value_error * (std::abs(w1) + std::abs(w2)) +
                            6.0 * u * (std::abs(a1 * w2) + std::abs(a2 * w1));
        return (sums / std::abs(d) + r * std::abs(slope)) / (1.0 - r);
    };
    const double gx_error = slope_error(gx, e1.y, e2.y);
    const double gy_error = slope_error(gy, e1.x, e2.x);

    Estimate estimate{a[0] + gx * (at.x - p[0].x) + gy * (at.y - p[0].y), 0.0};
    for (std::size_t i = 0; i < 3; ++i) {
        const double error =
            gx_error * std::abs(at.x - p[i].x) + gy_error * std::abs(at.y - p[i].y) +
            position_error * (std::abs(gx) + std::abs(gy)) + value_error +
            4.0 * u *
                (std::abs(a[i]) + std::abs(gx) * (std::abs(p[i].x) + std::abs(at.x)) +
                 std::abs(gy) * (std::abs(p[i].y) + std::abs(at.y)));
        estimate.tolerance = std::max(estimate.tolerance, error);
    }
    return estimate;
}

struct CornerTriple {
    std::array<Point, 3> points;
    std::array<const Corner *, 3> corners;
    double position_error = 0.0;
    double z_error = 0.0;
    double relative_error = 0.0;

    CornerTriple(const Corner &a, const Corner &b, const Corner &c)
        : points{a.at, b.at, c.at}, corners{&a, &b, &c}
    {
        for (const Corner *corner : corners) {
            position_error = std::max(position_error, corner->position_error);
            z_error = std::max(z_error, corner->z_error);
            relative_error = std::max(relative_error, corner->relative_error);
        }
    }

    Estimate depth(Point at) const
    {
        return interpolate(points, std::array{corners[0]->z, corners[1]->z, corners[2]->z},
                           position_error, z_error, at);
    }

    Estimate color(Point at, std::size_t channel) const
    {
        std::array<double, 3> over_w{};
        std::array<double, 3> inverse_w{};
        double most = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
            inverse_w[i] = corners[i]->inverse_w;
            over_w[i] = corners[i]->color[channel] * inverse_w[i];
            most = std::max(most, inverse_w[i]);
        }
        const double error = most * relative_error;
        const Estimate top = interpolate(points, over_w, position_error, error, at);
        const Estimate bottom = interpolate(points, inverse_w, position_error, error, at);
        if (!(bottom.value > 2.0 * bottom.tolerance))
            return {};
        const double value = top.value / bottom.value;
        return {value, (top.tolerance + std::abs(value) * bottom.tolerance) /
                               (bottom.value - bottom.tolerance) +
                           4.0 * u * std::abs(value)};
    }
};

Estimate looser(const Estimate &a, const Estimate &b)
{
    return b.tolerance > a.tolerance ? b : a;
}

} // namespace

TriangleRaster::TriangleRaster(const Scene &scene, Cull cull, const Triangle &triangle,
                               const RasterRules &rules)
    : flat_(scene.flat), depth_bounds_{std::min(scene.depth_range[0], scene.depth_range[1]),
                                       std::max(scene.depth_range[0], scene.depth_range[1])}
{
    std::vector<ClipVertex> polygon;
    for (const Vertex &vertex : triangle.vertices) {
        ClipVertex &last = polygon.emplace_back();
        std::copy(vertex.position.begin(), vertex.position.end(), last.position.begin());
        std::copy(vertex.color.begin(), vertex.color.end(), last.color.begin());
        for (int plane = 0; plane < 6; ++plane)
            clipped_ |= plane_distance(last.position, plane, scene.zero_to_one) < 0.0;
        // 0 0 0 0 is inside of all planes and nowhere.
        clipped_ |= last.position[3] <= 0.0;
    }
    flat_color_ = polygon.back().color;
    if (clipped_)
        polygon = clip(std::move(polygon), scene.zero_to_one);
    for (const ClipVertex &vertex : polygon)
        corners_.push_back(to_window(scene, vertex));
    if (corners_.size() < 3) {
        empty_ = true;
        return;
    }
    make_edges(rules, cull);
}

void TriangleRaster::make_edges(const RasterRules &rules, Cull cull)
{
    double error = 0.0;
    double size = 1.0;
    for (const Corner &corner : corners_) {
        error = std::max(error, corner.position_error);
        size = std::max({size, std::abs(corner.at.x), std::abs(corner.at.y)});
    }
    if (!std::isfinite(error)) {
        band_ = infinite;
        return;
    }

    // A coordinate too near to the middle of two steps may be snapped to either.
    const auto snap = [](double x) { return std::llround(std::floor(256.0 * x + 0.5)); };
    exact_ = rules.snaps && !clipped_;
    for (const Corner &corner : corners_) {
        for (const double x : {corner.at.x, corner.at.y})
            exact_ = exact_ && snap(x - error) == snap(x + error);
    }

    if (exact_) {
        std::array<std::array<long long, 2>, 3> p{};
        for (std::size_t i = 0; i < 3; ++i)
            p[i] = {snap(corners_[i].at.x), snap(corners_[i].at.y)};
        const long long area =
            (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]);
        empty_ = area == 0 || cull == (area > 0 ? Cull::front : Cull::back);
        if (area < 0)
            std::swap(p[1], p[2]);
        for (std::size_t i = 0; i < 3; ++i) {
            const auto &from = p[i];
            const auto &to = p[(i + 1) % 3];
            Edge &edge = edges_[i];
            edge.a = from[1] - to[1];
            edge.b = to[0] - from[0];
            edge.c = -(edge.a * from[0] + edge.b * from[1]);
            // What is inside of a left edge has larger x, of a bottom edge larger y.
            if (edge.a > 0 || (edge.a == 0 && edge.b > 0))
                edge.c += 1;
        }
        return;
    }

    walks_ = !rules.snaps;
    // Snapping moves a corner by up to 1/512 in x and y. Walking an edge in floats adds less than
    // 16 u of the largest coordinate.
    band_ = std::sqrt(2.0) * (error + (rules.snaps ? 1.0 / 512.0 : 0.0)) + 16.0 * u * size;
    const double area = signed_area(corners_);
    double around = 0.0;
    for (std::size_t i = 0; i < corners_.size(); ++i)
        around += length(corners_[(i + 1) % corners_.size()].at - corners_[i].at);
    // The area of what moved corners enclose differs by less than this.
    if (std::abs(area) > 2.0 * band_ * (around + 4.0 * band_))
        empty_ = cull == (area > 0.0 ? Cull::front : Cull::back);
    else if (cull != Cull::none)
        band_ = infinite; // It may show either face.
    if (area < 0.0)
        std::reverse(corners_.begin(), corners_.end());
}

/// The distance from the outline of the clipped polygon: negative outside.
double TriangleRaster::distance(Point sample) const
{
    double nearest = infinite;
    bool inside = true;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
        const Point from = corners_[i].at;
        const Point to = corners_[(i + 1) % corners_.size()].at;
        nearest = std::min(nearest, distance_to_segment(sample, from, to));
        inside = inside && cross(to - from, sample - from) >= 0.0;
    }
    return inside ? nearest : -nearest;
}

bool TriangleRaster::passes_corner(double y) const
{
    return std::any_of(corners_.begin(), corners_.end(),
                       [&](const Corner &corner) { return std::abs(corner.at.y - y) <= band_; });
}

Coverage TriangleRaster::coverage(int px, int py, SamplePosition sample) const
{
    if (empty_)
        return Coverage::no;
    if (exact_) {
        const long long x = 256LL * px + sample.x;
        const long long y = 256LL * py + sample.y;
        const bool inside = std::all_of(edges_.begin(), edges_.end(), [=](const Edge &edge) {
            return edge.a * x + edge.b * y + edge.c > 0;
        });
        return inside ? Coverage::yes : Coverage::no;
    }
    // If the corners of a convex polygon move by no more than the band, its outline does, too.
    const Point at{px + sample.x / 256.0, py + sample.y / 256.0};
    const double d = distance(at);
    if (d > band_)
        return walks_ && passes_corner(at.y) ? Coverage::undecided : Coverage::yes;
    return d < -band_ ? Coverage::no : Coverage::undecided;
}

template <class Use>
void TriangleRaster::for_triangles_at(Point sample, Use use) const
{
    const std::size_t n = corners_.size();
    if (n == 3)
        return use(CornerTriple(corners_[0], corners_[1], corners_[2]));
    // The clipper makes a fan of the polygon, from a corner that is its business.
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 1; j < n; ++j) {
            for (std::size_t k = j + 1; k < n; ++k) {
                const Point a = corners_[i].at;
                const Point b = corners_[j].at;
                const Point c = corners_[k].at;
                const double outside =
                    std::min({cross(b - a, sample - a) / std::max(length(b - a), 1e-9),
                              cross(c - b, sample - b) / std::max(length(c - b), 1e-9),
                              cross(a - c, sample - c) / std::max(length(a - c), 1e-9)});
                if (outside >= -2.0 * band_)
                    use(CornerTriple(corners_[i], corners_[j], corners_[k]));
            }
        }
    }
}

Estimate TriangleRaster::depth(int px, int py, SamplePosition sample) const
{
    const Point at{px + sample.x / 256.0, py + sample.y / 256.0};
    Estimate estimate{0.0, 0.0};
    bool found = false;
    for_triangles_at(at, [&](const CornerTriple &triple) {
        const Estimate here = triple.depth(at);
        estimate = found ? looser(estimate, here) : here;
        found = true;
    });
    if (!found)
        return {};
    estimate.value = std::clamp(estimate.value, depth_bounds_[0], depth_bounds_[1]);
    return estimate;
}

Estimate TriangleRaster::color(int px, int py, std::size_t channel) const
{
    if (flat_)
        return {flat_color_[channel], 0.0};
    // Where the driver's plane comes from is decided by a sample, which may be elsewhere in the
    // pixel.
    const Point center{px + 0.5, py + 0.5};
    Estimate estimate{0.0, 0.0};
    bool found = false;
    const auto take = [&](const CornerTriple &triple) {
        const Estimate here = triple.color(center, channel);
        estimate = found ? looser(estimate, here) : here;
        found = true;
    };
    if (!clipped_)
        take(CornerTriple(corners_[0], corners_[1], corners_[2]));
    else
        for (std::size_t i = 0; i < corners_.size(); ++i)
            for (std::size_t j = i + 1; j < corners_.size(); ++j)
                for (std::size_t k = j + 1; k < corners_.size(); ++k)
                    take(CornerTriple(corners_[i], corners_[j], corners_[k]));
    return found ? estimate : Estimate{};
}

} // namespace kb::reference
