// SPDX-License-Identifier: MIT

#include "volume/cell_clusters.hpp"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

namespace kb
{

namespace
{

constexpr auto no_cell = FaceMesh::no_cell;

/// Of the deviation that a cluster's first cell allows: the rest is for neighbors that allow less.
constexpr double usable_share = 0.75;

/// Of the scalars of a cluster in which they go linearly: the table of segments is made for small
/// differences, as those in cells are.
constexpr double most_extent = 1.0 / 8.0;

/// A linear function of place.
struct Linear {
    glm::dvec3 origin;
    double value; ///< At the origin.
    glm::dvec3 gradient;

    double at(glm::dvec3 p) const { return value + glm::dot(gradient, p - origin); }
};

struct Interval {
    double low;
    double high;
};

Interval hull(Interval a, Interval b)
{
    return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

class Clustering
{
public:
    Clustering(const TetGrid &grid, const FaceMesh &mesh, ScalarRange range,
               const ColorTolerance &tolerance)
        : grid_(&grid), tolerance_(&tolerance),
          neighbors_(grid.cells.size(), {no_cell, no_cell, no_cell, no_cell}),
          clusters_{std::vector(grid.cells.size(), no_cell)}
    {
        const double extent = double(range.high) - double(range.low);
        for (const float value : mesh.scalars)
            scalars_.push_back((double(value) - double(range.low)) / extent);
        for (std::size_t i = 0; i < mesh.interior_count; ++i) {
            add_neighbor(mesh.cells[i].x, mesh.cells[i].y);
            add_neighbor(mesh.cells[i].y, mesh.cells[i].x);
        }
    }

    void grow_from(std::uint32_t seed)
    {
        if (clusters_.of_cells[seed] != no_cell)
            return;
        Interval scalars = scalars_of(seed);
        if (tolerance_->allows(scalars.low, scalars.high))
            grow(seed, [&](std::uint32_t cell) { return widen(scalars, scalars_of(cell)); });
        else
            grow_linear(seed, scalars);
        ++clusters_.count;
    }

    CellClusters finish() && { return std::move(clusters_); }

private:
    /// A cell has four faces, so no more neighbors.
    void add_neighbor(std::uint32_t cell, std::uint32_t neighbor)
    {
        *std::find(neighbors_[cell].begin(), neighbors_[cell].end(), no_cell) = neighbor;
    }

    Interval scalars_of(std::uint32_t cell) const
    {
        const glm::uvec4 &c = grid_->cells[cell];
        const auto [low, high] =
            std::minmax({scalars_[c.x], scalars_[c.y], scalars_[c.z], scalars_[c.w]});
        return {low, high};
    }

    bool widen(Interval &scalars, Interval more) const
    {
        const Interval both = hull(scalars, more);
        const bool allowed = tolerance_->allows(both.low, both.high);
        if (allowed)
            scalars = both;
        return allowed;
    }

    void grow_linear(std::uint32_t seed, Interval scalars)
    {
        const double extent = std::max(scalars.high - scalars.low, most_extent);
        const Linear linear = linear_of(seed);
        const double deviation =
            usable_share * tolerance_->most_deviation(scalars.low, scalars.high);
        grow(seed, [&](std::uint32_t cell) {
            const Interval own = scalars_of(cell);
            const Interval both = hull(scalars, own);
            if (both.high - both.low > extent || !is_near(linear, cell, 0.5 * deviation) ||
                !tolerance_->allows_deviation(own.low, own.high, deviation))
                return false;
            scalars = both;
            return true;
        });
    }

    Linear linear_of(std::uint32_t cell) const
    {
        const glm::uvec4 &c = grid_->cells[cell];
        const glm::dvec3 origin(grid_->points[c.x]);
        const glm::dmat3 edges(glm::dvec3(grid_->points[c.y]) - origin,
                               glm::dvec3(grid_->points[c.z]) - origin,
                               glm::dvec3(grid_->points[c.w]) - origin);
        const double value = scalars_[c.x];
        const glm::dvec3 rises(scalars_[c.y] - value, scalars_[c.z] - value, scalars_[c.w] - value);
        return {origin, value, rises * glm::inverse(edges)};
    }

    /// Not if the function is not finite.
    bool is_near(const Linear &linear, std::uint32_t cell, double distance) const
    {
        const glm::uvec4 &c = grid_->cells[cell];
        for (int i = 0; i < 4; ++i) {
            const double value = linear.at(glm::dvec3(grid_->points[c[i]]));
            if (!(std::abs(value - scalars_[c[i]]) <= distance))
                return false;
        }
        return true;
    }

    /// Adds cells by the number of faces between them and the seed. The seed is in its cluster
    /// whether it fits or not; if not, it stays alone.
    template <typename Fits>
    void grow(std::uint32_t seed, Fits fits)
    {
        clusters_.of_cells[seed] = clusters_.count;
        if (!fits(seed))
            return;
        members_.assign(1, seed);
        for (std::size_t i = 0; i < members_.size(); ++i) {
            for (const std::uint32_t neighbor : neighbors_[members_[i]]) {
                if (neighbor == no_cell || clusters_.of_cells[neighbor] != no_cell ||
                    !fits(neighbor))
                    continue;
                clusters_.of_cells[neighbor] = clusters_.count;
                members_.push_back(neighbor);
            }
        }
    }

    const TetGrid *grid_;
    const ColorTolerance *tolerance_;
    std::vector<double> scalars_; ///< Of the points, from 0 to 1 over the range.
    std::vector<std::array<std::uint32_t, 4>> neighbors_;
    CellClusters clusters_;
    std::vector<std::uint32_t> members_; ///< Of the cluster that grows.
};

} // namespace

CellClusters cluster_cells(const TetGrid &grid, const FaceMesh &mesh, ScalarRange range,
                           const ColorTolerance &tolerance)
{
    std::vector<double> volumes;
    for (const glm::uvec4 &cell : grid.cells)
        volumes.push_back(std::abs(signed_volume(grid, cell)));
    std::vector<std::uint32_t> seeds(grid.cells.size());
    std::iota(seeds.begin(), seeds.end(), 0U);
    std::stable_sort(seeds.begin(), seeds.end(), [&volumes](std::uint32_t a, std::uint32_t b) {
        return volumes[a] > volumes[b];
    });
    Clustering clustering(grid, mesh, range, tolerance);
    for (const std::uint32_t seed : seeds)
        clustering.grow_from(seed);
    return std::move(clustering).finish();
}

} // namespace kb
