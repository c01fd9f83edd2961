// SPDX-License-Identifier: MIT
//
// Surfaces of grids, drawn in this process on the Mesa that LD_LIBRARY_PATH leads to.

#include "isosurface/surface_faces.hpp"
#include "tests/isosurface/isosurface_test.hpp"
#include "tests/isosurface/picture_rays.hpp"
#include "tests/isosurface/surface_reference.hpp"

#include "lib/scene/unit_sphere.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace kb::test
{

namespace
{

/// A generated grid in the unit sphere, with a field made of its points.
struct TestGrid {
    TetGrid grid;
    ScalarField field;
};

template <class Function>
TestGrid make_test_grid(const GeneratedGrid &wanted, Function function)
{
    TestGrid made{make_tet_grid(wanted), {"test", {}}};
    fit_to_unit_sphere(made.grid.points);
    for (const glm::vec3 &p : made.grid.points)
        made.field.values.push_back(function(p));
    return made;
}

float wave(glm::vec3 p)
{
    return generated_wave(1.7F * p);
}

/// The faces about the surfaces.
FaceMesh faces_with(const TestGrid &scene, const std::vector<float> &values)
{
    const ScalarRange range = range_of(scene.field.values);
    std::vector<IsoValue> wanted;
    for (const float value : values)
        wanted.push_back({value, {}, normalized(value, range)});
    return mark_faces_without_surface(make_face_mesh(scene.grid, scene.field), scene.grid.cells,
                                      range, wanted);
}

class SurfacesTest : public IsosurfaceTest
{
protected:
    ImageRgbaF draw(const TestGrid &scene, const std::vector<float> &values, int k = 24)
    {
        return draw_faces(scene, faces_with(scene, values), values, k);
    }

    ImageRgbaF draw_faces(const TestGrid &scene, const FaceMesh &faces,
                          const std::vector<float> &values, int k = 24)
    {
        auto stream = make_face_stream(gl(), faces, range_of(scene.field.values));
        return draw_stream(stream, range_of(scene.field.values), values, k);
    }
};

/// Where the surface is by rays through the centers of the pixels and about them.
struct Bounds {
    double nearest = 1e30;
    double farthest = 0.0;
    bool always = true;   ///< Each of the rays meets a surface.
    double lowest = 1e30; ///< Iso-value
    double highest = -1e30;
};

std::vector<Bounds> bound_surfaces(const TestGrid &scene, const OrbitCamera &camera,
                                   const std::vector<float> &values)
{
    // llvmpipe moves vertices by up to 1/512 pixel along each axis; rounding on the way adds less.
    constexpr double move = 1.0 / 256.0;
    const integrator::Cells cells{scene.grid.points, scene.grid.cells, scene.field.values};
    const std::vector<double> exact(values.begin(), values.end());
    std::vector<Bounds> bounds(std::size_t(size.width * size.height));
    for (const double x : {0.0, -move, move}) {
        for (const double y : {0.0, -move, move}) {
            const auto surfaces =
                find_surfaces(cells, integrator::make_view(camera, size), exact, {x, y});
            for (std::size_t i = 0; i < bounds.size(); ++i) {
                bounds[i].always = bounds[i].always && surfaces[i];
                if (!surfaces[i])
                    continue;
                bounds[i].nearest = std::min(bounds[i].nearest, surfaces[i]->distance);
                bounds[i].farthest = std::max(bounds[i].farthest, surfaces[i]->distance);
                bounds[i].lowest = std::min(bounds[i].lowest, surfaces[i]->value);
                bounds[i].highest = std::max(bounds[i].highest, surfaces[i]->value);
            }
        }
    }
    return bounds;
}

void expect_within(const ImageRgbaF &drawn, const std::vector<Bounds> &bounds)
{
    // Distances are less than 4 and rounded some 16 times, by 2^-23 each: when 1 / depth is
    // interpolated, turned round and made a distance, when the surface is put between two of them,
    // and when its distance is kept as 1 / distance.
    const double tolerance = 16.0 * std::ldexp(1.0, -23);
    int compared = 0;
    int outside = 0;
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        const double distance = drawn.pixels[i].x;
        if (bounds[i].farthest == 0.0) { // Not one ray meets a surface.
            outside += distance > 0.0;
            continue;
        }
        // Where a surface ends, or that of another value begins, the rays are too few.
        if (!bounds[i].always || bounds[i].lowest < bounds[i].highest)
            continue;
        ++compared;
        outside +=
            distance < bounds[i].nearest - tolerance || distance > bounds[i].farthest + tolerance;
    }
    EXPECT_EQ(outside, 0);
    EXPECT_GT(compared, size.width * size.height / 8) << "enough of the picture was compared";
}

TEST_F(SurfacesTest, AreWhereRaysThroughTheCellsFindThem)
{
    const std::vector<float> values{-0.6F, 0.1F, 0.9F};
    for (const auto &[split, azimuth] : {std::pair(CubeSplit::five, 0.0F),
                                         {CubeSplit::six, 30.0F},
                                         {CubeSplit::twenty_four, 75.0F}}) {
        SCOPED_TRACE(static_cast<int>(split));
        camera_.azimuth = azimuth;
        const TestGrid scene =
            make_test_grid({.cubes = 8, .split = split, .sliver_share = 0.0F}, wave);
        expect_within(draw(scene, values), bound_surfaces(scene, camera_, values));
    }
}

TEST_F(SurfacesTest, OfTheDistanceFieldIsASphere)
{
    // In a ball of radius R, interpolation differs by up to R^2 / 2 times the largest second
    // derivative: of the distance that is 1 / distance. A cell of edges up to h is in a ball of
    // R^2 = 3/8 h^2 (Jung). The eight cubes are sqrt(1/3) / 4 long, their diagonals sqrt(2) times
    // that, and points are moved by up to 0.2 along each axis at either end.
    const double cube = std::sqrt(1.0 / 3.0) / 4.0;
    const double h = cube * (std::sqrt(2.0) + 2.0 * 0.2 * std::sqrt(3.0));
    const float radius = 0.5F;
    const double bound = 3.0 / 16.0 * h * h / (radius - h);
    ASSERT_LT(bound, 0.1);

    // Slivers, too: there are some in the default grid.
    const TestGrid scene = make_test_grid({.cubes = 8, .sliver_share = 0.1F},
                                          [](glm::vec3 p) { return glm::length(p); });
    const ImageRgbaF drawn = draw(scene, {radius}, 60);
    int surfaces = 0;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const Ray ray = ray_through(camera_, x, y);
            const double distance = drawn.at(x, y).x;
            if (distance > 0.0) {
                ++surfaces;
                const glm::dvec3 point = ray.at(distance);
                ASSERT_NEAR(glm::length(point), radius, bound) << x << ", " << y;
                ASSERT_LT(glm::dot(point, ray.direction), bound) << "not the near side";
            } else {
                ASSERT_GT(ray.distance_from_origin(), radius - bound) << x << ", " << y;
            }
        }
    }
    EXPECT_GT(surfaces, 1000);
}

