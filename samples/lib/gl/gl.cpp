// SPDX-License-Identifier: MIT

#include "lib/gl/gl.hpp"

#include <fmt/format.h>

namespace kb
{

Result<Gl> load_gl(const std::function<GlProc(const char *)> &proc_address)
{
    Gl gl;
#define KB_GL_LOAD(name)                                                                           \
    gl.name = reinterpret_cast<decltype(gl.name)>(proc_address("gl" #name));                       \
    if (!gl.name)                                                                                  \
        return Error{"the GL library has no gl" #name};
    KB_GL_FUNCTIONS(KB_GL_LOAD)
#undef KB_GL_LOAD
    return gl;
}

bool has_extension(const Gl &gl, std::string_view name)
{
    GLint count = 0;
    gl.GetIntegerv(GL_NUM_EXTENSIONS, &count);
    for (GLint i = 0; i < count; ++i) {
        const auto *text = gl.GetStringi(GL_EXTENSIONS, static_cast<GLuint>(i));
        if (text && name == reinterpret_cast<const char *>(text))
            return true;
    }
    return false;
}

std::string describe_driver(const Gl &gl)
{
    const auto text = [&gl](GLenum name) {
        const auto *value = gl.GetString(name);
        return value ? reinterpret_cast<const char *>(value) : "unknown";
    };
    return fmt::format("{}, GL {}", text(GL_RENDERER), text(GL_VERSION));
}

static std::string_view error_name(GLenum error)
{
    switch (error) {
    case GL_INVALID_ENUM:
        return "INVALID_ENUM";
    case GL_INVALID_VALUE:
        return "INVALID_VALUE";
    case GL_INVALID_OPERATION:
        return "INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
        return "INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY:
        return "OUT_OF_MEMORY";
    default:
        return "an unknown GL error";
    }
}

Status check_gl(const Gl &gl, std::string_view doing)
{
    const GLenum error = gl.GetError();
    if (error == GL_NO_ERROR)
        return ok;
    return Error{fmt::format("{} gave {}", doing, error_name(error))};
}

} // namespace kb
