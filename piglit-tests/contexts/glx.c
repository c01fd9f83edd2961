/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/** \file glx.c  smoke() in a GLX context: glx DRIVER */

#include "smoke.h"

#include <GL/glx.h>
#include <stdio.h>

static smoke_proc
get(const char *name)
{
	return glXGetProcAddress((const GLubyte *)name);
}

int
main(int argc, char **argv)
{
	int attribs[] = { GLX_RGBA, GLX_DOUBLEBUFFER, GLX_RED_SIZE, 8,
			  GLX_GREEN_SIZE, 8, GLX_BLUE_SIZE, 8, None };
	Display *x = XOpenDisplay(NULL);
	XVisualInfo *visual;
	XSetWindowAttributes wa = { 0 };
	Window window;
	GLXContext context;

	if (argc != 2)
		return 2;
	visual = x ? glXChooseVisual(x, DefaultScreen(x), attribs) : NULL;
	if (!visual) {
		printf("no display or no visual\n");
		return 1;
	}
	wa.colormap = XCreateColormap(x, DefaultRootWindow(x), visual->visual,
				      AllocNone);
	window = XCreateWindow(x, DefaultRootWindow(x), 0, 0, SMOKE_SIZE,
			       SMOKE_SIZE, 0, visual->depth, InputOutput,
			       visual->visual, CWColormap, &wa);
	XMapWindow(x, window);
	XSync(x, False);
	context = glXCreateContext(x, visual, NULL, True);
	if (!context || !glXMakeCurrent(x, window, context)) {
		printf("no context\n");
		return 1;
	}
	return smoke(get, argv[1]);
}
