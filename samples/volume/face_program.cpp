// SPDX-License-Identifier: MIT

#include "face_program.hpp"

#include "sorted_faces.hpp"

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

namespace kb
{

static constexpr const char *vertex_shader = R"(#version 330
layout(location = 0) in vec4 position_and_scalar;
uniform mat4 view_projection;
invariant gl_Position;
out float scalar;

void main()
{
    gl_Position = view_projection * vec4(position_and_scalar.xyz, 1.0);
    scalar = position_and_scalar.w;
}
)";

static constexpr const char *fragment_shader_start = R"(#version 330
in float scalar;
uniform vec4 window_to_ray; // Scale and offset of x and y, to the plane at distance 1.

float ray_distance()
{
    vec2 ray = gl_FragCoord.xy * window_to_ray.xy + window_to_ray.zw;
    return sqrt(1.0 + dot(ray, ray)) * (1.0 / gl_FragCoord.w);
}
)";

Result<Program> make_face_program(const Gl &gl, const std::string &fragment_shader)
{
    constexpr float tag = SortedFaces::boundary_tag;
    const std::string tagged =
        fmt::format("\nfloat tagged_scalar()\n{{\n    return gl_FrontFacing || scalar < {:.1f} ? "
                    "scalar : scalar - {:.1f};\n}}\n",
                    tag / 2.0F, 2.0F * tag);
    return Program::make(gl, vertex_shader, fragment_shader_start + tagged + fragment_shader);
}

void use_face_program(const Gl &gl, const Program &program, const OrbitCamera &camera, Size size)
{
    program.use();
    const glm::mat4 projection = camera.projection(size);
    const glm::mat4 matrix = projection * camera.view();
    gl.UniformMatrix4fv(program.uniform("view_projection"), 1, GL_FALSE, glm::value_ptr(matrix));
    const float across = 1.0F / projection[0][0];
    const float up = 1.0F / projection[1][1];
    gl.Uniform4f(program.uniform("window_to_ray"), 2.0F * across / static_cast<float>(size.width),
                 2.0F * up / static_cast<float>(size.height), -across, -up);
}

} // namespace kb
