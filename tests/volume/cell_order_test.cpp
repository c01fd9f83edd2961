// SPDX-License-Identifier: MIT

#include "volume/cell_order.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/type_precision.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace
{

/// Twice the area of a face times how far a point is in front of it.
double in_front(const kb::FaceMesh &mesh, std::size_t face, glm::dvec3 point)
{
    const glm::uvec3 &triangle = mesh.triangles[face];
    const glm::dvec3 a(mesh.positions[triangle.x]);
    const glm::dvec3 normal = glm::cross(glm::dvec3(mesh.positions[triangle.y]) - a,
                                         glm::dvec3(mesh.positions[triangle.z]) - a);
    return glm::dot(normal, point - a);
}

std::vector<kb::Seen> see_all(const kb::FaceMesh &mesh, glm::dvec3 eye)
{
    std::vector<kb::Seen> seen;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        seen.push_back(in_front(mesh, i, eye) > 0.0 ? kb::Seen::counterclockwise
                                                    : kb::Seen::clockwise);
    return seen;
}

/// The boundary faces that are seen from inside; which is first does not matter in a convex grid.
std::vector<std::uint32_t> exits_of(const kb::FaceMesh &mesh, const std::vector<kb::Seen> &seen)
{
    std::vector<std::uint32_t> exits;
    for (auto i = static_cast<std::uint32_t>(mesh.interior_count); i < seen.size(); ++i) {
        if (seen[i] == kb::Seen::clockwise)
            exits.push_back(i);
    }
    return exits;
}

std::vector<std::size_t> places_of(const std::vector<std::uint32_t> &order, std::size_t faces)
{
    std::vector<std::size_t> places(faces, order.size());
    for (std::size_t place = 0; place < order.size(); ++place)
        places[order[place]] = place;
    return places;
}

kb::FaceMesh make_faces(const kb::GeneratedGrid &wanted)
{
    const kb::TetGrid grid = kb::make_tet_grid(wanted);
    return kb::make_face_mesh(grid, grid.fields.front());
}

/// Of each cell, that its front faces come before its back faces: then so do all fragments.
void expect_in_order(const kb::FaceMesh &mesh, const std::vector<kb::Seen> &seen,
                     const std::vector<std::uint32_t> &order)
{
    const auto places = places_of(order, mesh.triangles.size());
    std::vector<std::size_t> last_front;
    std::vector<std::size_t> first_back;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (int side = 0; side < 2; ++side) {
            const std::uint32_t cell = mesh.cells[i][side];
            if (cell == kb::FaceMesh::no_cell || seen[i] == kb::Seen::never)
                continue;
            if (cell >= last_front.size()) {
                last_front.resize(cell + 1, 0);
                first_back.resize(cell + 1, order.size());
            }
            const bool front = (seen[i] == kb::Seen::counterclockwise) == (side == 0);
            if (front)
                last_front[cell] = std::max(last_front[cell], places[i]);
            else
                first_back[cell] = std::min(first_back[cell], places[i]);
        }
    }
    for (std::size_t cell = 0; cell < last_front.size(); ++cell)
        EXPECT_LE(last_front[cell], first_back[cell]) << "cell " << cell;
}

TEST(FaceMesh, KnowsTheCellsOfItsFaces)
{
    const kb::TetGrid grid = kb::make_tet_grid({.cubes = 3});
    const kb::FaceMesh mesh = kb::make_face_mesh(grid, grid.fields.front());
    ASSERT_EQ(mesh.cells.size(), mesh.triangles.size());
    std::vector<int> faces(grid.cells.size());
    const auto middle = [&grid](std::uint32_t cell) {
        glm::dvec3 sum(0.0);
        for (int i = 0; i < 4; ++i)
            sum += glm::dvec3(grid.points[grid.cells[cell][i]]);
        return sum / 4.0;
    };
    for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
        const auto [inside, outside] = std::pair(mesh.cells[i].x, mesh.cells[i].y);
        ASSERT_LT(inside, grid.cells.size());
        ++faces[inside];
        EXPECT_LT(in_front(mesh, i, middle(inside)), 0.0);
        EXPECT_EQ(outside == kb::FaceMesh::no_cell, i >= mesh.interior_count);
        if (outside == kb::FaceMesh::no_cell)
            continue;
        ASSERT_LT(outside, grid.cells.size());
        ++faces[outside];
        EXPECT_GT(in_front(mesh, i, middle(outside)), 0.0);
    }
    EXPECT_TRUE(std::ranges::all_of(faces, [](int count) { return count == 4; }));
}

