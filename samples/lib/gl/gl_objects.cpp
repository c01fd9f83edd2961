// SPDX-License-Identifier: MIT

#include "lib/gl/gl_objects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace kb
{

static void set_nearest(const Gl &gl, GLenum target)
{
    gl.TexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.TexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl.TexParameteri(target, GL_TEXTURE_MAX_LEVEL, 0);
}

/// The pixel transfer format that glTexImage accepts without data for the internal format.
static GLenum transfer_format(GLenum internal_format)
{
    switch (internal_format) {
    case GL_DEPTH_COMPONENT16:
    case GL_DEPTH_COMPONENT24:
    case GL_DEPTH_COMPONENT32:
    case GL_DEPTH_COMPONENT32F:
        return GL_DEPTH_COMPONENT;
    case GL_R32UI:
        return GL_RED_INTEGER;
    default:
        return GL_RGBA;
    }
}

Texture make_texture_2d(const Gl &gl, GLenum internal_format, int width, int height)
{
    Texture texture(gl);
    gl.BindTexture(GL_TEXTURE_2D, texture.id());
    gl.TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internal_format), width, height, 0,
                  transfer_format(internal_format),
                  internal_format == GL_R32UI ? GL_UNSIGNED_INT : GL_FLOAT, nullptr);
    set_nearest(gl, GL_TEXTURE_2D);
    return texture;
}

Texture make_texture_2d_array(const Gl &gl, GLenum internal_format, int width, int height,
                              int layers)
{
    Texture texture(gl);
    gl.BindTexture(GL_TEXTURE_2D_ARRAY, texture.id());
    gl.TexImage3D(GL_TEXTURE_2D_ARRAY, 0, static_cast<GLint>(internal_format), width, height,
                  layers, 0, transfer_format(internal_format),
                  internal_format == GL_R32UI ? GL_UNSIGNED_INT : GL_FLOAT, nullptr);
    set_nearest(gl, GL_TEXTURE_2D_ARRAY);
    return texture;
}

Texture make_texture_2d_multisample(const Gl &gl, GLenum internal_format, int samples, int width,
                                    int height)
{
    Texture texture(gl);
    gl.BindTexture(GL_TEXTURE_2D_MULTISAMPLE, texture.id());
    gl.TexImage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, samples, internal_format, width, height,
                             GL_TRUE);
    return texture;
}

Texture make_texture_2d_multisample_array(const Gl &gl, GLenum internal_format, int samples,
                                          int width, int height, int layers)
{
    Texture texture(gl);
    gl.BindTexture(GL_TEXTURE_2D_MULTISAMPLE_ARRAY, texture.id());
    gl.TexImage3DMultisample(GL_TEXTURE_2D_MULTISAMPLE_ARRAY, samples, internal_format, width,
                             height, layers, GL_TRUE);
    return texture;
}

Status check_framebuffer(const Gl &gl)
{
    // First what may have made it incomplete, most likely a lack of memory.
    if (auto made = check_gl(gl, "making the framebuffer"); !made)
        return made;
    const GLenum status = gl.CheckFramebufferStatus(GL_DRAW_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        return Error{fmt::format("the framebuffer is incomplete (status {:#06x})", status)};
    return ok;
}

static std::string first_line(std::string text)
{
    text.resize(std::min(text.find('\n'), text.size()));
    return text;
}

static Result<GLuint> compile(const Gl &gl, GLenum stage, const std::string &source)
{
    const GLuint shader = gl.CreateShader(stage);
    const char *text = source.c_str();
    gl.ShaderSource(shader, 1, &text, nullptr);
    gl.CompileShader(shader);
    GLint compiled = 0;
    gl.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (compiled)
        return shader;
    std::vector<char> log(4096);
    gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
    gl.DeleteShader(shader);
    return Error{fmt::format("the {} shader does not compile: {}",
                             stage == GL_VERTEX_SHADER ? "vertex" : "fragment",
                             first_line(log.data()))};
}

Result<Program> Program::make(const Gl &gl, const std::string &vertex_source,
                              const std::string &fragment_source)
{
    auto vertex = compile(gl, GL_VERTEX_SHADER, vertex_source);
    if (!vertex)
        return vertex.error();
    auto fragment = compile(gl, GL_FRAGMENT_SHADER, fragment_source);
    if (!fragment) {
        gl.DeleteShader(*vertex);
        return fragment.error();
    }
    Program program(gl, gl.CreateProgram());
    for (const GLuint shader : {*vertex, *fragment}) {
        gl.AttachShader(program.id_, shader);
        gl.DeleteShader(shader); // Lives as long as the program.
    }
    gl.LinkProgram(program.id_);
    GLint linked = 0;
    gl.GetProgramiv(program.id_, GL_LINK_STATUS, &linked);
    if (linked)
        return program;
    std::vector<char> log(4096);
    gl.GetProgramInfoLog(program.id_, static_cast<GLsizei>(log.size()), nullptr, log.data());
    return Error{fmt::format("the shaders do not link: {}", first_line(log.data()))};
}

Program::~Program()
{
    if (id_)
        gl_->DeleteProgram(id_);
}

Result<ArbProgram> ArbProgram::make(const Gl &gl, GLenum target, const std::string &source)
{
    while (gl.GetError() != GL_NO_ERROR) {
    }
    ArbProgram program(gl, target);
    program.bind();
    gl.ProgramStringARB(target, GL_PROGRAM_FORMAT_ASCII_ARB, static_cast<GLsizei>(source.size()),
                        source.data());
    if (gl.GetError() == GL_NO_ERROR)
        return program;
    GLint position = -1;
    gl.GetIntegerv(GL_PROGRAM_ERROR_POSITION_ARB, &position);
    const auto *text = gl.GetString(GL_PROGRAM_ERROR_STRING_ARB);
    const auto end = source.begin() + std::clamp<GLint>(position, 0, GLint(source.size()));
    return Error{fmt::format("the assembly program is not accepted: line {}: {}",
                             1 + std::count(source.begin(), end, '\n'),
                             first_line(text ? reinterpret_cast<const char *>(text) : ""))};
}

} // namespace kb
