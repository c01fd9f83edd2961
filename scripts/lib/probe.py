"""Prints which OpenGL driver answers a program that uses EGL as every program does, without a
window: renderer, version, the file of the driver, and whether it has the extensions."""

import ctypes
import sys

EGL_OPENGL_BIT, EGL_RENDERABLE_TYPE, EGL_SURFACE_TYPE, EGL_NONE = 0x0008, 0x3040, 0x3033, 0x3038
EGL_PLATFORM_SURFACELESS_MESA, EGL_OPENGL_API = 0x31DD, 0x30A2
GL_RENDERER, GL_VERSION, GL_EXTENSIONS = 0x1F01, 0x1F02, 0x1F03
EXTENSIONS = ("GL_MESA_kbuffer_program", "GL_MESA_depth_peeling")


def library_file():
    with open("/proc/self/maps") as maps:
        files = {line.split()[-1] for line in maps if "/libgallium" in line}
    return ", ".join(sorted(files)) or "unknown"


def main():
    try:
        egl = ctypes.CDLL("libEGL.so.1")
    except OSError as error:
        sys.exit(f"libEGL cannot be loaded: {error}")
    for name in ("eglGetPlatformDisplay", "eglCreateContext", "eglGetProcAddress"):
        getattr(egl, name).restype = ctypes.c_void_p
    display = ctypes.c_void_p(
        egl.eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, None, None))
    if not display or not egl.eglInitialize(display, None, None):
        sys.exit("EGL gives no display without a window")
    attributes = (ctypes.c_int * 5)(
        EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE)
    config, count = ctypes.c_void_p(), ctypes.c_int()
    egl.eglBindAPI(EGL_OPENGL_API)
    egl.eglChooseConfig(display, attributes, ctypes.byref(config), 1, ctypes.byref(count))
    context = ctypes.c_void_p(egl.eglCreateContext(display, config, None, None))
    if not context or not egl.eglMakeCurrent(display, None, None, context):
        sys.exit("EGL gives no OpenGL context")
    get_string = ctypes.CFUNCTYPE(ctypes.c_char_p, ctypes.c_uint)(
        egl.eglGetProcAddress(b"glGetString"))
    extensions = get_string(GL_EXTENSIONS).decode().split()
    print("driver:", get_string(GL_RENDERER).decode())
    print("version:", get_string(GL_VERSION).decode())
    print("library:", library_file())
    for name in EXTENSIONS:
        print(f"{name}:", "yes" if name in extensions else "no")


main()
