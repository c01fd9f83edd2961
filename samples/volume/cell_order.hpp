// SPDX-License-Identifier: MIT

#pragma once

#include "volume/faces.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace kb
{

/// How the eye sees a face.
enum class Seen : std::uint8_t {
    never, ///< It covers no pixel, and does not matter.
    counterclockwise,
    clockwise
};

/// Puts faces in depth order by the cells between them, instead of by depths: of two cells that
/// share a face the one on the eye's side of it comes first. A search from each cell through its
/// front faces, depth first, that lists a cell after all those in front of it, takes linear time
/// (Williams, Visibility Ordering Meshed Polyhedra, 1992: MPVO). The order is right as long as no
/// ray leaves the grid and comes back; where rays do, it is as good as the order of the faces by
/// which they leave.
class CellOrder
{
public:
    explicit CellOrder(const FaceMesh &mesh);

    /// Lists all faces that are seen, front to back. `exits` are those by which rays leave the
    /// grid, by their depth.
    void sort(std::span<const Seen> seen, std::span<const std::uint32_t> exits,
              std::vector<std::uint32_t> &order);

private:
    /// A face of a cell. It is in front of the cell if the eye sees it as from outside.
    struct CellFace {
        std::uint32_t face;
        std::uint32_t neighbor; ///< Or FaceMesh::no_cell.
        Seen outside;           ///< How it is seen from there.
    };

    std::span<const CellFace> faces_of(std::uint32_t cell) const;
    void visit(std::uint32_t cell, std::span<const Seen> seen, std::vector<std::uint32_t> &order);
    void list(std::uint32_t cell, std::span<const Seen> seen,
              std::vector<std::uint32_t> &order) const;

    std::vector<CellFace> faces_;      ///< Of cell 0, of cell 1, ...
    std::vector<std::uint32_t> first_; ///< In faces_, for each cell, and the end.
    std::size_t interior_count_;
    std::vector<std::uint32_t> boundary_cells_; ///< Of the faces behind the interior ones.
    std::vector<bool> visited_;
    struct Visit {
        std::uint32_t cell;
        std::uint32_t next; ///< In faces_: what is to be looked at.
    };
    std::vector<Visit> stack_;
};

} // namespace kb
