// SPDX-License-Identifier: MIT
//
// What holds for meshes of all formats.

#include "tests/lib/io/loaded_mesh.hpp"
#include "tests/support/temp_directory.hpp"

#include "lib/io/polygon.hpp"

#include <glm/vec2.hpp>

namespace
{

using namespace kb::test;

const std::string triangle_obj = "v 3 0 0\nv 5 0 0\nv 4 2 0\nf 1 2 3\n";

TEST(LoadMesh, ChoosesTheFormatByTheEndingOfTheName)
{
    const TempDirectory directory;
    EXPECT_TRUE(kb::load_mesh(directory.write("m.OBJ", triangle_obj)));
    expect_refused(directory.write("m.xyzzy", triangle_obj), "its name ends in none of .obj");
    expect_refused(directory.write("m.ply", triangle_obj), "does not begin with a line 'ply'");
    expect_refused(directory / "no-such-file.ply", "no such file");
    expect_refused(directory / ".", "it is a directory");
}

TEST(LoadMesh, FillsTheUnitSphere)
{
    const TempDirectory directory;
    const auto loaded = kb::load_mesh(directory.write("m.obj", triangle_obj));
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_EQ(loaded->center, glm::dvec3(4, 1, 0));
    EXPECT_DOUBLE_EQ(loaded->radius, std::sqrt(2.0));
    float radius = 0.0F;
    for (const glm::vec3 &p : loaded->mesh.positions)
        radius = std::max(radius, glm::length(p));
    EXPECT_NEAR(radius, 1.0F, 1e-6F);
}

TEST(LoadMesh, VerticesWithoutATriangleAreNobodysConcern)
{
    const TempDirectory directory;
    const auto alone = kb::load_mesh(directory.write("a.obj", triangle_obj));
    const auto more = kb::load_mesh(
        directory.write("b.obj", "v 3 0 0\nv 5 0 0\nv 4 2 0\nv 1e30 0 0\nv nan 0 0\nf 1 2 3\n"));
    ASSERT_TRUE(alone);
    ASSERT_TRUE(more) << more.error().message;
    EXPECT_EQ(more->mesh.positions, alone->mesh.positions);
    EXPECT_EQ(more->radius, alone->radius);
}

TEST(LoadMesh, MakesNormalsSmoothWeightedByArea)
{
    const TempDirectory directory;
    // A roof: faces of areas 1 and 2 meet in an edge, whose vertices are there twice.
    const auto loaded = kb::load_mesh(directory.write(
        "m.obj", "v 0 0 0\nv 0 1 0\nv -2 0 0\nv 0 0 0\nv 0 1 0\nv 0 0 -4\nf 1 2 3\nf 5 4 6\n"));
    ASSERT_TRUE(loaded) << loaded.error().message;
    const kb::Mesh &mesh = loaded->mesh;
    const glm::vec3 expected = glm::normalize(glm::vec3(2, 0, 1));
    EXPECT_LE(glm::distance(mesh.normals[mesh.indices[0]], expected), 1e-6F);
    EXPECT_EQ(mesh.normals[mesh.indices[0]], mesh.normals[mesh.indices[4]]);
    EXPECT_LE(glm::distance(mesh.normals[mesh.indices[2]], glm::vec3(0, 0, 1)), 1e-6F);
}

TEST(LoadMesh, BothSidesOfASheetHaveANormal)
{
    const TempDirectory directory;
    const auto loaded =
        kb::load_mesh(directory.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\nf 1 3 2\n"));
    ASSERT_TRUE(loaded) << loaded.error().message;
    for (const glm::vec3 &normal : loaded->mesh.normals)
        EXPECT_NEAR(std::abs(normal.y), 1.0F, 1e-6F);
}

TEST(Triangulate, KeepsAreaAndWindingOfConcavePolygons)
{
    // A comb, in planes of all directions.
    std::vector<glm::dvec2> comb{{0, 0}, {9, 0}};
    for (int tooth = 4; tooth >= 0; --tooth) {
        comb.emplace_back(2 * tooth + 1, 5);
        comb.emplace_back(2 * tooth, 5);
        if (tooth > 0) {
            comb.emplace_back(2 * tooth, 1);
            comb.emplace_back(2 * tooth - 1, 1);
        }
    }
    std::vector<std::uint32_t> corners;
    for (std::uint32_t i = 0; i < comb.size(); ++i)
        corners.push_back(i);
    for (const auto &[u, v] : {std::pair{glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)},
                               {glm::dvec3(0, 1, 0), glm::dvec3(1, 0, 0)},
                               {glm::dvec3(0, 0, -2), glm::dvec3(1, 1, 0)},
                               {glm::dvec3(1, 2, 3), glm::dvec3(3, 0, -1)}}) {
        std::vector<glm::dvec3> points;
        for (const glm::dvec2 &p : comb)
            points.push_back(p.x * u + p.y * v);
        const glm::dvec3 normal = glm::cross(u, v);
        std::vector<std::uint32_t> triangles;
        kb::triangulate(points, corners, triangles);
        ASSERT_EQ(triangles.size(), 3 * (comb.size() - 2));
        double area = 0.0;
        for (std::size_t i = 0; i < triangles.size(); i += 3) {
            const glm::dvec3 cross = glm::cross(points[triangles[i + 1]] - points[triangles[i]],
                                                points[triangles[i + 2]] - points[triangles[i]]);
            const double part = 0.5 * glm::dot(cross, normal) / glm::dot(normal, normal);
            EXPECT_GE(part, -1e-12);
            area += part;
        }
        EXPECT_NEAR(area, 9 * 1 + 5 * 4, 1e-9);
    }
}

} // namespace
