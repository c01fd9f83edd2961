// SPDX-License-Identifier: MIT

#include "tests/hard_cases/scene.hpp"

#include "bench/gl_scene.hpp"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <cmath>

namespace kb::hard
{

using bench::must;

void append_triangle(Mesh &mesh, const std::array<glm::vec3, 3> &corners, Attributes attributes)
{
    for (const glm::vec3 &corner : corners) {
        mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
        mesh.positions.push_back(corner);
        mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
        mesh.colors.emplace_back(attributes.value, attributes.alpha, attributes.id, 1.0);
    }
}

void append_quad(Mesh &mesh, const std::array<glm::vec3, 4> &corners, Attributes attributes)
{
    append_triangle(mesh, {corners[0], corners[1], corners[2]}, attributes);
    append_triangle(mesh, {corners[0], corners[2], corners[3]}, attributes);
}

void append_full(Mesh &mesh, double depth, Attributes attributes)
{
    const auto z = static_cast<float>(2.0 * depth - 1.0);
    append_triangle(mesh, {{{-1.0F, -1.0F, z}, {3.0F, -1.0F, z}, {-1.0F, 3.0F, z}}}, attributes);
}

glm::mat4 perspective()
{
    return glm::frustum(-1.0F, 1.0F, -1.0F, 1.0F, 1.0F, 16.0F);
}

std::array<glm::vec3, 4> receding_plane()
{
    // 1/w is linear in the view, as it is of a plane.
    const auto corner = [](float x, float y) {
        const float w = 1.0F / (0.5F + 0.25F * x + 0.125F * y);
        return glm::vec3(x * w, y * w, -w);
    };
    return {corner(-1.0F, -1.0F), corner(1.0F, -1.0F), corner(1.0F, 1.0F), corner(-1.0F, 1.0F)};
}

Scene make_abutting_quads(float step)
{
    Scene scene;
    const glm::vec3 below(0.125F, -1.0F, 0.0F);
    const glm::vec3 above(-0.25F, 1.0F, 0.0F);
    const glm::vec3 back(0.0F, 0.0F, step);
    append_quad(scene.mesh, {glm::vec3(-1.0F, -1.0F, 0.0F), below, above, {-1.0F, 1.0F, 0.0F}},
                {1.0, 0.5, 1});
    append_quad(scene.mesh,
                {below + back, glm::vec3(1.0F, -1.0F, step), {1.0F, 1.0F, step}, above + back},
                {1.0, 0.5, 2});
    return scene;
}

Mesh make_closed_sphere(float radius, int slices, int stacks)
{
    Mesh mesh;
    const auto append = [&](float polar, float turn) {
        const glm::vec3 normal(std::sin(polar) * std::cos(turn), std::cos(polar),
                               std::sin(polar) * std::sin(turn));
        mesh.positions.push_back(radius * normal);
        mesh.normals.push_back(normal);
        mesh.colors.emplace_back(1.0F, 0.5F, 0.0F, 1.0F);
    };
    append(0.0F, 0.0F);
    for (int i = 1; i < stacks; ++i)
        for (int j = 0; j < slices; ++j)
            append(glm::pi<float>() * static_cast<float>(i) / static_cast<float>(stacks),
                   glm::two_pi<float>() * static_cast<float>(j) / static_cast<float>(slices));
    append(glm::pi<float>(), 0.0F);

    // Both poles are one vertex each, and the last column is the first.
    const auto vertex = [&](int i, int j) {
        return static_cast<std::uint32_t>(i == 0        ? 0
                                          : i == stacks ? 1 + (stacks - 1) * slices
                                                        : 1 + (i - 1) * slices + j % slices);
    };
    for (int i = 0; i < stacks; ++i) {
        for (int j = 0; j < slices; ++j) {
            if (i > 0)
                mesh.indices.insert(mesh.indices.end(),
                                    {vertex(i, j), vertex(i, j + 1), vertex(i + 1, j)});
            if (i + 1 < stacks)
                mesh.indices.insert(mesh.indices.end(),
                                    {vertex(i, j + 1), vertex(i + 1, j + 1), vertex(i + 1, j)});
        }
    }
    return mesh;
}

// GLSL 3.30 is what softpipe has.
static constexpr const char *vertex_shader = R"(#version 330 compatibility
layout(location = 0) in vec3 position;
layout(location = 2) in vec4 attributes;
uniform mat4 projection;
flat out vec4 surface;

void main()
{
    surface = attributes;
    gl_Position = projection * vec4(position, 1.0);
}
)";

static std::string fragment_shader(const Scene &scene)
{
    return R"(#version 330 compatibility
flat in vec4 surface;
out vec4 color;
)" + scene.fragment_declarations +
           R"(
void main()
{
    color = surface;
)" + scene.fragment_statements +
           "\n}\n";
}

SceneInGl::SceneInGl(const Gl &gl, const Scene &scene)
    : gl_(gl), mesh_(gl, scene.mesh), projection_(scene.projection),
      program_(must(Program::make(gl, vertex_shader, fragment_shader(scene))))
{
}

void SceneInGl::use() const
{
    program_.use();
    gl_.UniformMatrix4fv(program_.uniform("projection"), 1, GL_FALSE, glm::value_ptr(projection_));
}

void SceneInGl::draw() const
{
    use();
    mesh_.draw();
}

void SceneInGl::draw_triangle(std::size_t triangle) const
{
    use();
    mesh_.draw_triangle(triangle);
}

} // namespace kb::hard
