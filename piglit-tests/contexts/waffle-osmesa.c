/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file waffle-osmesa.c
 * libwaffle-1.so.0 on OSMesa, of which the real one knows nothing: with it in
 * front of the real one in LD_LIBRARY_PATH, piglit's programs, as they are,
 * run in OSMesa contexts.  It has what piglit's framework and our tests call.
 * The platform that is asked for does not matter, displays do not exist, a
 * window is the application's memory that OSMesa draws to.
 *
 * The first functions piglit asks libGL for, by glXGetProcAddressARB: that is
 * here, too.
 */

#include <GL/osmesa.h>
#include <stdio.h>
#include <stdlib.h>
#include <waffle.h>

struct waffle_display { char none; };

/** The attributes of its contexts, in OSMesa's form. */
struct waffle_config { int attribs[16]; };

struct waffle_context { OSMesaContext context; };

struct waffle_window {
	int width, height;
	unsigned char *pixels;
};

static _Thread_local struct waffle_error_info error;

static void *
fail(enum waffle_error code, const char *message)
{
	error.code = code;
	error.message = message;
	error.message_length = 0;
	while (message[error.message_length])
		error.message_length++;
	return NULL;
}

const struct waffle_error_info *
waffle_error_get_info(void)
{
	return &error;
}

const char *
waffle_error_to_string(enum waffle_error e)
{
	return e == WAFFLE_NO_ERROR ? "WAFFLE_NO_ERROR" :
		e == WAFFLE_ERROR_UNSUPPORTED_ON_PLATFORM ?
		"WAFFLE_ERROR_UNSUPPORTED_ON_PLATFORM" : "WAFFLE_ERROR";
}

int32_t
waffle_attrib_list_length(const int32_t *list)
{
	int32_t n = 0;

	while (list && list[2 * n])
		n++;
	return n;
}

bool
waffle_attrib_list_get(const int32_t *list, int32_t key, int32_t *value)
{
	for (; list && *list; list += 2) {
		if (list[0] == key) {
			*value = list[1];
			return true;
		}
	}
	return false;
}

bool
waffle_init(const int32_t *attribs)
{
	/* For who wants to know that this is not the real one. */
	printf("In an OSMesa context\n");
	return true;
}

struct waffle_display *
waffle_display_connect(const char *name)
{
	static struct waffle_display display;

	return &display;
}

bool
waffle_display_disconnect(struct waffle_display *display)
{
	return true;
}

struct waffle_config *
waffle_config_choose(struct waffle_display *display, const int32_t *list)
{
	int32_t api = WAFFLE_CONTEXT_OPENGL, major = 1, minor = 0;
	int32_t profile = WAFFLE_NONE, forward = false, samples = 0;
	struct waffle_config *config;
	int *a;

	waffle_attrib_list_get(list, WAFFLE_CONTEXT_API, &api);
	waffle_attrib_list_get(list, WAFFLE_CONTEXT_MAJOR_VERSION, &major);
	waffle_attrib_list_get(list, WAFFLE_CONTEXT_MINOR_VERSION, &minor);
	waffle_attrib_list_get(list, WAFFLE_CONTEXT_PROFILE, &profile);
	waffle_attrib_list_get(list, WAFFLE_CONTEXT_FORWARD_COMPATIBLE,
			       &forward);
	waffle_attrib_list_get(list, WAFFLE_SAMPLES, &samples);
	if (api != WAFFLE_CONTEXT_OPENGL || forward || samples > 1)
		return fail(WAFFLE_ERROR_UNSUPPORTED_ON_PLATFORM,
			    "not in OSMesa");
	config = malloc(sizeof(*config));
	a = config->attribs;
	*a++ = OSMESA_FORMAT;
	*a++ = OSMESA_RGBA;
	*a++ = OSMESA_DEPTH_BITS;
	*a++ = 24;
	*a++ = OSMESA_STENCIL_BITS;
	*a++ = 8;
	*a++ = OSMESA_PROFILE;
	*a++ = profile == WAFFLE_CONTEXT_CORE_PROFILE ? OSMESA_CORE_PROFILE :
		OSMESA_COMPAT_PROFILE;
	*a++ = OSMESA_CONTEXT_MAJOR_VERSION;
	*a++ = major;
	*a++ = OSMESA_CONTEXT_MINOR_VERSION;
	*a++ = minor;
	*a = 0;
	return config;
}

bool
waffle_config_destroy(struct waffle_config *config)
{
	free(config);
	return true;
}

struct waffle_context *
waffle_context_create(struct waffle_config *config,
		      struct waffle_context *shared)
{
	struct waffle_context *context = malloc(sizeof(*context));

	context->context = OSMesaCreateContextAttribs(
		config->attribs, shared ? shared->context : NULL);
	if (context->context)
		return context;
	free(context);
	return fail(WAFFLE_ERROR_UNSUPPORTED_ON_PLATFORM,
		    "OSMesa makes no such context");
}

bool
waffle_context_destroy(struct waffle_context *context)
{
	if (context)
		OSMesaDestroyContext(context->context);
	free(context);
	return true;
}

struct waffle_window *
waffle_window_create(struct waffle_config *config, int32_t width,
		     int32_t height)
{
	struct waffle_window *window = malloc(sizeof(*window));

	window->width = width;
	window->height = height;
	window->pixels = calloc((size_t)width * height, 4);
	return window;
}

bool
waffle_window_destroy(struct waffle_window *window)
{
	if (window)
		free(window->pixels);
	free(window);
	return true;
}

bool
waffle_window_show(struct waffle_window *window)
{
	return true;
}

bool
waffle_window_swap_buffers(struct waffle_window *window)
{
	return true;
}

union waffle_native_window *
waffle_window_get_native(struct waffle_window *window)
{
	return fail(WAFFLE_ERROR_UNSUPPORTED_ON_PLATFORM, "not in OSMesa");
}

bool
waffle_make_current(struct waffle_display *display,
		    struct waffle_window *window,
		    struct waffle_context *context)
{
	const bool done = context ?
		OSMesaMakeCurrent(context->context, window->pixels,
				  GL_UNSIGNED_BYTE, window->width,
				  window->height) :
		OSMesaMakeCurrent(NULL, NULL, 0, 0, 0);

	if (!done)
		fail(WAFFLE_ERROR_UNKNOWN, "OSMesaMakeCurrent failed");
	return done;
}

void *
waffle_get_proc_address(const char *name)
{
	void *address = (void *)OSMesaGetProcAddress(name);

	return address ? address :
		fail(WAFFLE_ERROR_UNKNOWN, "OSMesa has no such function");
}

void *
waffle_dl_sym(int32_t dl, const char *name)
{
	return waffle_get_proc_address(name);
}

OSMESAproc
glXGetProcAddressARB(const GLubyte *name)
{
	return OSMesaGetProcAddress((const char *)name);
}
