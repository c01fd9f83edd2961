// SPDX-License-Identifier: MIT

#pragma once

#include "lib/gl/gl_objects.hpp"
#include "lib/io/mesh.hpp"

namespace kb
{

/// A mesh in GL buffers. Vertex attributes: 0 position, 1 normal, 2 RGBA.
class MeshBuffers
{
public:
    /// A mesh without colors is drawn in `color`.
    MeshBuffers(const Gl &gl, const Mesh &mesh, glm::vec4 color = glm::vec4(1.0F));

    void draw() const;
    void draw_triangle(std::size_t triangle) const;
    std::size_t triangle_count() const { return index_count_ / 3; }

private:
    VertexArray array_;
    Buffer positions_;
    Buffer normals_;
    Buffer colors_;
    Buffer indices_;
    std::size_t index_count_;
};

/// A triangle that covers the viewport, for passes over all pixels: `gl_Position` needs no buffers.
inline constexpr const char *full_screen_vertex_shader = R"(#version 130
void main()
{
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";
void draw_full_screen(const Gl &gl, const VertexArray &empty);

} // namespace kb
