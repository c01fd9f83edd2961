// SPDX-License-Identifier: MIT
//
// A current GL context of the compatibility profile. The libraries are opened at run time by name,
// so LD_LIBRARY_PATH alone decides which driver answers.

#pragma once

#include "lib/gl/gl.hpp"
#include "lib/scene/camera.hpp"

#include <memory>
#include <string>

namespace kb
{

class Context
{
public:
    virtual ~Context() = default;
    Context(const Context &) = delete;
    Context &operator=(const Context &) = delete;

    const Gl &gl() const { return gl_; }

    /// Shows color attachment 0 of the framebuffer and lets the user move the camera. Returns
    /// whether another frame is wanted: never by contexts without a window.
    virtual bool present(GLuint framebuffer, Size size, OrbitCamera &camera);

    /// Whether present() shows anything.
    virtual bool has_window() const { return false; }

protected:
    Context() = default;

    Gl gl_;
};

/// Makes a context current by the name of its kind: "osmesa", "egl" (surfaceless) or "glfw" (a
/// window). The size matters to a window only: samples draw into framebuffer objects.
Result<std::unique_ptr<Context>> make_context(const std::string &kind, Size size = {},
                                              const std::string &title = "kbuffer");

/// Whether present() has left the camera where it was.
inline bool is_same_view(const OrbitCamera &a, const OrbitCamera &b)
{
    return a.azimuth == b.azimuth && a.elevation == b.elevation && a.distance == b.distance;
}

/// An error that says how to get a driver with the extension, unless this is one.
Status require_kbuffer_program(const Gl &gl);
Status require_depth_peeling(const Gl &gl);

} // namespace kb
