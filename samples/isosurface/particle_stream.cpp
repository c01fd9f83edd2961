// SPDX-License-Identifier: MIT
//
// A point has the depth of its center all over: sorted by depth, points come in order. The scalar
// is that of the center and what the field's gradient there adds.

#include "isosurface/fragment_stream.hpp"

#include "isosurface/gradients.hpp"
#include "volume/disorder_capture.hpp"
#include "volume/radix_sort.hpp"

#include <glm/gtc/type_ptr.hpp>

#include <cstddef>

namespace kb
{

namespace
{

/// A square of the size s at the depth w is s * projection[1][1] / w halves of the picture high.
/// The scalar at the place p of the square is value + gradient . (p - center), p = (slopes * w,
/// -w).
constexpr const char *vertex_shader = R"(#version 330
layout(location = 0) in vec3 position;
layout(location = 1) in float value;
layout(location = 2) in vec3 gradient;
uniform mat4 view;
uniform mat4 projection;
uniform float size; // Of a point at depth 1, in pixels.
flat out vec3 scalar; // At the slopes 0, and how much it grows with them.

void main()
{
    vec4 center = view * vec4(position, 1.0);
    gl_Position = projection * center;
    gl_PointSize = size / gl_Position.w;
    vec2 across = (mat3(view) * gradient).xy;
    scalar = vec3(value - dot(across, center.xy), across * -center.z);
}
)";

constexpr const char *fragment_shader = R"(#version 330
uniform vec4 view_size; // Width, height, slopes of the rays at the right and the upper edge.
flat in vec3 scalar;
layout(location = 0) out vec4 fragment;

void main()
{
    vec2 xy = (2.0 * gl_FragCoord.xy / view_size.xy - 1.0) * view_size.zw;
    fragment = vec4(sqrt(1.0 + dot(xy, xy)) / gl_FragCoord.w, scalar.x + dot(scalar.yz, xy), 0.0, 0.0);
}
)";

/// As the shader reads it. The scalar is from 0 to 1 over its range.
struct Vertex {
    glm::vec3 position;
    float value;
    glm::vec3 gradient;
};

class ParticleStream final : public FragmentStream
{
public:
    ParticleStream(const Gl &gl, std::span<const glm::vec3> points, std::span<const float> scalars,
                   ScalarRange range, float point_size, Program program)
        : gl_(gl), program_(std::move(program)), array_(gl), vertices_(gl), order_buffer_(gl),
          points_(points.begin(), points.end()), point_size_(point_size)
    {
        std::vector<float> values;
        values.reserve(scalars.size());
        for (const float scalar : scalars)
            values.push_back((scalar - range.low) / (range.high - range.low));
        const std::vector<glm::vec3> gradients = estimate_gradients(points, values);
        std::vector<Vertex> vertices;
        vertices.reserve(points.size());
        for (std::size_t i = 0; i < points.size(); ++i)
            vertices.push_back({points[i], values[i], gradients[i]});
        gl.BindVertexArray(array_.id());
        gl.BindBuffer(GL_ARRAY_BUFFER, vertices_.id());
        gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)),
                      vertices.data(), GL_STATIC_DRAW);
        const auto add_attribute = [&](GLuint index, GLint components, std::size_t offset) {
            gl.VertexAttribPointer(index, components, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                                   reinterpret_cast<const void *>(offset));
            gl.EnableVertexAttribArray(index);
        };
        add_attribute(0, 3, offsetof(Vertex, position));
        add_attribute(1, 1, offsetof(Vertex, value));
        add_attribute(2, 3, offsetof(Vertex, gradient));
        gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, order_buffer_.id());
        gl.BindVertexArray(0);
    }

    void sort(const OrbitCamera &camera, Size) override
    {
        const glm::mat4 view = camera.view();
        const glm::vec4 depth(-view[0].z, -view[1].z, -view[2].z, -view[3].z);
        depths_.clear();
        for (const glm::vec3 &point : points_)
            depths_.push_back(glm::dot(depth, glm::vec4(point, 1.0F)));
        sort_by_key(depths_, order_);
        gl_.BindVertexArray(array_.id());
        gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER,
                       static_cast<GLsizeiptr>(order_.size() * sizeof(std::uint32_t)),
                       order_.data(), GL_STREAM_DRAW);
    }

    void draw(const OrbitCamera &camera, Size size) const override
    {
        draw_with(program_, camera, size);
    }

    Result<Disorder> capture_disorder(const OrbitCamera &camera, Size size,
                                      const GoOn &go_on) const override
    {
        const auto program =
            Program::make(gl_, vertex_shader, std::string("#version 330\n") + arrival_shader);
        if (!program)
            return program.error();
        // A particle makes one fragment of a pixel at most.
        return kb::capture_disorder(
            gl_, size, count(), GL_LESS, [&] { draw_with(*program, camera, size); }, go_on);
    }

    Medium medium() const override { return Medium::particles; }
    std::size_t count() const override { return points_.size(); }
    std::string_view primitive() const override { return "points"; }

private:
    void draw_with(const Program &program, const OrbitCamera &camera, Size size) const
    {
        const glm::mat4 projection = camera.projection(size);
        program.use();
        gl_.UniformMatrix4fv(program.uniform("view"), 1, GL_FALSE, glm::value_ptr(camera.view()));
        gl_.UniformMatrix4fv(program.uniform("projection"), 1, GL_FALSE,
                             glm::value_ptr(projection));
        gl_.Uniform1f(program.uniform("size"),
                      point_size_ * projection[1][1] * 0.5F * static_cast<float>(size.height));
        gl_.Uniform4f(program.uniform("view_size"), static_cast<float>(size.width),
                      static_cast<float>(size.height), 1.0F / projection[0][0],
                      1.0F / projection[1][1]);
        gl_.Enable(GL_PROGRAM_POINT_SIZE);
        gl_.BindVertexArray(array_.id());
        gl_.DrawElements(GL_POINTS, static_cast<GLsizei>(order_.size()), GL_UNSIGNED_INT, nullptr);
        gl_.Disable(GL_PROGRAM_POINT_SIZE);
    }

    const Gl &gl_;
    Program program_;
    VertexArray array_;
    Buffer vertices_;
    Buffer order_buffer_;
    std::vector<glm::vec3> points_;
    float point_size_;
    std::vector<float> depths_;
    std::vector<std::uint32_t> order_;
};

} // namespace

Result<std::unique_ptr<FragmentStream>> make_particle_stream(const Gl &gl,
                                                             std::span<const glm::vec3> points,
                                                             std::span<const float> scalars,
                                                             ScalarRange range, float point_size)
{
    auto program = Program::make(gl, vertex_shader, fragment_shader);
    if (!program)
        return program.error();
    return std::unique_ptr<FragmentStream>(std::make_unique<ParticleStream>(
        gl, points, scalars, range, point_size, std::move(*program)));
}

} // namespace kb
