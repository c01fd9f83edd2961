// SPDX-License-Identifier: MIT

#pragma once

#include "faces.hpp"
#include "gl_objects.hpp"
#include "transfer_function.hpp"

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace kb
{

/// The faces in GL buffers, and the order in which they are drawn: front to back by centroid.
/// Vertex attribute 0 is (x, y, z, s): s is the scalar from 0 to 1 over its range and, on faces of
/// the boundary, boundary_tag more.
class SortedFaces
{
public:
    static constexpr float boundary_tag = 4.0F;

    SortedFaces(const Gl &gl, const FaceMesh &mesh, ScalarRange range);

    /// Sorts for a view.
    void sort(const glm::mat4 &view);

    /// Draws all faces in the order of the last sort.
    void draw() const;

    std::size_t count() const { return triangles_.size(); }
    ScalarRange range() const { return range_; }

    /// Places in the mesh's triangles, in drawing order.
    std::span<const std::uint32_t> order() const { return order_; }

private:
    const Gl *gl_;
    ScalarRange range_;
    VertexArray array_;
    Buffer vertex_buffer_;
    std::vector<glm::vec4> vertices_; ///< Interior, then boundary ones.
    std::vector<glm::uvec3> triangles_;
    std::vector<float> depths_; ///< Of the vertices.
    std::vector<float> keys_;
    std::vector<std::uint32_t> order_;
    std::vector<glm::uvec3> sorted_; ///< Triangles in drawing order.
};

/// The extent of a field; {0, 1} if all values are the same, so that all are at 0.
ScalarRange range_of(std::span<const float> values);

} // namespace kb
