/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/** \file egl.c  smoke() in an EGL context: egl surfaceless|x11 DRIVER */

#include "smoke.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <X11/Xlib.h>
#include <stdio.h>
#include <string.h>

static smoke_proc
get(const char *name)
{
	return (smoke_proc)eglGetProcAddress(name);
}

int
main(int argc, char **argv)
{
	static const EGLint size[] = {
		EGL_WIDTH, SMOKE_SIZE, EGL_HEIGHT, SMOKE_SIZE, EGL_NONE
	};
	const int x11 = argc == 3 && strcmp(argv[1], "x11") == 0;
	const EGLint attribs[] = {
		EGL_SURFACE_TYPE, x11 ? EGL_WINDOW_BIT : EGL_PBUFFER_BIT,
		EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_RED_SIZE, 8,
		EGL_GREEN_SIZE, 8, EGL_BLUE_SIZE, 8, EGL_NONE
	};
	Display *x = NULL;
	EGLDisplay display;
	EGLConfig config;
	EGLSurface surface;
	EGLContext context;
	EGLint n = 0;

	if (argc != 3)
		return 2;
	if (x11) {
		x = XOpenDisplay(NULL);
		display = eglGetPlatformDisplay(EGL_PLATFORM_X11_KHR, x, NULL);
	} else {
		display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA,
						EGL_DEFAULT_DISPLAY, NULL);
	}
	eglBindAPI(EGL_OPENGL_API);
	if (!eglInitialize(display, NULL, NULL) ||
	    !eglChooseConfig(display, attribs, &config, 1, &n) || !n) {
		printf("no display or no config\n");
		return 1;
	}
	if (x11) {
		Window window = XCreateSimpleWindow(
			x, DefaultRootWindow(x), 0, 0, SMOKE_SIZE, SMOKE_SIZE,
			0, 0, 0);

		XMapWindow(x, window);
		XSync(x, False);
		surface = eglCreateWindowSurface(display, config, window, NULL);
	} else {
		surface = eglCreatePbufferSurface(display, config, size);
	}
	context = eglCreateContext(display, config, EGL_NO_CONTEXT, NULL);
	if (!eglMakeCurrent(display, surface, surface, context)) {
		printf("no context\n");
		return 1;
	}
	return smoke(get, argv[2]);
}
