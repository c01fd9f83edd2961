/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-commands.c
 * Each kind of command that draws.
 */

#include "kbuffer-common.h"

#define W KB_COMMAND_SIZE

static const float quad[4][2] = { { -1, -1 }, { 1, -1 }, { 1, 1 }, { -1, 1 } };
static const GLubyte indices[4] = { 0, 1, 2, 3 };

/** An error of Begin leaves the context outside of Begin and End. */
static void
begin_end(void)
{
	glBegin(GL_QUADS);
	for (int i = 0; i < 4; i++)
		glVertex2fv(quad[i]);
	glEnd();
}

static void
draw_arrays(void)
{
	glEnableClientState(GL_VERTEX_ARRAY);
	glVertexPointer(2, GL_FLOAT, 0, quad);
	glDrawArrays(GL_QUADS, 0, 4);
	glDisableClientState(GL_VERTEX_ARRAY);
}

static void
draw_elements(void)
{
	glEnableClientState(GL_VERTEX_ARRAY);
	glVertexPointer(2, GL_FLOAT, 0, quad);
	glDrawElements(GL_QUADS, 4, GL_UNSIGNED_BYTE, indices);
	glDisableClientState(GL_VERTEX_ARRAY);
}

static void
rect(void)
{
	glRectf(-1, -1, 1, 1);
}

static void
call_list(void)
{
	static GLuint list;

	if (!list) {
		list = glGenLists(1);
		glNewList(list, GL_COMPILE);
		begin_end();
		glEndList();
	}
	glCallList(list);
}

static void
draw_pixels(void)
{
	static const float pixels[W * W * 4];

	glWindowPos2i(0, 0);
	glDrawPixels(W, W, GL_RGBA, GL_FLOAT, pixels);
}

static void
bitmap(void)
{
	static const GLubyte bits[W] = { 255, 255, 255, 255, 255, 255, 255, 255 };

	glWindowPos2i(0, 0);
	glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
	glBitmap(W, W, 0, 0, 0, 0, bits);
}

const struct kb_command kb_commands[KB_NUM_COMMANDS] = {
	{ "Rect", rect },
	{ "DrawArrays", draw_arrays },
	{ "DrawElements", draw_elements },
	{ "Begin", begin_end },
	{ "CallList", call_list },
	{ "DrawPixels", draw_pixels, true },
	{ "Bitmap", bitmap, true },
};
