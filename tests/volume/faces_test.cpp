// SPDX-License-Identifier: MIT
//
// The faces of a grid: each once, the boundary turned outward.

#include "tests/lib/io/tet_grid_file.hpp"
#include "volume/faces.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <span>

namespace
{

kb::FaceMesh faces_of(const kb::TetGrid &grid)
{
    return kb::make_face_mesh(grid, grid.fields.front());
}

std::span<const glm::uvec3> boundary_of(const kb::FaceMesh &mesh)
{
    return std::span(mesh.triangles).subspan(mesh.interior_count);
}

/// By the divergence theorem: a sixth of the sum of triple products of outward triangles.
double enclosed_volume(const kb::FaceMesh &mesh)
{
    double sum = 0.0;
    for (const glm::uvec3 &t : boundary_of(mesh))
        sum +=
            glm::dot(glm::dvec3(mesh.positions[t.x]),
                     glm::cross(glm::dvec3(mesh.positions[t.y]), glm::dvec3(mesh.positions[t.z])));
    return sum / 6.0;
}

std::array<std::uint32_t, 3> sorted_points(const glm::uvec3 &t)
{
    std::array points{t.x, t.y, t.z};
    std::ranges::sort(points);
    return points;
}

TEST(Faces, TwoCellsHaveOneFaceBetweenThem)
{
    const kb::FaceMesh mesh = faces_of(kb::test::two_cells());
    EXPECT_EQ(mesh.interior_count, 1U);
    EXPECT_EQ(mesh.triangles.size(), 7U);
}

TEST(Faces, OfAGridAreThereOnce)
{
    const kb::TetGrid grid = kb::make_tet_grid({.cubes = 4});
    const kb::FaceMesh mesh = faces_of(grid);
    std::set<std::array<std::uint32_t, 3>> faces;
    for (const glm::uvec3 &t : mesh.triangles)
        faces.insert(sorted_points(t));
    EXPECT_EQ(faces.size(), mesh.triangles.size());
    // Each cell has four; those inside belong to two cells.
    EXPECT_EQ(4 * grid.cells.size(), 2 * mesh.interior_count + boundary_of(mesh).size());
    // The box's sides are 4 x 4 squares in two triangles.
    EXPECT_EQ(boundary_of(mesh).size(), 6U * 4U * 4U * 2U);
}

TEST(Faces, TheBoundaryEnclosesTheGridFromOutside)
{
    const kb::TetGrid grid = kb::make_tet_grid({.cubes = 4});
    // A box of side 2, of which the points of the boundary are moved within its sides only. In
    // double precision of floats that are exactly on the sides: as good as exact.
    EXPECT_NEAR(enclosed_volume(faces_of(grid)), 8.0, 1e-9);
}

TEST(Faces, InvertedCellsHaveTheSameFaces)
{
    kb::TetGrid grid = kb::make_tet_grid({.cubes = 3, .sliver_share = 0.0F});
    const double volume = enclosed_volume(faces_of(grid));
    const std::size_t interior = faces_of(grid).interior_count;
    for (std::size_t i = 0; i < grid.cells.size(); i += 2)
        std::swap(grid.cells[i].x, grid.cells[i].y);
    const kb::FaceMesh mesh = faces_of(grid);
    EXPECT_EQ(mesh.interior_count, interior);
    EXPECT_DOUBLE_EQ(enclosed_volume(mesh), volume);
}

TEST(Faces, CellsWithoutVolumeHaveNone)
{
    kb::TetGrid grid = kb::test::two_cells();
    const kb::FaceMesh before = faces_of(grid);
    const auto cell = grid.cells.front();
    grid.cells.emplace_back(cell.x, cell.y, cell.z, cell.z);
    grid.cells.emplace_back(cell.x, cell.x, cell.x, cell.x);
    const kb::FaceMesh after = faces_of(grid);
    EXPECT_EQ(after.triangles, before.triangles);
    EXPECT_EQ(after.interior_count, before.interior_count);
}

TEST(Faces, TheSameCellTwiceHasABoundaryOnly)
{
    // Its faces are seen from the same side twice: there is nothing behind them that they share.
    kb::TetGrid grid = kb::test::two_cells();
    grid.cells = {grid.cells.front(), grid.cells.front()};
    const kb::FaceMesh mesh = faces_of(grid);
    EXPECT_EQ(mesh.interior_count, 0U);
    EXPECT_EQ(mesh.triangles.size(), 8U);
}

} // namespace
