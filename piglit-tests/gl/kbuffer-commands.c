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

static void
draw_range_elements(void)
{
	glEnableClientState(GL_VERTEX_ARRAY);
	glVertexPointer(2, GL_FLOAT, 0, quad);
	glDrawRangeElements(GL_QUADS, 0, 3, 4, GL_UNSIGNED_BYTE, indices);
	glDisableClientState(GL_VERTEX_ARRAY);
}

static void
multi_draw_arrays(void)
{
	static const GLint first[2] = { 0, 0 };
	static const GLsizei count[2] = { 3, 4 };

	glEnableClientState(GL_VERTEX_ARRAY);
	glVertexPointer(2, GL_FLOAT, 0, quad);
	glMultiDrawArrays(GL_TRIANGLE_FAN, first, count, 2);
	glDisableClientState(GL_VERTEX_ARRAY);
}

static void
draw_arrays_instanced(void)
{
	glEnableClientState(GL_VERTEX_ARRAY);
	glVertexPointer(2, GL_FLOAT, 0, quad);
	glDrawArraysInstanced(GL_QUADS, 0, 4, 2);
	glDisableClientState(GL_VERTEX_ARRAY);
}

/** Performs an explicit Begin. */
static void
eval_mesh(void)
{
	/* Bilinear: x and y are the two parameters. */
	static const float points[2][2][3] = {
		{ { -1, -1, 0 }, { -1, 1, 0 } }, { { 1, -1, 0 }, { 1, 1, 0 } }
	};

	glMap2f(GL_MAP2_VERTEX_3, 0, 1, 6, 2, 0, 1, 3, 2, points[0][0]);
	glMapGrid2f(1, 0, 1, 1, 0, 1);
	glEnable(GL_MAP2_VERTEX_3);
	glEvalMesh2(GL_FILL, 0, 1, 0, 1);
	glDisable(GL_MAP2_VERTEX_3);
}

static void
array_element(void)
{
	glEnableClientState(GL_VERTEX_ARRAY);
	glVertexPointer(2, GL_FLOAT, 0, quad);
	glBegin(GL_QUADS);
	for (int i = 0; i < 4; i++)
		glArrayElement(i);
	glEnd();
	glDisableClientState(GL_VERTEX_ARRAY);
}

static void
copy_pixels(void)
{
	glWindowPos2i(0, 0);
	glCopyPixels(0, 0, W, W, GL_COLOR);
}

const struct kb_command kb_commands[KB_NUM_COMMANDS] = {
	{ "Rect", rect },
	{ "DrawArrays", draw_arrays },
	{ "DrawElements", draw_elements },
	{ "Begin", begin_end },
	{ "CallList", call_list },
	{ "DrawRangeElements", draw_range_elements },
	{ "MultiDrawArrays", multi_draw_arrays },
	{ "DrawArraysInstanced", draw_arrays_instanced },
	{ "EvalMesh2", eval_mesh },
	{ "ArrayElement", array_element },
	{ "DrawPixels", draw_pixels, true },
	{ "Bitmap", bitmap, true },
	{ "CopyPixels", copy_pixels, true },
};
