// SPDX-License-Identifier: MIT

#include "sorted_faces.hpp"

#include "radix_sort.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kb
{

namespace
{

constexpr int subpixel_bits = 8;
constexpr std::int32_t subpixels = 1 << subpixel_bits;

/// Drivers may put a vertex this far from where it is computed here: one step of the grid that they
/// round it to, and one for other rounding on the way.
constexpr std::int32_t slack = 2;

/// Whether there is the center of one of `count` pixels between two positions.
bool covers_center(std::int32_t low, std::int32_t high, std::int32_t count)
{
    const std::int32_t first = (low - slack + subpixels - 1) >> subpixel_bits;
    const std::int32_t last = (high + slack) >> subpixel_bits;
    return std::max(first, 0) <= std::min(last, count - 1);
}

std::int32_t to_subpixels(float position)
{
    // Beyond this a face of any size is far outside of the largest picture.
    constexpr float limit = 1 << 30;
    return static_cast<std::int32_t>(
        std::clamp(position * static_cast<float>(subpixels), -limit, limit));
}

} // namespace

ScalarRange range_of(std::span<const float> values)
{
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    if (low == values.end())
        return {};
    return {*low, *high > *low ? *high : *low + 1.0F};
}

SortedFaces::SortedFaces(const Gl &gl, const FaceMesh &mesh, ScalarRange range)
    : gl_(&gl), range_(range), array_(gl), vertex_buffer_(gl), index_buffer_(gl),
      triangles_(mesh.triangles)
{
    const float extent = range.high - range.low;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        vertices_.emplace_back(mesh.positions[i], (mesh.scalars[i] - range.low) / extent);

    // A boundary vertex is another one than that of the interior at the same place.
    constexpr auto none = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> boundary_vertices(vertices_.size(), none);
    for (auto i = mesh.interior_count; i < triangles_.size(); ++i) {
        for (int corner = 0; corner < 3; ++corner) {
            std::uint32_t &vertex = triangles_[i][corner];
            std::uint32_t &copy = boundary_vertices[vertex];
            if (copy == none) {
                copy = static_cast<std::uint32_t>(vertices_.size());
                vertices_.push_back(vertices_[vertex] + glm::vec4(0.0F, 0.0F, 0.0F, boundary_tag));
            }
            vertex = copy;
        }
    }

    gl.BindVertexArray(array_.id());
    gl.BindBuffer(GL_ARRAY_BUFFER, vertex_buffer_.id());
    gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices_.size() * sizeof(glm::vec4)),
                  vertices_.data(), GL_STATIC_DRAW);
    gl.VertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
    gl.EnableVertexAttribArray(0);
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer_.id());
    gl.BindVertexArray(0);
}

void SortedFaces::project(const OrbitCamera &camera, Size size)
{
    const glm::mat4 matrix = camera.projection(size) * camera.view();
    const glm::vec2 half(0.5F * static_cast<float>(size.width),
                         0.5F * static_cast<float>(size.height));
    projected_.resize(vertices_.size());
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
        const glm::vec4 clip = matrix * glm::vec4(glm::vec3(vertices_[i]), 1.0F);
        const glm::vec2 pixel = (glm::vec2(clip) / clip.w + 1.0F) * half - 0.5F;
        projected_[i] = {to_subpixels(pixel.x), to_subpixels(pixel.y), clip.w};
    }
}

void SortedFaces::sort(const OrbitCamera &camera, Size size)
{
    project(camera, size);
    visible_.clear();
    keys_.clear();
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        const Projected &a = projected_[triangles_[i].x];
        const Projected &b = projected_[triangles_[i].y];
        const Projected &c = projected_[triangles_[i].z];
        const bool before_eye = std::min({a.depth, b.depth, c.depth}) > 0.0F;
        if (before_eye &&
            !(covers_center(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), size.width) &&
              covers_center(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), size.height)))
            continue;
        visible_.push_back(static_cast<std::uint32_t>(i));
        keys_.push_back(a.depth + b.depth + c.depth);
    }
    sort_by_key(keys_, order_);
    for (std::uint32_t &place : order_)
        place = visible_[place];

    std::vector<glm::uvec3> sorted(order_.size());
    std::transform(order_.begin(), order_.end(), sorted.begin(),
                   [this](std::uint32_t place) { return triangles_[place]; });
    gl_->BindVertexArray(array_.id());
    gl_->BufferData(GL_ELEMENT_ARRAY_BUFFER,
                    static_cast<GLsizeiptr>(sorted.size() * sizeof(glm::uvec3)), sorted.data(),
                    GL_STREAM_DRAW);
}

void SortedFaces::draw() const
{
    gl_->BindVertexArray(array_.id());
    gl_->DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * order_.size()), GL_UNSIGNED_INT,
                      nullptr);
}

} // namespace kb
