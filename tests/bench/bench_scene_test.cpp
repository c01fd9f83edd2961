// SPDX-License-Identifier: MIT
//
// The scenes of the study are what their figures are quoted for: counts, extents, and the same on
// every run.

#include "bench/study_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <span>

namespace kb::bench
{

/// The box of all vertices after the projection.
static std::pair<glm::vec3, glm::vec3> box_in_view(const StudyScene &scene)
{
    glm::vec3 low(1e30F);
    glm::vec3 high(-1e30F);
    for (const glm::vec3 &position : scene.mesh.positions) {
        const glm::vec3 p(scene.projection * glm::vec4(position, 1.0F));
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    return {low, high};
}

static void expect_inside_view(const StudyScene &scene)
{
    const auto [low, high] = box_in_view(scene);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(low[axis], -1.0F) << axis;
        EXPECT_LE(high[axis], 1.0F) << axis;
    }
    // Depth 1 is that of a cleared buffer: fragments there would not be kept.
    EXPECT_LT(high.z, 1.0F);
}

TEST(BenchScene, SpheresAreAMillionTriangles)
{
    const StudyScene scene = make_spheres();
    EXPECT_TRUE(check_mesh(scene.mesh));
    EXPECT_EQ(scene.mesh.triangle_count(), 300U * 2 * 42 * 40);
    expect_inside_view(scene);
}

TEST(BenchScene, QuadsCoverTheSameHalfOfTheViewAtShuffledDistinctDepths)
{
    const StudyScene scene = make_quads();
    ASSERT_TRUE(check_mesh(scene.mesh));
    ASSERT_EQ(scene.mesh.triangle_count(), 128U * 2);
    ASSERT_EQ(scene.mesh.positions.size(), 128U * 4);
    expect_inside_view(scene);

    std::vector<float> depths;
    for (std::size_t quad = 0; quad < 128; ++quad) {
        const std::span corners = std::span(scene.mesh.positions).subspan(quad * 4, 4);
        const auto [left, right] = std::ranges::minmax(corners, {}, &glm::vec3::x);
        const auto [bottom, top] = std::ranges::minmax(corners, {}, &glm::vec3::y);
        EXPECT_EQ(right.x - left.x, 1.0F);
        EXPECT_EQ(top.y - bottom.y, 2.0F);
        EXPECT_EQ(left.x, -0.5F);
        depths.push_back(corners[0].z);
    }
    EXPECT_EQ(std::set(depths.begin(), depths.end()).size(), 128U);
    EXPECT_FALSE(std::ranges::is_sorted(depths));
    EXPECT_FALSE(std::ranges::is_sorted(depths, std::greater{}));
}

TEST(BenchScene, GeneratedScenesAreTheSameEveryTime)
{
    // Sums of what the seeds give, in double precision; a changed seed or generator changes them.
    const auto sum = [](const StudyScene &scene) {
        double total = 0.0;
        for (const glm::vec4 &color : scene.mesh.colors)
            total += double(color.r) + 2.0 * double(color.g) + 3.0 * double(color.b) +
                     4.0 * double(color.a);
        return total / static_cast<double>(scene.mesh.colors.size());
    };
    EXPECT_NEAR(sum(make_spheres()), 5.203414, 1e-5);
    EXPECT_NEAR(sum(make_quads()), 5.127739, 1e-5);
    EXPECT_EQ(make_spheres().mesh.positions, make_spheres().mesh.positions);
}

TEST(BenchScene, MeshesFillTheView)
{
    Mesh mesh;
    append_sphere(mesh, {10.0F, -20.0F, 30.0F}, 4.0F, glm::vec4(1.0F), 16, 8);
    append_quad(mesh, {5.0F, -20.0F, 30.0F}, {10.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F},
                glm::vec4(1.0F));
    const StudyScene scene = make_mesh_scene(mesh);
    expect_inside_view(scene);
    const auto [low, high] = box_in_view(scene);
    EXPECT_NEAR(high.x - low.x, 2.0 / 1.01, 1e-5); // The wider side, with the margin of 1 %
    EXPECT_EQ(scene.mesh.colors.size(), scene.mesh.positions.size());
}

TEST(BenchScene, AMissingDragonIsReplacedAndSaidSo)
{
    const auto scene = make_scene("dragon", "no/such/dragon.ply");
    ASSERT_TRUE(scene);
    EXPECT_NE(scene->note.find("no/such/dragon.ply"), std::string::npos);
    EXPECT_NEAR(static_cast<double>(scene->mesh.triangle_count()), 871'414.0, 5'000.0);
    expect_inside_view(*scene);
}

TEST(BenchScene, UnknownNamesAreErrors)
{
    EXPECT_FALSE(make_scene("teapot", ""));
}

} // namespace kb::bench
