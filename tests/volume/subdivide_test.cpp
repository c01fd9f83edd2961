// SPDX-License-Identifier: MIT

#include "volume/subdivide.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/type_precision.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace
{

/// The scalar is 2 x + 3 y.
float scalar_at(glm::vec3 p)
{
    return 2.0F * p.x + 3.0F * p.y;
}

kb::FaceMesh mesh_of(const std::vector<glm::vec3> &corners, std::size_t interior_count = 0)
{
    kb::FaceMesh mesh;
    for (const glm::vec3 &corner : corners) {
        mesh.positions.push_back(corner);
        mesh.scalars.push_back(scalar_at(corner));
    }
    for (std::uint32_t i = 0; i < corners.size(); i += 3)
        mesh.triangles.emplace_back(i, i + 1, i + 2);
    mesh.interior_count = interior_count;
    return mesh;
}

/// Twice the area, with its direction.
glm::dvec3 area(const kb::FaceMesh &mesh, const glm::uvec3 &triangle)
{
    const glm::dvec3 a(mesh.positions[triangle.x]);
    return glm::cross(glm::dvec3(mesh.positions[triangle.y]) - a,
                      glm::dvec3(mesh.positions[triangle.z]) - a);
}

double longest_to_shortest(const kb::FaceMesh &mesh, const glm::uvec3 &triangle)
{
    std::array<double, 3> lengths{};
    for (int i = 0; i < 3; ++i)
        lengths[std::size_t(i)] = glm::distance(glm::dvec3(mesh.positions[triangle[i]]),
                                                glm::dvec3(mesh.positions[triangle[(i + 1) % 3]]));
    return *std::ranges::max_element(lengths) / *std::ranges::min_element(lengths);
}

// Edges 4 (from 0 to 1), 1 (from 0 to 2) and sqrt(17).
const std::vector<glm::vec3> needle{{0, 0, 0}, {4, 0, 0}, {0, 1, 0}};

TEST(Subdivide, PutsTheVertexOnTheLongestEdgeAsFarAsTheShortestIsLong)
{
    const kb::FaceMesh split = kb::subdivide(mesh_of(needle), 2.0);
    ASSERT_EQ(split.triangles.size(), 2U);
    ASSERT_EQ(split.positions.size(), 4U);
    // The longest and the shortest edge meet at (0, 1, 0).
    const glm::dvec3 expected = glm::dvec3(0, 1, 0) + glm::normalize(glm::dvec3(4, -1, 0)) * 1.0;
    // A coordinate up to 1 in floats.
    EXPECT_NEAR(glm::distance(glm::dvec3(split.positions[3]), expected), 0.0, std::exp2(-23));
    EXPECT_EQ(split.triangles[0], glm::uvec3(0, 3, 2)) << "the piece at the corner";
    EXPECT_EQ(split.triangles[1], glm::uvec3(0, 1, 3)) << "the rest";
}

TEST(Subdivide, HalvesTheLongestEdgeOfWhatIsNotThin)
{
    const kb::FaceMesh split = kb::subdivide(mesh_of({{0, 0, 0}, {4, 0, 0}, {2, 3, 0}}), 2.0);
    ASSERT_EQ(split.positions.size(), 4U);
    EXPECT_EQ(split.positions[3], glm::vec3(2, 0, 0));

    // Of equal edges no vertex is on two.
    const kb::FaceMesh equal = kb::subdivide(mesh_of({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}), 2.0);
    ASSERT_EQ(equal.positions.size(), 4U);
    EXPECT_EQ(glm::length(area(equal, equal.triangles[0])),
              glm::length(area(equal, equal.triangles[1])));
}

TEST(Subdivide, KeepsSurfaceScalarAndOrientation)
{
    const std::vector<glm::vec3> corners{
        {0.1F, 0.2F, 0.3F}, {3.7F, -0.4F, 1.9F}, {0.2F, 0.9F, 0.8F}};
    const kb::FaceMesh mesh = mesh_of(corners);
    const glm::dvec3 whole = area(mesh, mesh.triangles[0]);
    for (const auto first : {kb::SplitFirst::longest, kb::SplitFirst::thinnest}) {
        const kb::FaceMesh split = kb::subdivide(mesh, 50.0, first);
        ASSERT_EQ(split.triangles.size(), 50U);
        EXPECT_TRUE(
            std::equal(mesh.positions.begin(), mesh.positions.end(), split.positions.begin()))
            << "vertices stay where they are";
        // A new vertex is rounded to floats: coordinates below 4 by 2^-23, so points by 2^-22 in
        // all. It may lie between others that were, and so on: each is halfway at most to the
        // farther end of its edge, which makes it twice that. The scalar changes by less than 4 a
        // unit of length, and is rounded itself, below 16, by 2^-21.
        const double distance = std::exp2(-21);
        const double scalar = 4.0 * distance + std::exp2(-20);
        glm::dvec3 sum(0.0);
        for (std::size_t i = 0; i < split.positions.size(); ++i) {
            EXPECT_NEAR(glm::dot(glm::dvec3(split.positions[i]) - glm::dvec3(corners[0]),
                                 glm::normalize(whole)),
                        0.0, distance);
            EXPECT_NEAR(split.scalars[i], scalar_at(split.positions[i]), scalar);
        }
        for (const glm::uvec3 &triangle : split.triangles) {
            EXPECT_GT(glm::dot(area(split, triangle), whole), 0.0) << "seen from the same side";
            sum += area(split, triangle);
        }
        // A vertex off by `distance` moves each area by no more than that times its edges, of less
        // than 8 in all; 50 vertices.
        EXPECT_NEAR(glm::distance(sum, whole), 0.0, 50.0 * 8.0 * distance);
    }
}

TEST(Subdivide, LeavesLittleThinArea)
{
    // Edges of 1,000 and 0.9. A scheme that halves all edges would keep the ratio in all pieces.
    const kb::FaceMesh mesh = mesh_of({{0, 0, 0}, {1000, 0, 0}, {0.5F, 0.75F, 0}});
    const kb::FaceMesh split = kb::subdivide(mesh, 2000.0, kb::SplitFirst::thinnest);
    // What is split off has two equal edges at an angle of 33 to 90 degrees: a ratio of 2 at most.
    // The rest is as thin as before. Of its two long edges in turn one gets shorter, by at least
    // its width, 0.75/1,000 of the length: after 2,000 times its length is no more than
    // (1 - 0.75/1,000)^1,000 = 0.472 of what it was, its area 0.223.
    double thin = 0.0;
    int thin_count = 0;
    for (const glm::uvec3 &triangle : split.triangles) {
        if (longest_to_shortest(split, triangle) > 3.0) {
            thin += glm::length(area(split, triangle));
            ++thin_count;
        }
    }
    EXPECT_LE(thin_count, 1) << "the rest";
    EXPECT_LT(thin, 0.23 * glm::length(area(mesh, mesh.triangles[0])));
}

TEST(Subdivide, SplitsTheLongestOrTheThinnestFirst)
{
    const std::vector<glm::vec3> corners{
        {0, 0, 0}, {1, 0, 0}, {0.5F, 0.01F, 0}, // Thin, but small.
        {0, 0, 1}, {5, 0, 1}, {0, 5, 1},        // Long.
    };
    const kb::FaceMesh mesh = mesh_of(corners);
    const kb::FaceMesh longest = kb::subdivide(mesh, 1.5, kb::SplitFirst::longest);
    ASSERT_EQ(longest.triangles.size(), 3U);
    EXPECT_EQ(longest.triangles[0], mesh.triangles[0]);
    EXPECT_NE(longest.triangles[1], mesh.triangles[1]);

    const kb::FaceMesh thinnest = kb::subdivide(
        mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 0.1F, 0}, {0, 0, 1}, {5, 0, 1}, {0, 5, 1}}), 1.5,
        kb::SplitFirst::thinnest);
    ASSERT_EQ(thinnest.triangles.size(), 3U);
    EXPECT_EQ(thinnest.triangles[2], mesh.triangles[1]);
}

