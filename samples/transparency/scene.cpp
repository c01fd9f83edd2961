// SPDX-License-Identifier: MIT

#include "transparency/scene.hpp"

#include <glm/gtc/type_ptr.hpp>

namespace kb
{

static constexpr const char *vertex_shader = R"(#version 330
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 color;
uniform mat4 view;
uniform mat4 projection;
invariant gl_Position;
out vec3 eye_position;
out vec3 eye_normal;
out vec4 vertex_color;

void main()
{
    vec4 eye = view * vec4(position, 1.0);
    gl_Position = projection * eye;
    eye_position = eye.xyz;
    eye_normal = mat3(view) * normal;
    vertex_color = color;
}
)";

/// The light is at the eye and shines on both sides.
static constexpr const char *fragment_shader_start = R"(#version 330
in vec3 eye_position;
in vec3 eye_normal;
in vec4 vertex_color;
uniform float alpha; // Negative: that of the vertices.
layout(location = 0) out vec4 color;

vec4 shade()
{
    float lengths = dot(eye_normal, eye_normal) * dot(eye_position, eye_position);
    float cosine = lengths > 0.0
        ? abs(dot(eye_normal, eye_position)) * inversesqrt(lengths) : 1.0;
    return vec4(vertex_color.rgb * (0.15 + 0.85 * min(cosine, 1.0)),
                alpha < 0.0 ? vertex_color.a : alpha);
}
)";

Scene::Scene(const Gl &gl, const Mesh &mesh, std::optional<float> alpha)
    : gl_(&gl), buffers_(gl, mesh, default_color), alpha_(alpha)
{
}

Result<Program> Scene::make_program(const Gl &gl, const std::string &declarations,
                                    const std::string &discard)
{
    return Program::make(gl, vertex_shader,
                         fragment_shader_start + declarations + "void main()\n{\n" + discard +
                             "    color = shade();\n}\n");
}

void Scene::use(const Program &program, const OrbitCamera &camera, Size size) const
{
    program.use();
    gl_->UniformMatrix4fv(program.uniform("view"), 1, GL_FALSE, glm::value_ptr(camera.view()));
    gl_->UniformMatrix4fv(program.uniform("projection"), 1, GL_FALSE,
                          glm::value_ptr(camera.projection(size)));
    gl_->Uniform1f(program.uniform("alpha"), alpha_.value_or(-1.0F));
}

void Scene::draw(const Program &program, const OrbitCamera &camera, Size size) const
{
    use(program, camera, size);
    buffers_.draw();
}

void Scene::draw_triangle(const Program &program, const OrbitCamera &camera, Size size,
                          std::size_t triangle) const
{
    use(program, camera, size);
    buffers_.draw_triangle(triangle);
}

} // namespace kb
