// SPDX-License-Identifier: MIT

#pragma once

#include "lib/io/tet_grid.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace kb
{

/// The faces of the cells of a grid, each once. Points keep their indices.
struct FaceMesh {
    std::vector<glm::vec3> positions;
    std::vector<float> scalars; ///< One a position.
    std::vector<glm::uvec3> triangles;
    /// The first ones are shared by two cells. Those that follow belong to one cell and are the
    /// boundary, counterclockwise seen from outside.
    std::size_t interior_count = 0;
    /// The last ones are within clusters of cells: shared by two cells, too, but not drawn.
    std::size_t inner_count = 0;
    /// For each triangle the cell from whose outside it is counterclockwise, and the one beyond it.
    std::vector<glm::uvec2> cells;
    static constexpr std::uint32_t no_cell = std::numeric_limits<std::uint32_t>::max();

    std::size_t drawn_count() const { return triangles.size() - inner_count; }
};

/// Cells without volume add no faces. Of the faces with the same three points, two that are seen
/// from opposite sides make one interior face; those that are left over are boundary.
FaceMesh make_face_mesh(const TetGrid &grid, const ScalarField &field);

/// The mesh with those faces as inner ones between whose cells nothing is to be seen. It has none
/// yet.
FaceMesh mark_inner_faces(const FaceMesh &mesh,
                          const std::function<bool(std::uint32_t, std::uint32_t)> &look_as_one);

} // namespace kb
