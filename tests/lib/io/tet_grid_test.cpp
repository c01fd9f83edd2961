// SPDX-License-Identifier: MIT
//
// Tetrahedral grids: their check, their repair, and what the generated grid promises.

#include "lib/io/tet_grid.hpp"
#include "tests/lib/io/tet_grid_file.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <span>

namespace
{

using kb::test::two_cells;

constexpr std::array all_splits{kb::CubeSplit::five, kb::CubeSplit::six,
                                kb::CubeSplit::twenty_four};

kb::TetGrid make(kb::CubeSplit split, unsigned cubes, float jitter, float sliver_share)
{
    kb::GeneratedGrid wanted;
    wanted.split = split;
    wanted.cubes = cubes;
    wanted.jitter = jitter;
    wanted.sliver_share = sliver_share;
    return kb::make_tet_grid(wanted);
}

double volume_of(const kb::TetGrid &grid)
{
    double sum = 0.0;
    for (const glm::uvec4 &cell : grid.cells)
        sum += kb::signed_volume(grid, cell);
    return sum;
}

/// How many cells have each face.
std::map<std::array<std::uint32_t, 3>, int> faces_of(const kb::TetGrid &grid)
{
    std::map<std::array<std::uint32_t, 3>, int> faces;
    for (const glm::uvec4 &cell : grid.cells) {
        for (int without = 0; without < 4; ++without) {
            std::array<std::uint32_t, 3> face{cell[(without + 1) % 4], cell[(without + 2) % 4],
                                              cell[(without + 3) % 4]};
            std::ranges::sort(face);
            ++faces[face];
        }
    }
    return faces;
}

TEST(TetGrid, VolumeIsSigned)
{
    const kb::TetGrid grid = two_cells();
    EXPECT_DOUBLE_EQ(kb::signed_volume(grid, {0, 1, 2, 3}), 1.0 / 6.0);
    EXPECT_DOUBLE_EQ(kb::signed_volume(grid, {0, 2, 1, 3}), -1.0 / 6.0);
}

TEST(TetGrid, VolumeOfAFlatCellIsZeroWhateverItsRounding)
{
    // Two corners in one place, at coordinates whose differences have many digits.
    kb::TetGrid grid;
    grid.points = {{0.1F, 1e-5F, 7.3F}, {1e3F, 0.3F, -0.7F}, {-0.9F, 1.7e2F, 3e-3F}};
    for (const glm::uvec4 &cell :
         {glm::uvec4(0, 1, 2, 2), glm::uvec4(0, 1, 2, 1), glm::uvec4(0, 1, 1, 2),
          glm::uvec4(0, 0, 1, 2), glm::uvec4(0, 1, 2, 0), glm::uvec4(1, 1, 1, 1)})
        EXPECT_EQ(kb::signed_volume(grid, cell), 0.0);
    // One unit in the last place off the plane is a volume.
    grid.points = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0.25F, 0.25F, std::nextafter(1.0F, 2.0F)}};
    EXPECT_EQ(kb::signed_volume(grid, {0, 1, 2, 3}), 0x1p-23 / 6.0);
}

TEST(TetGrid, CheckNamesTheFirstFault)
{
    const auto message = [](const kb::TetGrid &grid) {
        const auto checked = kb::check_tet_grid(grid);
        return checked ? "" : checked.error().message;
    };
    EXPECT_EQ(message(two_cells()), "");
    kb::TetGrid grid = two_cells();
    grid.fields[1].values.pop_back();
    EXPECT_EQ(message(grid), "the field 'pressure' has 4 values, but there are 5 points");
    std::swap(grid.cells[0][0], grid.cells[0][1]);
    grid.fields.pop_back();
    EXPECT_EQ(message(grid), "cell 0 is inverted (--repair turns such cells)");
    grid.cells[1][3] = 7;
    EXPECT_EQ(message(grid), "cell 1 has point 7, but there are 5 points");
    grid.cells.clear();
    EXPECT_EQ(message(grid), "it has no cells");
}

