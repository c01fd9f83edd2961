// SPDX-License-Identifier: MIT

#include "lib/gl/mesh_buffers.hpp"

namespace kb
{

template <class T>
static void fill(const Gl &gl, GLenum target, const Buffer &buffer, const std::vector<T> &values)
{
    gl.BindBuffer(target, buffer.id());
    gl.BufferData(target, static_cast<GLsizeiptr>(values.size() * sizeof(T)), values.data(),
                  GL_STATIC_DRAW);
}

static void set_attribute(const Gl &gl, GLuint index, GLint components)
{
    gl.VertexAttribPointer(index, components, GL_FLOAT, GL_FALSE, 0, nullptr);
    gl.EnableVertexAttribArray(index);
}

MeshBuffers::MeshBuffers(const Gl &gl, const Mesh &mesh, glm::vec4 color)
    : array_(gl), positions_(gl), normals_(gl), colors_(gl), indices_(gl),
      index_count_(mesh.indices.size())
{
    gl.BindVertexArray(array_.id());
    fill(gl, GL_ARRAY_BUFFER, positions_, mesh.positions);
    set_attribute(gl, 0, 3);
    fill(gl, GL_ARRAY_BUFFER, normals_, mesh.normals);
    set_attribute(gl, 1, 3);
    if (mesh.colors.empty())
        fill(gl, GL_ARRAY_BUFFER, colors_, std::vector<glm::vec4>(mesh.positions.size(), color));
    else
        fill(gl, GL_ARRAY_BUFFER, colors_, mesh.colors);
    set_attribute(gl, 2, 4);
    fill(gl, GL_ELEMENT_ARRAY_BUFFER, indices_, mesh.indices);
    gl.BindVertexArray(0);
}

void MeshBuffers::draw() const
{
    const Gl &gl = array_.gl();
    gl.BindVertexArray(array_.id());
    gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(index_count_), GL_UNSIGNED_INT, nullptr);
}

void MeshBuffers::draw_triangle(std::size_t triangle) const
{
    const Gl &gl = array_.gl();
    gl.BindVertexArray(array_.id());
    gl.DrawElements(GL_TRIANGLES, 3, GL_UNSIGNED_INT,
                    reinterpret_cast<const void *>(3 * triangle * sizeof(std::uint32_t)));
}

void draw_full_screen(const Gl &gl, const VertexArray &empty)
{
    gl.BindVertexArray(empty.id());
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
}

} // namespace kb
