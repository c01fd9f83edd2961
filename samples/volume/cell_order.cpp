// SPDX-License-Identifier: MIT

#include "volume/cell_order.hpp"

#include <algorithm>
#include <numeric>

namespace kb
{

CellOrder::CellOrder(const FaceMesh &mesh) : interior_count_(mesh.interior_count)
{
    std::uint32_t cells = 0;
    for (const glm::uvec2 &pair : mesh.cells) {
        for (int side = 0; side < 2; ++side) {
            if (pair[side] != FaceMesh::no_cell)
                cells = std::max(cells, pair[side] + 1);
        }
    }

    first_.resize(cells + 1);
    for (const glm::uvec2 &pair : mesh.cells) {
        for (int side = 0; side < 2; ++side) {
            if (pair[side] != FaceMesh::no_cell)
                ++first_[pair[side] + 1];
        }
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());

    faces_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end());
    for (std::uint32_t face = 0; face < mesh.cells.size(); ++face) {
        const glm::uvec2 &pair = mesh.cells[face];
        faces_[next[pair.x]++] = {face, pair.y, Seen::counterclockwise};
        if (pair.y != FaceMesh::no_cell)
            faces_[next[pair.y]++] = {face, pair.x, Seen::clockwise};
        if (pair.y == FaceMesh::no_cell)
            boundary_cells_.push_back(pair.x);
    }
}

std::span<const CellOrder::CellFace> CellOrder::faces_of(std::uint32_t cell) const
{
    return std::span(faces_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
}

/// A face is listed with the cell in front of it, an entry with the cell behind it.
void CellOrder::list(std::uint32_t cell, std::span<const Seen> seen,
                     std::vector<std::uint32_t> &order) const
{
    for (const CellFace &face : faces_of(cell)) {
        if (face.neighbor == FaceMesh::no_cell && seen[face.face] == face.outside)
            order.push_back(face.face);
    }
    for (const CellFace &face : faces_of(cell)) {
        if (seen[face.face] != Seen::never && seen[face.face] != face.outside)
            order.push_back(face.face);
    }
}

void CellOrder::visit(std::uint32_t cell, std::span<const Seen> seen,
                      std::vector<std::uint32_t> &order)
{
    if (visited_[cell])
        return;
    visited_[cell] = true;
    stack_.push_back({cell, first_[cell]});
    while (!stack_.empty()) {
        Visit &visit = stack_.back();
        if (visit.next == first_[visit.cell + 1]) {
            list(visit.cell, seen, order);
            stack_.pop_back();
            continue;
        }
        const CellFace &face = faces_[visit.next++];
        // One that is visited but not listed is in a cycle of cells, each in front of the next:
        // no order is right then.
        if (seen[face.face] == face.outside && face.neighbor != FaceMesh::no_cell &&
            !visited_[face.neighbor]) {
            visited_[face.neighbor] = true;
            stack_.push_back({face.neighbor, first_[face.neighbor]});
        }
    }
}

void CellOrder::sort(std::span<const Seen> seen, std::span<const std::uint32_t> exits,
                     std::vector<std::uint32_t> &order)
{
    order.clear();
    const auto cells = static_cast<std::uint32_t>(first_.size() - 1);
    visited_.assign(cells, false);
    // No ray ends in the grid, so that all cells that matter are in front of an exit.
    for (const std::uint32_t exit : exits)
        visit(boundary_cells_[exit - interior_count_], seen, order);
    // Rounding may make a face seem to be seen whose neighbors are not.
    for (std::uint32_t cell = 0; cell < cells; ++cell)
        visit(cell, seen, order);
}

} // namespace kb