TEST(CellOrder, PutsTheFrontFacesOfEachCellBeforeItsBackFaces)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
    for (const auto split : {kb::CubeSplit::five, kb::CubeSplit::six, kb::CubeSplit::twenty_four}) {
        const kb::FaceMesh mesh = make_faces({.cubes = 4, .split = split});
        kb::CellOrder cell_order(mesh);
        for (int i = 0; i < 10; ++i) {
            const glm::dvec3 eye =
                3.0 * glm::normalize(
                          glm::dvec3(coordinate(random), coordinate(random), coordinate(random)));
            const auto seen = see_all(mesh, eye);
            std::vector<std::uint32_t> order;
            cell_order.sort(seen, exits_of(mesh, seen), order);
            EXPECT_EQ(order.size(), mesh.triangles.size());
            expect_in_order(mesh, seen, order);
            std::ranges::sort(order);
            EXPECT_EQ(std::ranges::adjacent_find(order), order.end()) << "each face once";
        }
    }
}

TEST(CellOrder, WorksFromInside)
{
    const kb::FaceMesh mesh = make_faces({.cubes = 4});
    const auto seen = see_all(mesh, {0.11, 0.23, -0.31});
    std::vector<std::uint32_t> order;
    kb::CellOrder(mesh).sort(seen, exits_of(mesh, seen), order);
    expect_in_order(mesh, seen, order);
}

TEST(CellOrder, LeavesOutWhatIsNotSeen)
{
    const kb::FaceMesh mesh = make_faces({.cubes = 2});
    auto seen = see_all(mesh, {0.3, 0.2, 5.0});
    for (std::size_t i = 0; i < seen.size(); i += 3)
        seen[i] = kb::Seen::never;
    std::vector<std::uint32_t> order;
    kb::CellOrder(mesh).sort(seen, exits_of(mesh, seen), order);
    const auto places = places_of(order, seen.size());
    for (std::size_t i = 0; i < seen.size(); ++i)
        EXPECT_EQ(places[i] < order.size(), seen[i] != kb::Seen::never);
}

TEST(CellOrder, TakesPartsThatDoNotTouchByTheirExits)
{
    // Two cells behind one another, the far one first in the grid.
    kb::TetGrid grid;
    for (const float z : {-2.0F, 0.0F}) {
        const auto first = static_cast<std::uint32_t>(grid.points.size());
        for (const glm::vec3 &point :
             {glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1)})
            grid.points.push_back(point + glm::vec3(0, 0, z));
        grid.cells.push_back(glm::uvec4(0, 1, 2, 3) + first);
    }
    const kb::ScalarField field{"one", std::vector<float>(grid.points.size(), 1.0F)};
    const kb::FaceMesh mesh = kb::make_face_mesh(grid, field);
    const auto seen = see_all(mesh, {0.2, 0.2, 9.0});
    auto exits = exits_of(mesh, seen);
    std::ranges::sort(exits, {}, [&mesh](std::uint32_t face) {
        return -mesh.positions[mesh.triangles[face].x].z;
    });
    std::vector<std::uint32_t> order;
    kb::CellOrder(mesh).sort(seen, exits, order);
    ASSERT_EQ(order.size(), 8U);
    for (std::size_t place = 0; place < order.size(); ++place)
        EXPECT_EQ(mesh.cells[order[place]].x, place < 4 ? 1U : 0U);
}

TEST(CellOrder, EndsWhereCellsAreInFrontOfEachOtherInACircle)
{
    // Three cells by name only: 0 in front of 1 in front of 2 in front of 0.
    kb::FaceMesh mesh;
    mesh.cells = {{1, 0}, {2, 1}, {0, 2}, {1, kb::FaceMesh::no_cell}};
    mesh.triangles.resize(4);
    mesh.interior_count = 3;
    const std::vector<kb::Seen> seen{kb::Seen::counterclockwise, kb::Seen::counterclockwise,
                                     kb::Seen::counterclockwise, kb::Seen::clockwise};
    std::vector<std::uint32_t> order;
    kb::CellOrder(mesh).sort(seen, std::vector<std::uint32_t>{3}, order);
    std::ranges::sort(order);
    EXPECT_EQ(order, (std::vector<std::uint32_t>{0, 1, 2, 3}));
}

} // namespace
