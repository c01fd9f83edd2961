// SPDX-License-Identifier: MIT
//
// A point has the depth of its center all over: sorted by depth, points come in order.

#include "fragment_stream.hpp"

#include "disorder_capture.hpp"
#include "radix_sort.hpp"

#include <glm/gtc/type_ptr.hpp>

namespace kb
{

namespace
{

/// A square of the size s at the depth w is s * projection[1][1] / w halves of the picture high.
constexpr const char *vertex_shader = R"(#version 330
layout(location = 0) in vec3 position;
layout(location = 1) in float value;
uniform mat4 view;
uniform mat4 projection;
uniform float size; // Of a point at depth 1, in pixels.
flat out float scalar;

void main()
{
    gl_Position = projection * (view * vec4(position, 1.0));
    gl_PointSize = size / gl_Position.w;
    scalar = value;
}
)";

constexpr const char *fragment_shader = R"(#version 330
uniform vec4 view_size; // Width, height, slopes of the rays at the right and the upper edge.
flat in float scalar;
layout(location = 0) out vec4 fragment;

void main()
{
    vec2 xy = (2.0 * gl_FragCoord.xy / view_size.xy - 1.0) * view_size.zw;
    fragment = vec4(sqrt(1.0 + dot(xy, xy)) / gl_FragCoord.w, scalar, 0.0, 0.0);
}
)";

class ParticleStream final : public FragmentStream
{
public:
    ParticleStream(const Gl &gl, std::span<const glm::vec3> points, std::span<const float> scalars,
                   ScalarRange range, float point_size, Program program)
        : gl_(gl), program_(std::move(program)), array_(gl), vertices_(gl), order_buffer_(gl),
          points_(points.begin(), points.end()), point_size_(point_size)
    {
        std::vector<glm::vec4> vertices;
        vertices.reserve(points.size());
        for (std::size_t i = 0; i < points.size(); ++i)
            vertices.emplace_back(points[i], (scalars[i] - range.low) / (range.high - range.low));
        gl.BindVertexArray(array_.id());
        gl.BindBuffer(GL_ARRAY_BUFFER, vertices_.id());
        gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(glm::vec4)),
                      vertices.data(), GL_STATIC_DRAW);
        gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec4), nullptr);
        gl.VertexAttribPointer(1, 1, GL_FLOAT, GL_FALSE, sizeof(glm::vec4),
                               reinterpret_cast<const void *>(sizeof(glm::vec3)));
        gl.EnableVertexAttribArray(0);
        gl.EnableVertexAttribArray(1);
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

    Result<Disorder> capture_disorder(const OrbitCamera &camera, Size size) const override
    {
        const auto program =
            Program::make(gl_, vertex_shader, std::string("#version 330\n") + arrival_shader);
        if (!program)
            return program.error();
        // A particle makes one fragment of a pixel at most.
        return kb::capture_disorder(gl_, size, count(), [&] { draw_with(*program, camera, size); });
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
