// SPDX-License-Identifier: MIT

#include "context.hpp"

#include "context_kinds.hpp"

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

Status require_kbuffer_program(const Gl &gl)
{
    if (has_extension(gl, "GL_MESA_kbuffer_program"))
        return ok;
    return Error{
        fmt::format("this driver has no GL_MESA_kbuffer_program ({}): start the program by "
                    "scripts/run, or set LD_LIBRARY_PATH to the patched Mesa's libraries",
                    describe_driver(gl))};
}

} // namespace kb
