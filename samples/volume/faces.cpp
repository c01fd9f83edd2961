// SPDX-License-Identifier: MIT

#include "volume/faces.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <tuple>
#include <utility>

namespace kb
{

namespace
{

/// A face as one of its cells has it: counterclockwise seen from outside of the cell.
struct CellFace {
    std::array<std::uint32_t, 3> key; ///< The points in ascending order.
    glm::uvec3 triangle;
    bool even; ///< Whether the triangle is an even permutation of the key.
    std::uint32_t cell;

    friend bool operator<(const CellFace &a, const CellFace &b)
    {
        return std::tie(a.key, a.even) < std::tie(b.key, b.even);
    }
};

CellFace make_face(std::uint32_t cell, std::uint32_t a, std::uint32_t b, std::uint32_t c)
{
    CellFace face{{a, b, c}, {a, b, c}, true, cell};
    auto &key = face.key;
    for (const auto &[i, j] : {std::pair{0, 1}, std::pair{1, 2}, std::pair{0, 1}}) {
        if (key[std::size_t(i)] > key[std::size_t(j)]) {
            std::swap(key[std::size_t(i)], key[std::size_t(j)]);
            face.even = !face.even;
        }
    }
    return face;
}

std::vector<CellFace> faces_of_cells(const TetGrid &grid)
{
    std::vector<CellFace> faces;
    faces.reserve(4 * grid.cells.size());
    for (std::uint32_t i = 0; i < grid.cells.size(); ++i) {
        const glm::uvec4 &cell = grid.cells[i];
        const double volume = signed_volume(grid, cell);
        if (volume == 0.0)
            continue;
        auto [a, b, c, d] = std::array{cell.x, cell.y, cell.z, cell.w};
        if (volume < 0.0)
            std::swap(a, b);
        faces.push_back(make_face(i, a, c, b));
        faces.push_back(make_face(i, a, b, d));
        faces.push_back(make_face(i, b, c, d));
        faces.push_back(make_face(i, a, d, c));
    }
    return faces;
}

} // namespace

FaceMesh make_face_mesh(const TetGrid &grid, const ScalarField &field)
{
    std::vector<CellFace> faces = faces_of_cells(grid);
    std::sort(faces.begin(), faces.end());

    FaceMesh mesh{grid.points, field.values, {}, 0, 0, {}};
    std::vector<CellFace> boundary;
    for (auto first = faces.begin(); first != faces.end();) {
        const auto last = std::find_if(
            first, faces.end(), [first](const CellFace &face) { return face.key != first->key; });
        const auto even = std::find_if(first, last, [](const CellFace &face) { return face.even; });
        // Those seen from one side, then those seen from the other: as many pairs as there are.
        const auto pairs = std::min(even - first, last - even);
        for (auto face = first, other = even; face != first + pairs; ++face, ++other) {
            mesh.triangles.push_back(face->triangle);
            mesh.cells.emplace_back(face->cell, other->cell);
        }
        boundary.insert(boundary.end(), first + pairs, even);
        boundary.insert(boundary.end(), even + pairs, last);
        first = last;
    }
    mesh.interior_count = mesh.triangles.size();
    for (const CellFace &face : boundary) {
        mesh.triangles.push_back(face.triangle);
        mesh.cells.emplace_back(face.cell, FaceMesh::no_cell);
    }
    return mesh;
}

FaceMesh mark_inner_faces(const FaceMesh &mesh,
                          const std::function<bool(std::uint32_t, std::uint32_t)> &look_as_one)
{
    FaceMesh marked{mesh.positions, mesh.scalars, {}, 0, 0, {}};
    std::vector<std::size_t> inner;
    const auto add = [&](std::size_t face) {
        marked.triangles.push_back(mesh.triangles[face]);
        marked.cells.push_back(mesh.cells[face]);
    };
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const glm::uvec2 &pair = mesh.cells[i];
        if (pair.y != FaceMesh::no_cell && look_as_one(pair.x, pair.y))
            inner.push_back(i);
        else
            add(i);
    }
    marked.interior_count = mesh.interior_count - inner.size();
    marked.inner_count = inner.size();
    std::ranges::for_each(inner, add);
    return marked;
}

} // namespace kb
