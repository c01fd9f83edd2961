/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file context.h
 * A surfaceless EGL context, for programs that stock and patched Mesa run.
 */

#ifndef CONTEXT_H
#define CONTEXT_H

#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>
#include <GL/glext.h>
#include <stdio.h>
#include <stdlib.h>

static void
die(const char *what)
{
	fprintf(stderr, "%s\n", what);
	exit(2);
}

static void
make_context(void)
{
	static const EGLint config_attribs[] = {
		EGL_SURFACE_TYPE, EGL_PBUFFER_BIT,
		EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE
	};
	EGLDisplay display = eglGetPlatformDisplay(
		EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
	EGLConfig config;
	EGLContext context;
	EGLint n = 0;

	if (!eglInitialize(display, NULL, NULL))
		die("no surfaceless EGL display");
	eglBindAPI(EGL_OPENGL_API);
	if (!eglChooseConfig(display, config_attribs, &config, 1, &n) || !n)
		die("no EGL config");
	context = eglCreateContext(display, config, EGL_NO_CONTEXT, NULL);
	if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
		die("no context");
}

#endif
