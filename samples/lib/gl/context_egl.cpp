// SPDX-License-Identifier: MIT

#include "lib/gl/context_kinds.hpp"
#include "lib/gl/shared_library.hpp"

#ifndef EGL_EGLEXT_PROTOTYPES
#define EGL_EGLEXT_PROTOTYPES 1 // Only for the types: nothing is linked with these.
#endif
#include <EGL/egl.h>
#include <EGL/eglext.h>

namespace kb
{

namespace
{

struct EglFunctions {
    decltype(&::eglGetProcAddress) proc_address = nullptr;
    decltype(&::eglGetPlatformDisplay) get_platform_display = nullptr;
    decltype(&::eglInitialize) initialize = nullptr;
    decltype(&::eglTerminate) terminate = nullptr;
    decltype(&::eglBindAPI) bind_api = nullptr;
    decltype(&::eglCreateContext) create_context = nullptr;
    decltype(&::eglDestroyContext) destroy_context = nullptr;
    decltype(&::eglMakeCurrent) make_current = nullptr;
};

class EglContext final : public Context
{
public:
    explicit EglContext(const EglFunctions &egl) : egl_(egl) {}
    ~EglContext() override
    {
        if (context_ != EGL_NO_CONTEXT) {
            egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
            egl_.destroy_context(display_, context_);
        }
        if (display_ != EGL_NO_DISPLAY)
            egl_.terminate(display_);
    }

    Status start()
    {
        display_ =
            egl_.get_platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        if (display_ == EGL_NO_DISPLAY || !egl_.initialize(display_, nullptr, nullptr))
            return Error{"EGL has no surfaceless display"};
        if (!egl_.bind_api(EGL_OPENGL_API))
            return Error{"EGL has no desktop OpenGL"};
        context_ = egl_.create_context(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, nullptr);
        if (context_ == EGL_NO_CONTEXT ||
            !egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
            return Error{"EGL makes no surfaceless context"};
        auto gl = load_gl([this](const char *name) { return egl_.proc_address(name); });
        if (!gl)
            return gl.error();
        gl_ = *gl;
        return ok;
    }

private:
    EglFunctions egl_;
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
};

} // namespace

Result<std::unique_ptr<Context>> make_egl_context()
{
    auto library = SharedLibrary::open("libEGL.so.1");
    if (!library)
        return library.error();
    EglFunctions egl;
    if (!library->load(egl.proc_address, "eglGetProcAddress") ||
        !library->load(egl.get_platform_display, "eglGetPlatformDisplay") ||
        !library->load(egl.initialize, "eglInitialize") ||
        !library->load(egl.terminate, "eglTerminate") ||
        !library->load(egl.bind_api, "eglBindAPI") ||
        !library->load(egl.create_context, "eglCreateContext") ||
        !library->load(egl.destroy_context, "eglDestroyContext") ||
        !library->load(egl.make_current, "eglMakeCurrent"))
        return Error{"libEGL.so.1 lacks a function of EGL 1.5"};
    auto context = std::make_unique<EglContext>(egl);
    if (auto started = context->start(); !started)
        return started.error();
    return std::unique_ptr<Context>(std::move(context));
}

} // namespace kb