TEST_F(SurfacesTest, DoNotNeedFacesBetweenCellsWithoutOne)
{
    const TestGrid scene = make_test_grid({.cubes = 8, .sliver_share = 0.0F}, wave);
    const FaceMesh all = make_face_mesh(scene.grid, scene.field);
    const auto expect_same = [&](const std::vector<float> &values, float tolerance) {
        const FaceMesh faces = faces_with(scene, values);
        EXPECT_LT(faces.drawn_count(), all.drawn_count() * 3 / 4);
        const ImageRgbaF drawn = draw_faces(scene, faces, values);
        const ImageRgbaF expected = draw_faces(scene, all, values);
        for (std::size_t i = 0; i < drawn.pixels.size(); ++i) {
            EXPECT_NEAR(drawn.pixels[i].x, expected.pixels[i].x, tolerance) << i;
            EXPECT_EQ(drawn.pixels[i].y, expected.pixels[i].y) << i;
        }
    };
    expect_same({0.3F}, 0.0F);
    expect_same({0.95F, -0.6F, 0.1F}, 0.0F);
    // Through a point of the grid, where rounding decides in which cell the surface is found.
    expect_same({scene.field.values[100]}, 16.0F * 0x1p-23F);
}

TEST_F(SurfacesTest, OfManyIsoValuesAreTheNearestOfEach)
{
    const TestGrid scene = make_test_grid({.cubes = 8, .sliver_share = 0.0F}, wave);
    std::vector<float> values{-1.1F, -0.5F, -0.45F, 0.0F, 0.3F, 0.8F, 0.95F};
    const ImageRgbaF together = draw(scene, values);
    ImageRgbaF nearest(size.width, size.height);
    for (const float value : values) {
        const ImageRgbaF alone = draw(scene, {value});
        for (std::size_t i = 0; i < alone.pixels.size(); ++i) {
            const bool closer =
                alone.pixels[i].x > 0.0F &&
                (nearest.pixels[i].x == 0.0F || alone.pixels[i].x < nearest.pixels[i].x);
            if (closer)
                nearest.pixels[i] = alone.pixels[i];
        }
    }
    // Bit for bit: the depth of a surface does not depend on what other iso-values there are.
    std::vector<int> pixels(values.size());
    for (std::size_t i = 0; i < nearest.pixels.size(); ++i) {
        ASSERT_EQ(together.pixels[i], nearest.pixels[i]) << i;
        for (std::size_t v = 0; v < values.size(); ++v)
            pixels[v] += nearest.pixels[i].x > 0.0F &&
                         nearest.pixels[i].y == normalized(values[v], range_of(scene.field.values));
    }
    EXPECT_GT(std::ranges::count_if(pixels, [](int count) { return count > 100; }), 4)
        << "several of them are seen";
}