TEST(TetGrid, PointsOfOnePlaceAndValueAreJoined)
{
    // Each cell has points of its own. At one point the second cell has another value of pressure,
    // and zero of the other sign.
    const kb::TetGrid whole = two_cells();
    kb::TetGrid grid;
    for (const kb::ScalarField &field : whole.fields)
        grid.fields.push_back({.name = field.name, .values = {}});
    for (const glm::uvec4 &cell : whole.cells) {
        const auto first = static_cast<std::uint32_t>(grid.points.size());
        grid.cells.emplace_back(first, first + 1, first + 2, first + 3);
        for (int corner = 0; corner < 4; ++corner) {
            grid.points.push_back(whole.points[cell[corner]]);
            for (std::size_t i = 0; i < grid.fields.size(); ++i)
                grid.fields[i].values.push_back(whole.fields[i].values[cell[corner]]);
        }
    }
    grid.points[4] = -grid.points[4];
    ASSERT_EQ(grid.points[4], grid.points[0]);
    grid.fields[1].values[4] += 1.0F;

    kb::TetGrid by_temperature = grid;
    EXPECT_EQ(kb::join_points(by_temperature, by_temperature.fields[0]), 3U);
    EXPECT_EQ(by_temperature.points, whole.points);
    EXPECT_EQ(by_temperature.cells, whole.cells);
    EXPECT_EQ(by_temperature.fields[0].values, whole.fields[0].values);
    kb::TetGrid by_pressure = grid;
    EXPECT_EQ(kb::join_points(by_pressure, by_pressure.fields[1]), 2U);
    EXPECT_EQ(by_pressure.points.size(), 6U);
    kb::TetGrid joined = whole;
    EXPECT_EQ(kb::join_points(joined, joined.fields[0]), 0U);
    EXPECT_EQ(joined.points, whole.points);
}

TEST(TetGrid, FitsIntoTheUnitSphere)
{
    kb::TetGrid grid = two_cells();
    const kb::BoundingSphere sphere = kb::fit_to_unit_sphere(grid);
    EXPECT_EQ(sphere.center, glm::vec3(0.5F, 0.5F, 0.0F));
    EXPECT_FLOAT_EQ(sphere.radius, std::sqrt(1.5F));
    float farthest = 0.0F;
    for (const glm::vec3 &p : grid.points)
        farthest = std::max(farthest, glm::length(p));
    EXPECT_FLOAT_EQ(farthest, 1.0F);
}

TEST(MakeTetGrid, FillsTheBoxWithCellsThatShareTheirFaces)
{
    for (const kb::CubeSplit split : all_splits) {
        const kb::TetGrid grid = make(split, 4, 0.2F, 0.3F);
        const auto checked = kb::check_tet_grid(grid);
        ASSERT_TRUE(checked) << checked.error().message;
        // Each cell's volume is rounded by less than 1e-14 of its determinant's terms.
        EXPECT_NEAR(volume_of(grid), 8.0, 1e-11);
        for (const auto &face : faces_of(grid)) {
            const auto on_side = [&](int axis, float side) {
                return std::ranges::all_of(face.first, [&, axis, side](std::uint32_t point) {
                    return grid.points[point][axis] == side;
                });
            };
            bool is_boundary = false;
            for (int axis = 0; axis < 3; ++axis)
                is_boundary = is_boundary || on_side(axis, -1.0F) || on_side(axis, 1.0F);
            ASSERT_EQ(face.second, is_boundary ? 1 : 2);
        }
    }
}

TEST(MakeTetGrid, CutsCubesInAsManyCellsAsAsked)
{
    for (const kb::CubeSplit split : all_splits)
        EXPECT_EQ(make(split, 3, 0.2F, 0.0F).cells.size(), 27 * static_cast<std::size_t>(split));
    // A sliver comes with three more cells in the place of one.
    const std::size_t with_slivers = make(kb::CubeSplit::six, 8, 0.2F, 0.25F).cells.size();
    EXPECT_NEAR(static_cast<double>(with_slivers), 3072 * 1.75, 3 * 5 * std::sqrt(3072 * 0.1875))
        << "five deviations of the number of slivers";
}

