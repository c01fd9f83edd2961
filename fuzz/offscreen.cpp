// SPDX-License-Identifier: MIT

#include "fuzz/offscreen.hpp"

#include "fuzz/finding.hpp"

namespace kb::fuzz
{

Offscreen::Offscreen(const Offscreen *share)
    : context_(OSMesaCreateContextExt(OSMESA_RGBA, 24, 8, 0, share ? share->context_ : nullptr))
{
    if (!context_)
        finding("OSMesa makes no context");
}

Offscreen::~Offscreen()
{
    OSMesaDestroyContext(context_);
}

void Offscreen::make_current()
{
    if (!OSMesaMakeCurrent(context_, window_.data(), GL_UNSIGNED_BYTE, window_size, window_size))
        finding("OSMesa makes no context current");
}

GLint get_integer(GLenum pname)
{
    GLint value = 0;
    glGetIntegerv(pname, &value);
    return value;
}

bool has_extension(std::string_view name)
{
    const char *all = reinterpret_cast<const char *>(glGetString(GL_EXTENSIONS));
    return all && std::string_view(all).find(name) != std::string_view::npos;
}

std::string_view error_name(GLenum error)
{
    switch (error) {
    case GL_NO_ERROR:
        return "GL_NO_ERROR";
    case GL_INVALID_ENUM:
        return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
        return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
        return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
        return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY:
        return "GL_OUT_OF_MEMORY";
    case GL_STACK_OVERFLOW:
        return "GL_STACK_OVERFLOW";
    case GL_STACK_UNDERFLOW:
        return "GL_STACK_UNDERFLOW";
    default:
        return "an error code that GL does not have";
    }
}

GLenum take_error()
{
    const GLenum error = glGetError();
    if (error != GL_NO_ERROR && glGetError() != GL_NO_ERROR)
        finding("glGetError does not clear {}", error_name(error));
    return error;
}

} // namespace kb::fuzz
