// SPDX-License-Identifier: MIT

#pragma once

#include "lib/gl/gl_objects.hpp"
#include "lib/scene/camera.hpp"
#include "volume/cell_order.hpp"
#include "volume/faces.hpp"
#include "volume/scalar_range.hpp"

#include <glm/vec4.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kb
{

/// What puts faces in order, front to back.
enum class FaceOrder {
    centroid,       ///< The depths of their centroids.
    nearest_vertex, ///< The depths of their nearest vertices.
    cells           ///< CellOrder.
};

/// The faces in GL buffers, and the order in which they are drawn: nearly front to back.
/// Vertex attribute 0 is (x, y, z, s): s is the scalar from 0 to 1 over its range and, on faces of
/// the boundary, boundary_tag more.
class SortedFaces
{
public:
    static constexpr float boundary_tag = 4.0F;

    SortedFaces(const Gl &gl, const FaceMesh &mesh, ScalarRange range,
                FaceOrder order = FaceOrder::centroid);

    /// Sorts for a view, and leaves out what covers no center of a pixel in it.
    void sort(const OrbitCamera &camera, Size size);

    /// Draws the faces in the order of the last sort, by one command. If the eye is inside of the
    /// grid there is one more in front of them, the entry of all rays.
    void draw() const;

    /// Of the last sort, with a near plane that cuts off nothing of a face.
    const OrbitCamera &camera() const { return camera_; }

    /// What is drawn with less depth is the entry that stands for the eye.
    float nearest_depth() const { return nearest_depth_; }

    /// Of the faces that are drawn, if they can be seen.
    std::size_t count() const { return drawn_count_; }
    ScalarRange range() const { return range_; }

    /// What is drawn, in this order: places in the mesh's triangles.
    std::span<const std::uint32_t> order() const { return order_; }

private:
    /// A vertex on the picture, in 1/256 of a pixel from the center of the first.
    struct Projected {
        std::int32_t x;
        std::int32_t y;
        float depth; ///< Of the eye. Not positive: x and y mean nothing.
    };

    /// Of a part of the faces those that are sorted by their keys: all that are seen, or, for the
    /// order by cells, those by which rays leave the grid.
    struct Chosen {
        std::uint32_t first;
        std::uint32_t last; ///< One behind the part's last face.
        std::vector<std::uint32_t> faces;
        std::vector<float> keys;
    };

    void project(const OrbitCamera &camera, Size size);
    Seen see(const glm::uvec3 &triangle, glm::vec3 eye, Size size) const;
    void choose(Chosen &chosen, glm::vec3 eye, Size size);
    void fit_near_plane(const OrbitCamera &camera, Size size);
    void cap_at_eye(float depth, glm::vec2 slopes, float scalar);
    void upload_vertices() const;
    float key_of(const glm::uvec3 &triangle) const;

    const Gl *gl_;
    ScalarRange range_;
    VertexArray array_;
    Buffer vertex_buffer_;
    Buffer index_buffer_;
    /// Those of the interior, those of the boundary, and three of the entry at the eye.
    std::vector<glm::vec4> vertices_;
    std::vector<glm::uvec3> triangles_;
    std::size_t interior_count_;
    std::size_t drawn_count_;
    FaceOrder order_by_;
    std::optional<CellOrder> cell_order_; ///< If the order is by cells.
    std::vector<Projected> projected_;
    std::vector<Chosen> chosen_; ///< A part for each processor.
    std::vector<float> keys_;    ///< Of all parts.
    std::vector<std::uint32_t> keyed_;
    std::vector<Seen> seen_;
    OrbitCamera camera_;
    float nearest_depth_ = 0.0F;
    bool eye_is_inside_ = false;
    std::vector<std::uint32_t> order_;
};

} // namespace kb
