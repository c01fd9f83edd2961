// SPDX-License-Identifier: MIT

#include "volume/face_program.hpp"

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

namespace kb
{

const char *const ray_length_shader = R"(
uniform vec4 window_to_ray; // Scale and offset of x and y, to the plane at distance 1.

float ray_length()
{
    vec2 ray = gl_FragCoord.xy * window_to_ray.xy + window_to_ray.zw;
    return sqrt(1.0 + dot(ray, ray));
}
)";

/// What the fragment shader does not read the linker leaves out.
static constexpr const char *vertex_shader = R"(
layout(location = 0) in vec4 position_and_scalar;
uniform mat4 view_projection;
invariant gl_Position;
out float scalar;
out float code;

void main()
{
    gl_Position = view_projection * vec4(position_and_scalar.xyz, 1.0);
    scalar = position_and_scalar.w;
    code = position_and_scalar.w * scale + offset;
}
)";

static constexpr const char *fragment_shader_start = R"(
in float scalar;
in float code;

uniform float nearest_depth; // What is nearer stands for the eye.

float eye_depth()
{
    float depth = 1.0 / gl_FragCoord.w;
    return depth < nearest_depth ? 1e-30 : depth;
}

float ray_distance()
{
    return ray_length() * eye_depth();
}

float tagged_scalar()
{
    return gl_FrontFacing || scalar < 0.5 * tag ? scalar : scalar - 2.0 * tag;
}

float coded_scalar()
{
    return gl_FrontFacing || code < 1.0 ? code : code - 2.0;
}
)";

Result<Program> make_face_program(const Gl &gl, const std::string &fragment_shader)
{
    const std::string start =
        fmt::format("#version 330\n"
                    "const float tag = {:.1f};\n"
                    "const float scale = {:.9e};\n"
                    "const float offset = {:.9e};\n",
                    SortedFaces::boundary_tag, CodedScalar::scale, CodedScalar::offset);
    return Program::make(gl, start + vertex_shader,
                         start + ray_length_shader + fragment_shader_start + fragment_shader);
}

/// The depth of clip coordinates is that of the near plane everywhere.
static glm::mat4 reversed_projection(const OrbitCamera &camera, Size size)
{
    glm::mat4 projection = camera.projection(size);
    const float near_plane = projection[3][2] / (projection[2][2] - 1.0F);
    for (int column = 0; column < 4; ++column)
        projection[column][2] = column == 3 ? near_plane : 0.0F;
    return projection;
}

void draw_faces(const Gl &gl, const Program &program, const SortedFaces &faces, Size size)
{
    const OrbitCamera &camera = faces.camera();
    program.use();
    const glm::mat4 matrix = reversed_projection(camera, size) * camera.view();
    gl.UniformMatrix4fv(program.uniform("view_projection"), 1, GL_FALSE, glm::value_ptr(matrix));
    gl.Uniform1f(program.uniform("nearest_depth"), faces.nearest_depth());
    set_rays(gl, program, camera, size);
    gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    faces.draw();
    gl.ClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
}

void set_rays(const Gl &gl, const Program &program, const OrbitCamera &camera, Size size)
{
    const glm::mat4 projection = camera.projection(size);
    const float across = 1.0F / projection[0][0];
    const float up = 1.0F / projection[1][1];
    gl.Uniform4f(program.uniform("window_to_ray"), 2.0F * across / static_cast<float>(size.width),
                 2.0F * up / static_cast<float>(size.height), -across, -up);
}

} // namespace kb
