// SPDX-License-Identifier: MIT

#pragma once

#include "volume/color_tolerance.hpp"
#include "volume/faces.hpp"

#include <cstdint>
#include <vector>

namespace kb
{

/// A partition of the cells of a grid.
struct CellClusters {
    std::vector<std::uint32_t> of_cells; ///< For each cell, its cluster: from 0.
    std::uint32_t count = 0;

    bool join(std::uint32_t a, std::uint32_t b) const { return of_cells[a] == of_cells[b]; }
};

/// Joins cells that share faces as long as a ray's way through a cluster may be one segment, along
/// which the scalar goes linearly: either any scalars of the cluster may stand for any others of
/// it, or all are so near to one linear function of place that being off by twice as much is
/// allowed (once for the ends of the segment, once for what is between them); such a cluster has no
/// more than an eighth of the range of scalars, unless one cell has. Clusters grow from the largest
/// cells that are left, in linear time after the sorting of cells by size.
///
/// `mesh` has the faces of the grid; its scalars are divided by `range`.
CellClusters cluster_cells(const TetGrid &grid, const FaceMesh &mesh, ScalarRange range,
                           const ColorTolerance &tolerance);

} // namespace kb
