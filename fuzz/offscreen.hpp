// SPDX-License-Identifier: MIT
//
// GL contexts in memory (OSMesa), which is linked rather than opened: the fuzzer then sees the
// coverage counters of the driver from the start.

#pragma once

#ifndef GL_GLEXT_PROTOTYPES
#define GL_GLEXT_PROTOTYPES 1
#endif
#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/mesa_kbuffer.h>
#include <GL/osmesa.h>

#include <array>
#include <string_view>

namespace kb::fuzz
{

/// A context of the compatibility profile with a window of its own. It must be made current; it
/// shares objects with another if one is given.
class Offscreen
{
public:
    static constexpr int window_size = 16;

    explicit Offscreen(const Offscreen *share = nullptr);
    ~Offscreen();
    Offscreen(const Offscreen &) = delete;
    Offscreen &operator=(const Offscreen &) = delete;

    void make_current();

private:
    OSMesaContext context_ = nullptr;
    std::array<GLubyte, 4 * window_size * window_size> window_{};
};

/// Of the current context.
GLint get_integer(GLenum pname);
bool has_extension(std::string_view name);

std::string_view error_name(GLenum error);

/// The error since the last call: GL keeps the first.
GLenum take_error();

} // namespace kb::fuzz
