/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/** \file osmesa.c  smoke() in an OSMesa context, without libglvnd: osmesa DRIVER */

#include "smoke.h"

#include <GL/osmesa.h>
#include <stdio.h>

static smoke_proc
get(const char *name)
{
	return (smoke_proc)OSMesaGetProcAddress(name);
}

int
main(int argc, char **argv)
{
	static unsigned char pixels[SMOKE_SIZE * SMOKE_SIZE * 4];
	OSMesaContext context;
	int failed;

	if (argc != 2)
		return 2;
	context = OSMesaCreateContextExt(OSMESA_RGBA, 24, 8, 0, NULL);
	if (!context || !OSMesaMakeCurrent(context, pixels, GL_UNSIGNED_BYTE,
					   SMOKE_SIZE, SMOKE_SIZE)) {
		printf("no context\n");
		return 1;
	}
	failed = smoke(get, argv[1]);
	/* The application's own memory: red is .6, green is low at first. */
	if (!failed && (pixels[0] != 153 || pixels[1] != 4)) {
		printf("the memory holds %d %d %d %d\n", pixels[0], pixels[1],
		       pixels[2], pixels[3]);
		failed = 1;
	}
	OSMesaDestroyContext(context);
	return failed;
}