TEST_F(SurfacesTest, OfAThousandIsoValuesAreFoundInOnePass)
{
    const TestGrid scene = make_test_grid({.cubes = 8, .sliver_share = 0.0F}, wave);
    const ScalarRange range = range_of(scene.field.values);
    std::vector<float> values;
    std::mt19937 random(3);
    for (int i = 0; i < 1000; ++i) {
        const float place =
            (static_cast<float>(i) + 0.5F * static_cast<float>(random() >> 8U) * 0x1p-24F) /
            1000.0F;
        values.push_back(range.low + place * (range.high - range.low));
    }
    std::ranges::shuffle(values, random);
    expect_within(draw(scene, values), bound_surfaces(scene, camera_, values));
}

TEST_F(SurfacesTest, DoNotChangeWithKOnceItIsLargeEnough)
{
    // Without slivers: which of two fragments at one distance comes first depends on k, and between
    // faces that nearly touch the ray at a grazing angle their scalars differ.
    const TestGrid scene = make_test_grid({.cubes = 8, .sliver_share = 0.0F}, wave);
    const ImageRgbaF many = draw(scene, {-0.5F, 0.5F}, max_isosurface_k);
    for (const int k : {40, 41})
        EXPECT_TRUE(draw(scene, {-0.5F, 0.5F}, k).pixels == many.pixels) << k;
    // A test of this test: fragments do come in another order.
    EXPECT_FALSE(draw(scene, {-0.5F, 0.5F}, 1).pixels == many.pixels);
}

TEST_F(SurfacesTest, AreNotInTheHolesOfAGrid)
{
    // A grid of two boxes, 0 and 1 at their sides that face the gap between them: the iso-value 0.5
    // is in the gap only.
    TestGrid scene = make_test_grid({.cubes = 9, .jitter = 0.0F, .sliver_share = 0.0F},
                                    [](glm::vec3 p) { return p.z > 0.0F ? 1.0F : 0.0F; });
    const auto in_gap = [&scene](const glm::uvec4 &cell) {
        float sum = 0.0F;
        for (int i = 0; i < 4; ++i)
            sum += scene.field.values[cell[i]];
        return sum != 0.0F && sum != 4.0F;
    };
    camera_ = {};
    EXPECT_GT(std::ranges::count_if(draw(scene, {0.5F}).pixels,
                                    [](const glm::vec4 &pixel) { return pixel.x > 0.0F; }),
              1000)
        << "it is seen where there is no gap";
    std::erase_if(scene.grid.cells, in_gap);
    for (const glm::vec4 &pixel : draw(scene, {0.5F}).pixels)
        ASSERT_EQ(pixel.x, 0.0F);
}

