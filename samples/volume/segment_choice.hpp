// SPDX-License-Identifier: MIT

#pragma once

#include "lib/io/tet_grid.hpp"
#include "volume/cell_clusters.hpp"
#include "volume/segment_lookup.hpp"
#include "volume/transfer_function.hpp"

#include <cstddef>
#include <span>

namespace kb
{

/// A lookup, and what colors are off by along the rays that were tried: 0 to 1.
struct SegmentChoice {
    SegmentLookup lookup;
    double error = 0.0;
    std::size_t rays = 0;
};

/// The cheapest lookup that is right for a grid and a transfer function: the one for small cells if
/// no ray is off by more than 1/255, else the fewest parts with which none is off by a quarter of
/// that; if there are none, about the best there is. Half of the rays go through the cells that the
/// most can go wrong in, as they are large and much changes in them, in many directions; half
/// through any cells. Errors are those of the color in front of any background, with the order of
/// fragments right.
///
/// `values` has one scalar a point of the grid, which is in the unit sphere. A ray's way through a
/// cluster is one segment; without clusters its way through each cell is one.
SegmentChoice choose_lookup(const TetGrid &grid, std::span<const float> values, ScalarRange range,
                            const TransferFunction &transfer, const CellClusters *clusters);

} // namespace kb
