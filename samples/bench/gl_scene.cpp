// SPDX-License-Identifier: MIT

#include "bench/gl_scene.hpp"

#include <glm/gtc/type_ptr.hpp>

namespace kb::bench
{

static const std::string version = "#version 450 compatibility\n";

static const std::string vertex_shader = version + R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 color;
uniform mat4 projection;
out vec3 surface_normal;
out vec4 surface_color;
invariant gl_Position;

void main()
{
    surface_normal = normal;
    surface_color = color;
    gl_Position = projection * vec4(position, 1.0);
}
)";

// A headlight shines along the view, so the cosine of its angle is the normal's z; a surface has
// two sides.
static const std::string shading = R"(
in vec3 surface_normal;
in vec4 surface_color;

vec4 shade()
{
    return vec4(surface_color.rgb * abs(normalize(surface_normal).z), surface_color.a);
}
)";

void GlScene::draw(const Program &program) const
{
    program.use();
    gl_.UniformMatrix4fv(program.uniform("projection"), 1, GL_FALSE, glm::value_ptr(projection_));
    mesh_.draw();
}

Program make_geometry_program(const Gl &gl, const std::string &extensions,
                              const std::string &fragment_main)
{
    return must(Program::make(gl, vertex_shader, version + extensions + shading + fragment_main));
}

Program make_view_program(const Gl &gl, const std::string &fragment_source)
{
    return must(Program::make(gl, full_screen_vertex_shader, version + fragment_source));
}

} // namespace kb::bench