TEST_F(SurfacesTest, OutOfTheRangeAreNone)
{
    const TestGrid scene = make_test_grid({.cubes = 4}, wave);
    for (const auto &values : {std::vector<float>{}, {-9.0F}, {9.0F, 1e30F, -3e38F}}) {
        for (const glm::vec4 &pixel : draw(scene, values).pixels)
            ASSERT_EQ(pixel, glm::vec4(0.0F));
        for (const glm::vec4 &pixel : picture_.pixels)
            ASSERT_EQ(pixel, glm::vec4(1.0F, 1.0F, 1.0F, 0.0F));
    }
    // Nor do they keep others from being found.
    EXPECT_TRUE(draw(scene, {9.0F, 0.5F, 1e30F, -3e38F}).pixels == draw(scene, {0.5F}).pixels);
}

TEST_F(SurfacesTest, AreLitAsTheirNormalsSay)
{
    // A plane: the field is linear.
    const glm::vec3 normal = glm::normalize(glm::vec3(0.4F, 0.5F, 0.7F));
    const TestGrid scene = make_test_grid({.cubes = 4, .jitter = 0.0F, .sliver_share = 0.0F},
                                          [normal](glm::vec3 p) { return glm::dot(normal, p); });
    const ImageRgbaF drawn = draw(scene, {0.1F});
    const auto is_surface = [&](int x, int y) {
        return x >= 0 && x < size.width && y >= 0 && y < size.height && drawn.at(x, y).x > 0.0F;
    };
    int inside = 0;
    int edge = 0;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const glm::vec4 &color = picture_.at(x, y);
            if (!is_surface(x, y)) {
                ASSERT_EQ(color, glm::vec4(1.0F, 1.0F, 1.0F, 0.0F)) << "the background";
                continue;
            }
            if (!is_surface(x - 1, y) || !is_surface(x + 1, y) || !is_surface(x, y - 1) ||
                !is_surface(x, y + 1)) {
                ++edge;
                ASSERT_EQ(color, glm::vec4(0.0F, 0.0F, 0.0F, 1.0F)) << "the silhouette";
                continue;
            }
            ++inside;
            const double cosine =
                std::abs(glm::dot(ray_through(camera_, x, y).direction, glm::dvec3(normal)));
            ASSERT_NEAR(color.r, 0.15 + 0.85 * cosine, 5e-4) << x << ", " << y;
        }
    }
    EXPECT_GT(inside, 1000);
    EXPECT_GT(edge, 100);
}

TEST_F(SurfacesTest, StayPlanesWhenDepthsAreMadeSmooth)
{
    // Steep, and it ends within the picture.
    const glm::vec3 normal = glm::normalize(glm::vec3(0.9F, 0.2F, 0.1F));
    const TestGrid scene = make_test_grid({.cubes = 4, .jitter = 0.0F, .sliver_share = 0.0F},
                                          [normal](glm::vec3 p) { return glm::dot(normal, p); });
    draw(scene, {0.1F});
    const ImageRgbaF plain = picture_;
    settings_.shading.smoothing = 9;
    draw(scene, {0.1F});
    // As above: twice what rounding makes of a cosine.
    for (std::size_t i = 0; i < plain.pixels.size(); ++i)
        ASSERT_NEAR(picture_.pixels[i].r, plain.pixels[i].r, 1e-3) << i;
    EXPECT_GT(std::ranges::count_if(plain.pixels, [](const glm::vec4 &p) { return p.r < 1.0F; }),
              1000);
}

} // namespace

} // namespace kb::test
