// SPDX-License-Identifier: MIT

#include "lib/gl/context.hpp"

#include "lib/gl/context_kinds.hpp"

#include <fmt/format.h>

namespace kb
{

bool Context::present(GLuint /*framebuffer*/, Size /*size*/, OrbitCamera & /*camera*/)
{
    return false;
}

Result<std::unique_ptr<Context>> make_context(const std::string &kind, Size size,
                                              const std::string &title)
{
    if (kind == "osmesa")
        return make_osmesa_context();
    if (kind == "egl")
        return make_egl_context();
    if (kind == "glfw")
        return make_glfw_context(size, title);
    return Error{fmt::format("no such context: {} (osmesa, egl or glfw)", kind)};
}

static Status require_extension(const Gl &gl, std::string_view name)
{
    if (has_extension(gl, name))
        return ok;
    return Error{fmt::format("this driver has no {} ({}): start the program by scripts/run, or set "
                             "LD_LIBRARY_PATH to the patched Mesa's libraries",
                             name, describe_driver(gl))};
}

Status require_kbuffer_program(const Gl &gl)
{
    return require_extension(gl, "GL_MESA_kbuffer_program");
}

Status require_depth_peeling(const Gl &gl)
{
    return require_extension(gl, "GL_MESA_depth_peeling");
}

} // namespace kb
