// SPDX-License-Identifier: MIT
//
// Surfaces of particles, drawn in this process on the Mesa that LD_LIBRARY_PATH leads to.

#include "tests/isosurface/isosurface_test.hpp"
#include "tests/isosurface/picture_rays.hpp"

#include "isosurface/particles.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace kb::test
{

namespace
{

class ParticlesTest : public IsosurfaceTest
{
protected:
    ImageRgbaF draw(const std::vector<glm::vec3> &points, const std::vector<float> &scalars,
                    float point_size, float gap, float value, int k = 2)
    {
        const ScalarRange range{0.0F, 1.0F};
        auto stream = make_particle_stream(gl(), points, scalars, range, point_size);
        return draw_stream(stream, range, {value}, k, gap);
    }
};

TEST_F(ParticlesTest, InLayersHaveASurfaceBetweenThem)
{
    // Layers that cover the picture, square to the line of sight, in no order.
    camera_ = {};
    constexpr float spacing = 0.05F;
    std::vector<glm::vec3> points;
    std::vector<float> scalars;
    for (const auto &[z, scalar] :
         {std::pair(0.0F, 0.6F), {-0.3F, 1.0F}, {0.3F, 0.0F}, {0.15F, 0.1F}}) {
        for (int y = -30; y <= 30; ++y) {
            for (int x = -30; x <= 30; ++x) {
                points.emplace_back(spacing * static_cast<float>(x),
                                    spacing * static_cast<float>(y), z);
                scalars.push_back(scalar);
            }
        }
    }
    // 0.35 is half way between 0.1 at z = 0.15 and 0.6 at 0.
    const double depth = double(camera_.distance) - 0.075;
    // As in surfaces_test.cpp, and the scalars are rounded, too.
    const double tolerance = 32.0 * std::ldexp(1.0, -23);
    const ImageRgbaF drawn = draw(points, scalars, 2.0F * spacing, 0.2F, 0.35F);
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x)
            ASSERT_NEAR(drawn.at(x, y).x, depth * length_per_depth(camera_, x, y), tolerance)
                << x << ", " << y;
    }
    // 0.15 between layers is a gap now.
    for (const glm::vec4 &pixel : draw(points, scalars, 2.0F * spacing, 0.14F, 0.35F).pixels)
        ASSERT_EQ(pixel.x, 0.0F);
}

TEST_F(ParticlesTest, OfTheDistanceFieldAreASphere)
{
    const PointSet set = make_particles(300'000);
    std::vector<float> distances;
    for (const glm::vec3 &p : set.points)
        distances.push_back(glm::length(p));
    // The lattice's cubes, each with a particle. A point of twice the diagonal of a cube is in the
    // way of every ray through the cube, so that two that follow each other on a ray are at most
    // two diagonals apart.
    const double cube = 2.0 / std::round(std::cbrt(300'000.0 * 6.0 / 3.14159265));
    const double diagonal = std::sqrt(3.0) * cube;
    const double side = 2.0 * diagonal;
    constexpr float radius = 0.6F;
    const ImageRgbaF drawn = draw(set.points, distances, static_cast<float>(side),
                                  static_cast<float>(2.5 * diagonal), radius, 2);

    // The second derivative of the distance is 1 / distance. A particle's scalar is continued by a
    // gradient over half the diagonal of its square, which neglects `curvature` at most. The
    // gradient is that of points in a box of 3 x 3 x 3 cubes of side `spacing`: there the distance
    // differs from its tangent by 0 to q = R^2 / 2 of the second derivative, R being half the box's
    // diagonal, which has a deviation of q / 2 at most. Least squares make of it a gradient of no
    // more than q / 2 / (the points' deviation), and that is 0.87 spacings for an even box; 0.6 is
    // for an uneven one. Between two particles linear interpolation adds length^2 / 8 times the
    // second derivative.
    const double spacing = mean_spacing(set.points);
    const double bend = 1.0 / (radius - side);
    const double reach = side / std::sqrt(2.0);
    const double curvature = reach * reach / 2.0 * bend;
    const double q = std::pow(1.5 * spacing, 2.0) * 3.0 / 2.0 * bend;
    const double bound =
        curvature + q / 2.0 / (0.6 * spacing) * reach + std::pow(2.0 * diagonal, 2.0) / 8.0 * bend;
    ASSERT_LT(bound, reach / 3.0) << "without gradients it would be `reach`";
    int surfaces = 0;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const Ray ray = ray_through(camera_, x, y);
            const double distance = drawn.at(x, y).x;
            if (distance > 0.0) {
                ++surfaces;
                ASSERT_NEAR(glm::length(ray.at(distance)), radius, bound) << x << ", " << y;
            } else {
                ASSERT_GT(ray.distance_from_origin(), radius - bound) << x << ", " << y;
            }
        }
    }
    EXPECT_GT(surfaces, 1000);
}

TEST_F(ParticlesTest, ComeInOrder)
{
    const PointSet set = make_particles(20'000);
    const auto &scalars = set.fields.front().values;
    const float side = 2.0F * mean_spacing(set.points);
    const ImageRgbaF two = draw(set.points, scalars, side, 0.5F, 0.3F, 2);
    const ImageRgbaF many = draw(set.points, scalars, side, 0.5F, 0.3F, 16);
    EXPECT_TRUE(two.pixels == many.pixels);
    EXPECT_GT(std::ranges::count_if(two.pixels, [](const glm::vec4 &p) { return p.x > 0.0F; }),
              1000);
}

TEST(GeneratedParticles, FillTheUnitBall)
{
    for (const std::size_t count : {100U, 5'000U, 200'000U}) {
        const PointSet set = make_particles(count);
        EXPECT_TRUE(check_point_set(set));
        EXPECT_NEAR(static_cast<double>(set.points.size()), static_cast<double>(count),
                    0.2 * static_cast<double>(count));
        for (const glm::vec3 &p : set.points)
            ASSERT_LE(glm::length(p), 1.000001F);
        // Their box has the volume 8.
        const double expected = std::cbrt(8.0 / static_cast<double>(set.points.size()));
        EXPECT_NEAR(mean_spacing(set.points), expected, 0.2 * expected);
    }
    EXPECT_EQ(make_particles(1'000).points, make_particles(1'000).points);
}

TEST(MeanSpacing, IsOfBoxesPlanesAndLines)
{
    const auto spacing = [](int x_count, int y_count, int z_count) {
        std::vector<glm::vec3> points;
        for (int x = 0; x < x_count; ++x)
            for (int y = 0; y < y_count; ++y)
                for (int z = 0; z < z_count; ++z)
                    points.emplace_back(z, x, y);
        return mean_spacing(points);
    };
    // n points are n - 1 spaces.
    EXPECT_NEAR(spacing(40, 40, 40), 39.0F / 40.0F, 1e-5F);
    EXPECT_NEAR(spacing(40, 40, 1), 39.0F / 40.0F, 1e-5F);
    EXPECT_NEAR(spacing(1, 40, 1), 39.0F / 40.0F, 1e-5F);
    EXPECT_EQ(spacing(1, 1, 1), 0.0F);
}

} // namespace

} // namespace kb::test
