// SPDX-License-Identifier: MIT
//
// Clusters of cells along rays, whose segments are the integrator's.

#include "volume/cell_clusters.hpp"
#include "volume/sorted_faces.hpp"

#include "tests/integrator/ray_segments.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace
{

using kb::CellClusters;
using kb::ColorTolerance;

kb::TransferFunction haze()
{
    return *kb::find_transfer_function("haze");
}

kb::TransferFunction shells()
{
    return *kb::find_transfer_function("shells");
}

/// So thin that whole cells are alike.
kb::TransferFunction mist()
{
    return *kb::parse_transfer_function("0 0 0 1 0.1\n1 1 0 0 0.6", {});
}

struct Grid {
    explicit Grid(kb::TetGrid made, std::string_view field = {})
        : grid(std::move(made)), faces(kb::make_face_mesh(grid, **kb::find_field(grid, field))),
          range(kb::range_of(faces.scalars))
    {
    }

    CellClusters join(const kb::TransferFunction &transfer, double tolerance) const
    {
        return kb::cluster_cells(grid, faces, range, ColorTolerance(transfer, tolerance));
    }

    float normalized(std::uint32_t point) const
    {
        return (faces.scalars[point] - range.low) / (range.high - range.low);
    }

    /// Of the scalars of each cluster.
    std::vector<std::pair<double, double>> extents(const CellClusters &clusters) const
    {
        std::vector<std::pair<double, double>> found(clusters.count, {1.0, 0.0});
        for (std::size_t i = 0; i < grid.cells.size(); ++i) {
            auto &[low, high] = found[clusters.of_cells[i]];
            for (int corner = 0; corner < 4; ++corner) {
                const double scalar = normalized(grid.cells[i][corner]);
                low = std::min(low, scalar);
                high = std::max(high, scalar);
            }
        }
        return found;
    }

    kb::TetGrid grid;
    kb::FaceMesh faces;
    kb::ScalarRange range;
};

/// The generated grid with a field of one's own.
template <typename Function>
Grid with_field(unsigned cubes, Function function)
{
    kb::TetGrid grid = kb::make_tet_grid({.cubes = cubes});
    grid.fields = {{"own", {}}};
    for (const glm::vec3 p : grid.points)
        grid.fields.front().values.push_back(function(p));
    return Grid(std::move(grid));
}

/// A scalar on a ray, and what is there if the ray goes through the cluster in one segment.
struct Replaced {
    double right;
    double drawn;
};

using Ray = std::vector<kb::integrator::RaySegment>;

/// On all faces within clusters.
std::vector<Replaced> replaced_scalars(std::span<const Ray> rays, const CellClusters &clusters)
{
    std::vector<Replaced> scalars;
    for (const Ray &ray : rays) {
        for (auto first = ray.begin(); first != ray.end();) {
            const auto last = std::find_if(first, ray.end(), [&](const auto &segment) {
                return clusters.of_cells[segment.cell] != clusters.of_cells[first->cell];
            });
            const auto &end = *std::prev(last);
            for (auto inner = first; inner != std::prev(last); ++inner)
                scalars.push_back(
                    {inner->scalar_back,
                     std::lerp(first->scalar_front, end.scalar_back,
                               (inner->back - first->front) / (end.back - first->front))});
            first = last;
        }
    }
    return scalars;
}

/// Of what is allowed: more than 1 is too much.
double share_used(const kb::TransferFunction &transfer, double tolerance, const Replaced &scalar)
{
    const kb::TransferPoint right = transfer.at(static_cast<float>(scalar.right));
    const kb::TransferPoint drawn = transfer.at(static_cast<float>(scalar.drawn));
    double off = 0.0;
    for (int c = 0; c < 3; ++c) {
        const auto light = [c](const kb::TransferPoint &point, double behind) {
            return point.extinction * (point.color[c] - behind);
        };
        for (const double behind : {0.0, 1.0})
            off = std::max(off, std::abs(light(drawn, behind) - light(right, behind)));
    }
    return off / (0.5 * tolerance * (0.5 + right.extinction));
}

TEST(CellClusters, AlongRaysNoScalarIsOffByMoreThanIsAllowed)
{
    Grid made(kb::make_tet_grid({.cubes = 8}), "wave");
    kb::fit_to_unit_sphere(made.grid);
    std::vector<float> scalars;
    for (std::uint32_t i = 0; i < made.grid.points.size(); ++i)
        scalars.push_back(made.normalized(i));
    kb::OrbitCamera camera;
    camera.azimuth = 33.0F;
    camera.elevation = 21.0F;
    const kb::Size size{60, 60};
    const auto rays = kb::integrator::RaySegments({made.grid.points, made.grid.cells, scalars},
                                                  kb::integrator::make_view(camera, size))
                          .find(0, size.height);

    int number = 0;
    for (const kb::TransferFunction &transfer : {haze(), shells(), mist()}) {
        ++number;
        for (const double tolerance : {0.05, 0.5}) {
            SCOPED_TRACE(testing::Message() << "function " << number << ", " << tolerance);
            const CellClusters clusters = made.join(transfer, tolerance);
            const std::vector<Replaced> scalars = replaced_scalars(rays, clusters);
            double worst = 0.0;
            for (const Replaced &scalar : scalars)
                worst = std::max(worst, share_used(transfer, tolerance, scalar));
            EXPECT_GT(scalars.size(), 500U) << "segments go through more than one cell";
            EXPECT_LE(worst, 1.0);
            EXPECT_GE(worst, 0.05) << "or nothing would be tested";
        }
    }
}

TEST(CellClusters, AConstantFieldIsOneCluster)
{
    EXPECT_EQ(with_field(4, [](glm::vec3) { return 3.0F; }).join(haze(), 0.0).count, 1U);
}

TEST(CellClusters, OfALinearFieldAreEighthsOfItsRange)
{
    const Grid made = with_field(24, [](glm::vec3 p) { return p.x; });
    const CellClusters clusters = made.join(haze(), 0.01);
    EXPECT_LT(clusters.count, made.grid.cells.size() / 20);
    for (const auto &[low, high] : made.extents(clusters))
        EXPECT_LE(high - low, 1.0 / 8.0);
}

TEST(CellClusters, WithoutToleranceOnlyWhatDoesNotShowIsJoined)
{
    const Grid made = with_field(8, [](glm::vec3 p) { return glm::dot(p, p); });
    const CellClusters clusters = made.join(shells(), 0.0);
    std::size_t joined = 0;
    for (std::size_t i = 0; i < made.faces.interior_count; ++i) {
        const glm::uvec2 &pair = made.faces.cells[i];
        if (clusters.of_cells[pair.x] != clusters.of_cells[pair.y])
            continue;
        ++joined;
        for (int side = 0; side < 2; ++side) {
            for (int corner = 0; corner < 4; ++corner) {
                const float value = made.normalized(made.grid.cells[pair[side]][corner]);
                EXPECT_EQ(shells().at(value).extinction, 0.0F) << value;
            }
        }
    }
    EXPECT_GT(joined, made.faces.interior_count / 20);
}

TEST(CellClusters, OfAlikeCellsAnyScalarMayStandForAnyOther)
{
    // From left to right there is more than what is alike; there is not in any cell.
    std::mt19937 random(7);
    const Grid made = with_field(8, [&random](glm::vec3 p) {
        return 4.0F * p.x + std::uniform_real_distribution<float>()(random);
    });
    const ColorTolerance tolerance(mist(), 1.5);
    const CellClusters clusters = made.join(mist(), 1.5);
    for (const auto &[low, high] : made.extents(clusters))
        EXPECT_TRUE(tolerance.allows(low, high)) << low << " to " << high;
    EXPECT_LT(clusters.count, made.grid.cells.size() / 2);
}

TEST(CellClusters, FacesAreInnerIfTheirCellsAreOfOneCluster)
{
    const Grid made(kb::make_tet_grid({.cubes = 6}), "wave");
    const CellClusters clusters = made.join(haze(), 0.2);
    const kb::FaceMesh marked = kb::mark_inner_faces(
        made.faces, [&clusters](auto a, auto b) { return clusters.join(a, b); });
    EXPECT_EQ(marked.triangles.size(), made.faces.triangles.size());
    EXPECT_GT(marked.inner_count, marked.triangles.size() / 10);
    const std::size_t boundary = made.faces.triangles.size() - made.faces.interior_count;
    EXPECT_EQ(marked.drawn_count() - marked.interior_count, boundary);
    for (std::size_t i = 0; i < marked.triangles.size(); ++i) {
        const glm::uvec2 &pair = marked.cells[i];
        EXPECT_EQ(pair.y == kb::FaceMesh::no_cell,
                  i >= marked.interior_count && i < marked.drawn_count());
        if (pair.y != kb::FaceMesh::no_cell) {
            EXPECT_EQ(clusters.of_cells[pair.x] == clusters.of_cells[pair.y],
                      i >= marked.drawn_count());
        }
    }
}

TEST(CellClusters, HoldTogether)
{
    const Grid made(kb::make_tet_grid({.cubes = 6}), "wave");
    const CellClusters clusters = made.join(haze(), 0.2);
    // Cells that faces lead to from the first of their cluster.
    std::vector<std::uint32_t> root(made.grid.cells.size());
    for (std::uint32_t i = 0; i < root.size(); ++i)
        root[i] = i;
    const auto find = [&root](std::uint32_t cell) {
        while (root[cell] != cell)
            cell = root[cell];
        return cell;
    };
    for (std::size_t i = 0; i < made.faces.interior_count; ++i) {
        const glm::uvec2 &pair = made.faces.cells[i];
        if (clusters.of_cells[pair.x] == clusters.of_cells[pair.y])
            root[find(pair.x)] = find(pair.y);
    }
    std::uint32_t roots = 0;
    for (std::uint32_t i = 0; i < root.size(); ++i)
        roots += root[i] == i ? 1 : 0;
    EXPECT_EQ(roots, clusters.count);
}

} // namespace