TEST(Subdivide, KeepsFacesInOrderAndInteriorOnesFirst)
{
    std::vector<glm::vec3> corners;
    for (int i = 0; i < 4; ++i)
        for (const glm::vec3 &corner : needle)
            corners.push_back(corner + glm::vec3(0, 0, i));
    const kb::FaceMesh split = kb::subdivide(mesh_of(corners, 3), 4.0);
    ASSERT_EQ(split.triangles.size(), 16U);
    float last = 0.0F;
    for (std::size_t i = 0; i < 16; ++i) {
        const float z = split.positions[split.triangles[i].x].z;
        EXPECT_GE(z, last);
        EXPECT_EQ(z < 3.0F, i < split.interior_count);
        last = z;
    }
}

TEST(Subdivide, KeepsToTheBudget)
{
    const kb::FaceMesh mesh =
        mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {5, 0, 1}, {0, 5, 1}});
    EXPECT_EQ(kb::subdivide(mesh, 1.0).triangles, mesh.triangles);
    EXPECT_EQ(kb::subdivide(mesh, 1.49).triangles, mesh.triangles) << "rounded down";
    EXPECT_EQ(kb::subdivide(mesh, 3.5).triangles.size(), 7U);
    EXPECT_TRUE(kb::subdivide(kb::FaceMesh{}, 12.0).triangles.empty());
}

TEST(Subdivide, EndsWhereFloatsCannotSplit)
{
    const float next = std::nextafter(1.0F, 2.0F);
    // There is no float between 1 and the next; an edge of no length is not split at its own end
    // for ever. The edge from (next, 1, 1) to (1, next, 1) has a middle: (1, 1, 1) again.
    const kb::FaceMesh mesh =
        mesh_of({{1, 1, 1}, {next, 1, 1}, {1, next, 1}, {0, 0, 0}, {0, 0, 0}, {1, 0, 0}});
    for (const auto first : {kb::SplitFirst::longest, kb::SplitFirst::thinnest})
        EXPECT_LE(kb::subdivide(mesh, 100.0, first).triangles.size(), 3U);
}

} // namespace
