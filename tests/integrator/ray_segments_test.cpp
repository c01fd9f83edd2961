// SPDX-License-Identifier: MIT
//
// Cells along rays, and pictures, against what is known of a box.

#include "lib/io/tet_grid.hpp"
#include "tests/integrator/box.hpp"
#include "tests/integrator/integrator.hpp"

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

/// Coordinates are up to 4 and some tens of operations with doubles lead to a depth, whose rounding
/// a grazing ray magnifies: rays that enter a side at less than 1e-3 are not compared.
constexpr double rounding = 1e-11;

const OrbitCamera oblique{.azimuth = 31.0F, .elevation = 22.0F, .distance = 4.5F};
constexpr Size picture_size{96, 72};

/// Calls `look` with the place and the segments of each pixel's ray.
template <class Look>
void for_each_ray(const Grid &grid, const View &view, Look look)
{
    const RaySegments rays(grid.cells(), view);
    const auto all = rays.find(0, view.size.height);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const int x = static_cast<int>(i) % view.size.width;
        const int y = static_cast<int>(i) / view.size.width;
        SCOPED_TRACE(testing::Message() << x << ", " << y);
        look(rays.device_coordinates(x, y), all[i]);
    }
}

/// The segments join, bit for bit unless a gap is allowed, from one end of the chord to the other.
void expect_chord(const std::vector<RaySegment> &segments, const Interval &chord, double gap = 0.0)
{
    if (segments.empty()) {
        EXPECT_LT(chord.depth(), rounding);
        return;
    }
    EXPECT_NEAR(segments.front().front, chord.front, rounding);
    EXPECT_NEAR(segments.back().back, chord.back, rounding);
    double sum = 0.0;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        if (i > 0) {
            EXPECT_NEAR(segments[i].front, segments[i - 1].back, gap);
            EXPECT_NEAR(segments[i].scalar_front, segments[i - 1].scalar_back, gap);
        }
        EXPECT_LE(segments[i].front, segments[i].back);
        sum += segments[i].back - segments[i].front;
    }
    EXPECT_NEAR(sum, chord.depth(), rounding);
}

/// x at a depth of a ray.
double place_on_ray(const View &view, glm::dvec2 device, double w)
{
    // z of clip coordinates follows from w.
    const double z = view.projection[2][2] * -w + view.projection[3][2];
    return (glm::inverse(view.projection * view.view) * glm::dvec4(device * w, z, w)).x;
}

TEST(IntegratorRays, SegmentsOfABoxAreItsChordWithoutGap)
{
    const View view = make_view(oblique, picture_size);
    for (const CubeSplit split : splits) {
        std::size_t inside = 0;
        for_each_ray(make_box(split), view, [&](glm::dvec2 device, const auto &segments) {
            expect_chord(segments, cross_box(view, device, 1.0));
            inside += segments.empty() ? 0 : 1;
        });
        EXPECT_GT(inside, 96U * 72U / 4U);
    }
}

TEST(IntegratorRays, ScalarsAreThoseOfThePlace)
{
    const View view = make_view(oblique, picture_size);
    for_each_ray(make_box(CubeSplit::five), view, [&](glm::dvec2 device, const auto &segments) {
        for (const RaySegment &segment : segments)
            EXPECT_NEAR(segment.scalar_back, place_on_ray(view, device, segment.back), rounding);
    });
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
    // Where faces meet at the same depth rounding decides which of them is in front.
    const View view = make_view({.distance = 4.0F}, {65, 65});
    for (const CubeSplit split : splits) {
        const Grid box(
            make_tet_grid({.cubes = 4, .split = split, .jitter = 0.0F, .sliver_share = 0.0F}));
        for_each_ray(box, view, [&](glm::dvec2 device, const auto &segments) {
            expect_chord(segments, cross_box(view, device, 1.0), rounding);
        });
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
    constexpr double background = 0.25;
    const Picture picture = integrate({box.cells(), view, medium, glm::dvec3(background)});
    std::size_t through_hole = 0;
    for (int y = 0; y < picture_size.height; ++y)
        for (int x = 0; x < picture_size.width; ++x) {
            const glm::dvec2 device = rays.device_coordinates(x, y);
            const double hole = cross_box(view, device, 0.5).depth();
            const double chord = cross_box(view, device, 1.0).depth() - hole;
            through_hole += hole > 0.1 ? 1 : 0;
            EXPECT_NEAR(picture.at(x, y).w, -std::expm1(-chord * view.length_per_depth(device)),
                        rounding);
            EXPECT_NEAR(picture.at(x, y).r, std::lerp(background, 1.0, picture.at(x, y).w),
                        rounding);
        }
    EXPECT_GT(through_hole, 100U);
}

TEST(IntegratorRays, BeginAtTheNearPlane)
{
    // The eye is in the box.
    View view = make_view({.azimuth = 31.0F, .elevation = 22.0F, .distance = 0.5F}, picture_size);
    for (const double near : {0.0, 0.3}) {
        view.near = near;
        for_each_ray(make_box(CubeSplit::six), view, [&](glm::dvec2 device, const auto &segments) {
            ASSERT_FALSE(segments.empty());
            expect_chord(segments, {near, cross_box(view, device, 1.0).back});
            EXPECT_NEAR(segments.front().scalar_front, place_on_ray(view, device, near), rounding);
        });
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

TEST(IntegratorRays, MovedByPixelsTheyAreThoseOfOtherPixels)
{
    const View view = make_view(oblique, picture_size);
    const Medium medium({{-1.0, {1.0, 0.2, 0.0}, 0.1}, {1.0, {0.0, 0.5, 1.0}, 3.0}});
    const Grid box = make_box(CubeSplit::five);
    const Picture still = integrate({box.cells(), view, medium});
    const Picture moved = integrate({box.cells(), view, medium}, {7.0, -5.0});
    for (int y = 5; y < picture_size.height; ++y)
        for (int x = 0; x + 7 < picture_size.width; ++x)
            EXPECT_EQ(moved.at(x, y), still.at(x + 7, y - 5));
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
