// SPDX-License-Identifier: MIT
//
// Cells along rays, and pictures, against what is known of a box.

#include "integrator.hpp"
#include "tet_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace
{

using namespace kb;
using namespace kb::integrator;

/// Cells, and a scalar that is linear in space: x. Coordinates are floats, so it is exact.
struct Grid {
    TetGrid grid;
    std::vector<float> x;

    explicit Grid(TetGrid made) : grid(std::move(made))
    {
        for (const glm::vec3 &point : grid.points)
            x.push_back(point.x);
    }
    Cells cells() const { return {grid.points, grid.cells, x}; }
};

Grid make_box(CubeSplit split, unsigned cubes = 6)
{
    return Grid(make_tet_grid({.cubes = cubes, .split = split, .sliver_share = 0.2F}));
}

constexpr CubeSplit splits[] = {CubeSplit::five, CubeSplit::six, CubeSplit::twenty_four};

/// Where a ray is in a box with center 0: by the planes of its sides, from the eye's coordinates.
struct Interval {
    double front;
    double back;

    double length() const { return std::max(0.0, back - front); }
};
Interval cross_box(const View &view, glm::dvec2 device, double half_side)
{
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

/// Coordinates are up to 4 and some tens of operations with doubles lead to a depth, whose rounding
/// a grazing ray magnifies: rays that enter a side at less than 1e-3 are not compared.
constexpr double rounding = 1e-11;

const OrbitCamera oblique{.azimuth = 31.0F, .elevation = 22.0F, .distance = 4.5F};
constexpr Size picture_size{96, 72};

TEST(IntegratorRays, SegmentsOfABoxAreItsChordWithoutGap)
{
    const View view = make_view(oblique, picture_size);
    for (const CubeSplit split : splits) {
        const Grid box = make_box(split);
        const RaySegments rays(box.cells(), view);
        const auto all = rays.find(0, picture_size.height);
        std::size_t inside = 0;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const int x = static_cast<int>(i) % picture_size.width;
            const int y = static_cast<int>(i) / picture_size.width;
            const Interval chord = cross_box(view, rays.device_coordinates(x, y), 1.0);
            const auto &segments = all[i];
            if (segments.empty()) {
                EXPECT_LT(chord.length(), rounding) << x << ", " << y;
                continue;
            }
            ++inside;
            EXPECT_NEAR(segments.front().front, chord.front, rounding) << x << ", " << y;
            EXPECT_NEAR(segments.back().back, chord.back, rounding) << x << ", " << y;
            double sum = 0.0;
            for (std::size_t s = 0; s < segments.size(); ++s) {
                if (s > 0) {
                    EXPECT_EQ(segments[s].front, segments[s - 1].back);
                    EXPECT_EQ(segments[s].scalar_front, segments[s - 1].scalar_back);
                }
                EXPECT_LE(segments[s].front, segments[s].back);
                sum += segments[s].back - segments[s].front;
            }
            EXPECT_NEAR(sum, chord.length(), rounding);
        }
        EXPECT_GT(inside, all.size() / 4);
    }
}

TEST(IntegratorRays, ScalarsAreThoseOfThePlace)
{
    const View view = make_view(oblique, picture_size);
    const glm::dmat4 inverse = glm::inverse(view.projection * view.view);
    const Grid box = make_box(CubeSplit::five);
    const RaySegments rays(box.cells(), view);
    const auto all = rays.find(0, picture_size.height);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const glm::dvec2 device = rays.device_coordinates(static_cast<int>(i) % picture_size.width,
                                                          static_cast<int>(i) / picture_size.width);
        for (const RaySegment &segment : all[i]) {
            // The place on the ray with this w: z of clip coordinates follows from w.
            const double w = segment.back;
            const double z = view.projection[2][2] * -w + view.projection[3][2];
            const double x = (inverse * glm::dvec4(device * w, z, w)).x;
            EXPECT_NEAR(segment.scalar_back, x, rounding);
        }
    }
}

