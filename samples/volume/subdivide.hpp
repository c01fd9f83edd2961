// SPDX-License-Identifier: MIT

#pragma once

#include "volume/faces.hpp"

namespace kb
{

/// Which triangle is split next.
enum class SplitFirst {
    longest, ///< That with the longest edge: how far a fragment can be from the centroid.
    thinnest ///< That with the largest ratio of its longest to its shortest edge.
};

/// Splits triangles until there are `budget` times as many, rounded down, so that their centroids
/// say more about the depth of their fragments. A triangle is split from a new vertex on its
/// longest edge, as far from the end where the shortest edge meets it as that is long, but no
/// farther than the middle: what is long and thin becomes a piece that is not, and a rest. Pieces
/// are split again as the others are.
///
/// Surfaces and the scalar on them stay what they are. Pieces take the place of their triangle.
/// There are fewer of them only when no triangle is left that floats can split.
FaceMesh subdivide(const FaceMesh &mesh, double budget, SplitFirst first = SplitFirst::longest);

} // namespace kb
