// SPDX-License-Identifier: MIT

#include "transparency/resolve.hpp"

#include <fmt/format.h>

namespace kb
{

static constexpr const char *shader_start = R"(#version 330
uniform vec3 background;
uniform float alpha;
layout(location = 0) out vec4 result;

vec3 sum = vec3(0.0);
float transmittance = 1.0;

void add(vec4 rgba)
{
    sum += transmittance * rgba.a * rgba.rgb;
    transmittance *= 1.0 - rgba.a;
}
)";

Result<ResolvePass> ResolvePass::make(const Gl &gl, const MethodOptions &options,
                                      const std::string &declarations, const std::string &fetch)
{
    auto program =
        Program::make(gl, full_screen_vertex_shader,
                      shader_start + declarations +
                          "void main()\n{\n    ivec2 pixel = ivec2(gl_FragCoord.xy);\n" + fetch +
                          "    result = vec4(sum + transmittance * background, 1.0);\n"
                          "}\n");
    if (!program)
        return program.error();
    return ResolvePass(gl, options, std::move(*program));
}

ResolvePass::ResolvePass(const Gl &gl, const MethodOptions &options, Program program)
    : program_(std::move(program)), empty_(gl), options_(options)
{
    program_.use();
    gl.Uniform3f(program_.uniform("background"), options.background.r, options.background.g,
                 options.background.b);
    gl.Uniform1f(program_.uniform("alpha"), options.alpha);
    for (int unit = 0; unit < 8; ++unit)
        gl.Uniform1i(program_.uniform(fmt::format("attachment{}", unit).c_str()), unit);
}

void ResolvePass::draw(GLuint framebuffer) const
{
    const Gl &gl = empty_.gl();
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl.Viewport(0, 0, options_.size.width, options_.size.height);
    gl.Disable(GL_DEPTH_TEST);
    gl.Disable(GL_BLEND);
    program_.use();
    draw_full_screen(gl, empty_);
}

} // namespace kb