TEST(IntegratorRays, SegmentsFillTheVolume)
{
    // The integral of w^2 over a pixel's part of space, area at w = 1 times (b^3 - a^3) / 3, is its
    // volume. Rays through the centers of squares integrate what is linear across a square exactly,
    // so errors come from curvature (h^2 of all) and from the squares that one of the box's twelve
    // edges crosses. There the slope g' changes by no more than 2 w^2 |dw/dx|, 2 * 40 * 3 here with
    // the sides of this view, and a change D of slope in a square of side h gives at most D h^3 / 8
    // of volume. Twelve edges of no more than N squares each with h = 2 tan(22.5 deg) / N: 12 * N *
    // 240 * (.83 / N)^3 / 8 = 206 / N^2; of the other signs as many, so less in truth.
    for (const int n : {64, 256}) {
        const View view = make_view(oblique, {n, n});
        const Grid box = make_box(CubeSplit::twenty_four, 3);
        double volume = 0.0;
        for (const auto &ray : RaySegments(box.cells(), view).find(0, n))
            for (const RaySegment &segment : ray)
                volume += view.pixel_area() / 3.0 *
                          (std::pow(segment.back, 3) - std::pow(segment.front, 3));
        EXPECT_NEAR(volume, 8.0, 206.0 / n / n) << n;
    }
}

TEST(IntegratorRays, RaysThroughPointsAndEdges)
{
    // Seen along an axis, with a ray through the middle: rays lie in faces, meet edges and corners.
    const OrbitCamera straight{.distance = 4.0F};
    const Size odd{65, 65};
    const View view = make_view(straight, odd);
    for (const CubeSplit split : splits) {
        const Grid box(
            make_tet_grid({.cubes = 4, .split = split, .jitter = 0.0F, .sliver_share = 0.0F}));
        const RaySegments rays(box.cells(), view);
        const auto all = rays.find(0, odd.height);
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Interval chord =
                cross_box(view,
                          rays.device_coordinates(static_cast<int>(i) % odd.width,
                                                  static_cast<int>(i) / odd.width),
                          1.0);
            double sum = 0.0;
            for (const RaySegment &segment : all[i])
                sum += segment.back - segment.front;
            EXPECT_NEAR(sum, chord.length(), rounding) << i % 65 << ", " << i / 65;
        }
    }
}

TEST(IntegratorRays, HolesAreLeftOut)
{
    Grid box(make_tet_grid({.cubes = 4, .jitter = 0.0F, .sliver_share = 0.0F}));
    std::erase_if(box.grid.cells, [&](const glm::uvec4 &cell) {
        glm::vec3 middle(0.0F);
        for (int i = 0; i < 4; ++i)
            middle += 0.25F * box.grid.points[cell[i]];
        return std::max({std::abs(middle.x), std::abs(middle.y), std::abs(middle.z)}) < 0.5F;
    });
    const View view = make_view(oblique, picture_size);
    const RaySegments rays(box.cells(), view);
    const Medium medium({{0.0, glm::dvec3(1.0), 1.0}});
    const Picture picture = integrate({box.cells(), view, medium});
    std::size_t through_hole = 0;
    for (int y = 0; y < picture_size.height; ++y)
        for (int x = 0; x < picture_size.width; ++x) {
            const glm::dvec2 device = rays.device_coordinates(x, y);
            const double hole = cross_box(view, device, 0.5).length();
            const double chord = cross_box(view, device, 1.0).length() - hole;
            through_hole += hole > 0.1 ? 1 : 0;
            EXPECT_NEAR(picture.at(x, y).w, -std::expm1(-chord * view.length_per_depth(device)),
                        rounding);
            EXPECT_NEAR(picture.at(x, y).r, picture.at(x, y).w, rounding);
        }
    EXPECT_GT(through_hole, 100U);
}