TEST(MakeTetGrid, MovesThePointsOfTheLattice)
{
    for (const kb::CubeSplit split : all_splits) {
        const kb::TetGrid still = make(split, 4, 0.0F, 0.0F);
        const kb::TetGrid moved = make(split, 4, 0.2F, 0.0F);
        ASSERT_EQ(still.points.size(), moved.points.size());
        std::size_t count = 0;
        for (std::size_t i = 0; i < still.points.size(); ++i) {
            count += still.points[i] != moved.points[i];
            for (int axis = 0; axis < 3; ++axis)
                ASSERT_LE(std::abs(still.points[i][axis] - moved.points[i][axis]), 0.1F);
        }
        // All but the eight corners of the box may move.
        EXPECT_GT(count, (still.points.size() - 8) * 9 / 10);
    }
}

TEST(MakeTetGrid, HasSliversOfEverySize)
{
    kb::GeneratedGrid wanted;
    wanted.cubes = 8;
    wanted.jitter = 0.0F;
    wanted.sliver_share = 0.5F;
    const kb::TetGrid grid = kb::make_tet_grid(wanted);
    // The smallest cell of a cube has a sixth of its volume, 1/64 here.
    const double whole = 1.0 / 64.0 / 6.0;
    std::array<int, 5> of_decade{};
    for (const glm::uvec4 &cell : grid.cells) {
        const double share = kb::signed_volume(grid, cell) / whole;
        for (std::size_t i = 0; i < of_decade.size(); ++i)
            of_decade[i] += share < std::pow(10.0, -1.0 - static_cast<double>(i));
    }
    EXPECT_GT(of_decade.front(), 500);
    EXPECT_GT(of_decade.back(), 100) << "thinner than 1e-5";
    EXPECT_TRUE(std::ranges::is_sorted(of_decade, std::greater()));
}

TEST(MakeTetGrid, SliversAreNoThinnerThanRoundingAllows)
{
    kb::GeneratedGrid wanted;
    wanted.cubes = 6;
    wanted.sliver_share = 0.5F;
    wanted.thinnest = 1e-20F;
    const auto checked = kb::check_tet_grid(kb::make_tet_grid(wanted));
    EXPECT_TRUE(checked) << checked.error().message;
}

TEST(MakeTetGrid, FieldsAreWhatTheyAreCalled)
{
    const kb::TetGrid grid = kb::make_tet_grid();
    const auto wave = kb::find_field(grid, "wave");
    const auto distance = kb::find_field(grid, "distance");
    ASSERT_TRUE(wave && distance);
    EXPECT_EQ(*wave, *kb::find_field(grid, "")) << "the first field";
    for (std::size_t i = 0; i < grid.points.size(); ++i) {
        EXPECT_EQ((*wave)->values[i], kb::generated_wave(grid.points[i]));
        EXPECT_EQ((*distance)->values[i], glm::length(grid.points[i]));
    }
    // The wave has a gradient everywhere: it grows along z.
    for (float x = -1.0F; x <= 1.0F; x += 0.25F)
        for (float z = -1.0F; z < 1.0F; z += 0.25F)
            EXPECT_GT(kb::generated_wave({x, -x, z + 0.25F}), kb::generated_wave({x, -x, z}));
}

TEST(MakeTetGrid, IsTheSameWheneverItIsMade)
{
    const kb::TetGrid first = kb::make_tet_grid();
    const kb::TetGrid second = kb::make_tet_grid();
    EXPECT_EQ(first.points, second.points);
    EXPECT_EQ(first.cells, second.cells);
    kb::GeneratedGrid other;
    other.seed = 2;
    EXPECT_NE(kb::make_tet_grid(other).points, first.points);
}

} // namespace
