// SPDX-License-Identifier: MIT

#include "lib/io/mesh.hpp"
#include "tests/support/temp_directory.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace
{

using kb::test::TempDirectory;

kb::Mesh triangle()
{
    kb::Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.normals.assign(3, {0, 0, 1});
    mesh.indices = {0, 1, 2};
    return mesh;
}

TEST(CheckMesh, AcceptsATriangle)
{
    EXPECT_TRUE(kb::check_mesh(triangle()));
}

TEST(CheckMesh, NamesWhatIsWrong)
{
    kb::Mesh mesh = triangle();
    mesh.indices.clear();
    EXPECT_EQ(kb::check_mesh(mesh).error().message, "the mesh has no triangles");

    mesh = triangle();
    mesh.indices[1] = 3;
    EXPECT_EQ(kb::check_mesh(mesh).error().message,
              "index 1 of the mesh is 3, but it has 3 vertices");

    mesh = triangle();
    mesh.positions[2].y = std::nanf("");
    EXPECT_EQ(kb::check_mesh(mesh).error().message, "vertex 2 of the mesh is not finite");

    mesh = triangle();
    mesh.normals[0].x = INFINITY;
    EXPECT_FALSE(kb::check_mesh(mesh));

    mesh = triangle();
    mesh.normals.pop_back();
    EXPECT_FALSE(kb::check_mesh(mesh));

    mesh = triangle();
    mesh.colors.resize(2);
    EXPECT_FALSE(kb::check_mesh(mesh));

    mesh = triangle();
    mesh.indices.push_back(0);
    EXPECT_FALSE(kb::check_mesh(mesh));
}

TEST(FitToUnitSphere, CentersAndScales)
{
    kb::Mesh mesh = triangle();
    for (auto &p : mesh.positions)
        p = 300.0F * p + glm::vec3(7, -100, 5);
    kb::fit_to_unit_sphere(mesh);
    float radius = 0.0F;
    for (const auto &p : mesh.positions)
        radius = std::max(radius, glm::length(p));
    EXPECT_NEAR(radius, 1.0F, 1e-6F);

    // Squares of such lengths are no floats.
    for (const float unit : {1e-30F, 1e30F}) {
        kb::Mesh scaled = triangle();
        for (auto &p : scaled.positions)
            p *= unit;
        kb::fit_to_unit_sphere(scaled);
        for (std::size_t i = 0; i < scaled.positions.size(); ++i)
            EXPECT_LT(glm::distance(scaled.positions[i], mesh.positions[i]), 1e-6F) << unit;
    }

    kb::Mesh point = triangle();
    point.positions.assign(3, {4, 4, 4});
    kb::fit_to_unit_sphere(point);
    EXPECT_EQ(point.positions[0], glm::vec3(0.0F));
}

TEST(GeneratedMesh, KnotIsSoundAndOfTheWantedSize)
{
    for (const std::size_t triangles : {100U, 1000U, 100000U}) {
        const kb::Mesh mesh = kb::make_knot(triangles);
        EXPECT_TRUE(kb::check_mesh(mesh));
        EXPECT_NEAR(double(mesh.triangle_count()), double(triangles), 0.25 * double(triangles));
    }
}

TEST(GeneratedMesh, NormalsPointAwayFromFaces)
{
    kb::Mesh mesh = kb::make_knot(1000);
    kb::append_sphere(mesh, {1, 2, 3}, 0.5F, glm::vec4(1.0F), 16, 8);
    kb::append_quad(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, glm::vec4(1.0F));
    ASSERT_TRUE(kb::check_mesh(mesh));
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const glm::vec3 a = mesh.positions[mesh.indices[i]];
        const glm::vec3 b = mesh.positions[mesh.indices[i + 1]];
        const glm::vec3 c = mesh.positions[mesh.indices[i + 2]];
        const glm::vec3 face = glm::cross(b - a, c - a);
        if (glm::length(face) > 1e-6F) { // The poles have triangles without area.
            EXPECT_GT(glm::dot(face, mesh.normals[mesh.indices[i + 1]]), 0.0F) << i / 3;
        }
    }
}

} // namespace