TEST(IntegratorRays, BeginAtTheNearPlane)
{
    // The eye is in the box.
    const OrbitCamera within{.azimuth = 31.0F, .elevation = 22.0F, .distance = 0.5F};
    View view = make_view(within, picture_size);
    const Grid box = make_box(CubeSplit::six);
    for (const double near : {0.0, 0.3}) {
        view.near = near;
        const RaySegments rays(box.cells(), view);
        const auto all = rays.find(0, picture_size.height);
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Interval chord =
                cross_box(view,
                          rays.device_coordinates(static_cast<int>(i) % picture_size.width,
                                                  static_cast<int>(i) / picture_size.width),
                          1.0);
            ASSERT_FALSE(all[i].empty());
            EXPECT_NEAR(all[i].front().front, near, rounding);
            EXPECT_NEAR(all[i].back().back, chord.back, rounding);
        }
    }
}

TEST(IntegratorRays, OrderOfCellsAndCellsWithoutVolumeChangeNoBit)
{
    const View view = make_view(oblique, picture_size);
    const Medium medium({{-1.0, {1.0, 0.2, 0.0}, 0.1}, {1.0, {0.0, 0.5, 1.0}, 3.0}});
    Grid box = make_box(CubeSplit::five);
    const Picture expected = integrate({box.cells(), view, medium});
    std::mt19937 random(1);
    std::ranges::shuffle(box.grid.cells, random);
    const auto count = box.grid.cells.size();
    for (std::size_t i = 0; i < count; ++i) {
        glm::uvec4 &cell = box.grid.cells[i];
        std::swap(cell[i % 4], cell[(i + 1) % 4]);
        box.grid.cells.emplace_back(cell[0], cell[1], cell[2], cell[i % 3]);
    }
    const Picture picture = integrate({box.cells(), view, medium});
    EXPECT_EQ(picture.pixels, expected.pixels);
}

TEST(IntegratorRays, PlacesAreThoseOfTheCamera)
{
    // Into the middle of the picture looks the camera from its distance; a corner of the picture is
    // as far off as the field of view says, to the precision of the camera's floats.
    const View view = make_view(oblique, {200, 100});
    EXPECT_EQ(view.device_coordinates({100.0, 50.0}), glm::dvec2(0.0, 0.0));
    EXPECT_EQ(view.length_per_depth({0.0, 0.0}), 1.0);
    EXPECT_EQ(view.device_coordinates({0.0, 0.0}), glm::dvec2(-1.0, 1.0));
    const double tangent = std::tan(22.5 * std::acos(-1.0) / 180.0);
    EXPECT_NEAR(view.length_per_depth({-1.0, 1.0}), std::sqrt(1.0 + 5.0 * tangent * tangent), 1e-6);
    EXPECT_NEAR(view.pixel_area(), std::pow(2.0 * tangent / 100.0, 2), 1e-9);
}

TEST(IntegratorRays, BoundsHoldMovedRays)
{
    // A box is convex: chords are least at a square's corners. Where a chord is greatest between
    // the rays that are looked at, it exceeds them by no more than the slope (below 10 with the
    // sides of this view) times half of the square's diagonal, in pixels of 1/72 of the view's .83.
    const View view = make_view(oblique, picture_size);
    const Grid box = make_box(CubeSplit::five, 3);
    const Medium medium({{0.0, glm::dvec3(1.0), 1.0}});
    const double distance = 1.0 / 256.0;
    const Bounds bounds = integrate_bounds({box.cells(), view, medium}, distance);
    const double slack = 10.0 * distance * std::sqrt(2.0) * 4.5 * 0.83 / 72.0;
    std::mt19937 random(2);
    std::uniform_real_distribution<double> anywhere(-distance, distance);
    double width = 0.0;
    for (int i = 0; i < 8; ++i) {
        const Picture moved =
            integrate({box.cells(), view, medium}, {anywhere(random), anywhere(random)});
        for (std::size_t p = 0; p < moved.pixels.size(); ++p) {
            EXPECT_GE(moved.pixels[p].w, bounds.low.pixels[p].w - rounding);
            EXPECT_LE(moved.pixels[p].w, bounds.high.pixels[p].w + slack);
            width = std::max(width, bounds.high.pixels[p].w - bounds.low.pixels[p].w);
        }
    }
    EXPECT_GT(width, 1e-4);
    EXPECT_LT(width, 0.01);
}

} // namespace
