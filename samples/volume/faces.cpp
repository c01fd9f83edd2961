// SPDX-License-Identifier: MIT

#include "faces.hpp"

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

    friend bool operator<(const CellFace &a, const CellFace &b)
    {
        return std::tie(a.key, a.even) < std::tie(b.key, b.even);
    }
};

CellFace make_face(std::uint32_t a, std::uint32_t b, std::uint32_t c)
{
    CellFace face{{a, b, c}, {a, b, c}, true};
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
    for (const glm::uvec4 &cell : grid.cells) {
        const double volume = signed_volume(grid, cell);
        if (volume == 0.0)
            continue;
        auto [a, b, c, d] = std::array{cell.x, cell.y, cell.z, cell.w};
        if (volume < 0.0)
            std::swap(a, b);
        faces.push_back(make_face(a, c, b));
        faces.push_back(make_face(a, b, d));
        faces.push_back(make_face(b, c, d));
        faces.push_back(make_face(a, d, c));
    }
    return faces;
}

} // namespace

FaceMesh make_face_mesh(const TetGrid &grid, const ScalarField &field)
{
    std::vector<CellFace> faces = faces_of_cells(grid);
    std::sort(faces.begin(), faces.end());

    FaceMesh mesh{grid.points, field.values, {}, 0};
    std::vector<glm::uvec3> boundary;
    for (auto first = faces.begin(); first != faces.end();) {
        const auto last = std::find_if(
            first, faces.end(), [first](const CellFace &face) { return face.key != first->key; });
        const auto even = std::find_if(first, last, [](const CellFace &face) { return face.even; });
        // Those seen from one side, then those seen from the other: as many pairs as there are.
        const auto pairs = std::min(even - first, last - even);
        for (auto face = first; face != first + pairs; ++face)
            mesh.triangles.push_back(face->triangle);
        for (auto face = first + pairs; face != even; ++face)
            boundary.push_back(face->triangle);
        for (auto face = even + pairs; face != last; ++face)
            boundary.push_back(face->triangle);
        first = last;
    }
    mesh.interior_count = mesh.triangles.size();
    mesh.triangles.insert(mesh.triangles.end(), boundary.begin(), boundary.end());
    return mesh;
}

} // namespace kb
