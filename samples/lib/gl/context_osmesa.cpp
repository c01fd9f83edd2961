// SPDX-License-Identifier: MIT

#include "lib/gl/context_kinds.hpp"
#include "lib/gl/shared_library.hpp"

#include <GL/osmesa.h>

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <string_view>

namespace kb
{

namespace
{

struct OsmesaFunctions {
    decltype(&::OSMesaCreateContextExt) create = nullptr;
    decltype(&::OSMesaDestroyContext) destroy = nullptr;
    decltype(&::OSMesaMakeCurrent) make_current = nullptr;
    decltype(&::OSMesaGetProcAddress) proc_address = nullptr;
};

class OsmesaContext final : public Context
{
public:
    explicit OsmesaContext(const OsmesaFunctions &osmesa) : osmesa_(osmesa) {}
    ~OsmesaContext() override
    {
        if (context_)
            osmesa_.destroy(context_);
    }

    Status start()
    {
        context_ = osmesa_.create(OSMESA_RGBA, 0, 0, 0, nullptr);
        if (!context_ || !osmesa_.make_current(context_, pixels_.data(), GL_UNSIGNED_BYTE,
                                               window_size, window_size))
            return Error{"OSMesa makes no context"};
        auto gl = load_gl([this](const char *name) { return osmesa_.proc_address(name); });
        if (!gl)
            return gl.error();
        gl_ = *gl;
        return ok;
    }

private:
    static constexpr int window_size = 16; // OSMesa wants a window; nothing is drawn to it.

    OsmesaFunctions osmesa_;
    OSMesaContext context_ = nullptr;
    std::array<GLubyte, 4 * window_size * window_size> pixels_{};
};

} // namespace

/// OSMesa of Mesa 25.0 crashes where it does not have the driver that the user chose.
static Status check_driver()
{
    const char *driver = std::getenv("GALLIUM_DRIVER");
    if (!driver || driver == std::string_view("llvmpipe") || driver == std::string_view("softpipe"))
        return ok;
    return Error{fmt::format("GALLIUM_DRIVER is '{}'; the drivers of OSMesa are llvmpipe and "
                             "softpipe: unset it, or set it to one of them",
                             driver)};
}

Result<std::unique_ptr<Context>> make_osmesa_context()
{
    if (auto checked = check_driver(); !checked)
        return checked.error();
    auto library = SharedLibrary::open("libOSMesa.so.8");
    if (!library)
        return library.error();
    OsmesaFunctions osmesa;
    if (!library->load(osmesa.create, "OSMesaCreateContextExt") ||
        !library->load(osmesa.destroy, "OSMesaDestroyContext") ||
        !library->load(osmesa.make_current, "OSMesaMakeCurrent") ||
        !library->load(osmesa.proc_address, "OSMesaGetProcAddress"))
        return Error{"libOSMesa.so.8 lacks a function of OSMesa"};
    auto context = std::make_unique<OsmesaContext>(osmesa);
    if (auto started = context->start(); !started)
        return started.error();
    return std::unique_ptr<Context>(std::move(context));
}

} // namespace kb
