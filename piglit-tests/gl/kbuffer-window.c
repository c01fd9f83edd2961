/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-window.c
 * The default framebuffer as a k-buffer: its color buffer is entry 0, y grows
 * upwards, and a draw buffer that stands for several color buffers is an
 * error.  Not with -fbo: the window system's buffers are meant.
 */

#include "kbuffer-messages.h"

static enum piglit_result
accumulate(void *data)
{
	kb_program("MAD result.kbuffer[0].xy, fragment.color, "
		   "{ 0.2, 0.1, 0, 0 }, kbuffer[0];");
	glClearColor(0, 0, 0, 1);
	glClear(GL_COLOR_BUFFER_BIT);
	glColor4f(1, 1, 1, 1);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	for (int i = 0; i < 3; i++)
		glRectf(-1, -1, 1, 1);
	/* .1 is stored as 26/255. */
	return piglit_probe_rect_rgb(0, 0, piglit_width, piglit_height,
				     (float[3]) { .6, 78 / 255., 0 }) ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
position(void *data)
{
	GLubyte *got = malloc(piglit_width * piglit_height * 4);
	bool pass = true;

	/* Bytes of 2 x and 2 y. */
	kb_program("MUL result.kbuffer[0], fragment.position, "
		   "0.00784313725;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	glRectf(-1, -1, 1, 1);
	glReadPixels(0, 0, piglit_width, piglit_height, GL_RGBA,
		     GL_UNSIGNED_BYTE, got);
	for (int i = 0; i < piglit_width * piglit_height && pass; i++) {
		const int x = i % piglit_width, y = i / piglit_width;

		pass = got[4 * i] == MIN2(2 * x + 1, 255) &&
			got[4 * i + 1] == MIN2(2 * y + 1, 255);
		if (!pass)
			printf("(%d, %d): %d %d\n", x, y, got[4 * i],
			       got[4 * i + 1]);
	}
	free(got);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
one_entry(void *data)
{
	kb_program("MOV result.kbuffer[1], 1;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	glRectf(-1, -1, 1, 1);
	return piglit_check_gl_error(GL_INVALID_OPERATION) ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

/** An off-screen surface has one color buffer for all names. */
static enum piglit_result
several_buffers(void *data)
{
	GLboolean several;
	float wanted;
	bool pass;

	glGetBooleanv(GL_DOUBLEBUFFER, &several);
	printf("%s color buffers\n", several ? "two" : "one");
	wanted = several ? 0 : 1;
	glDrawBuffer(GL_FRONT_AND_BACK);
	glClearColor(0, 0, 0, 0);
	glClear(GL_COLOR_BUFFER_BIT);
	kb_program("MOV result.kbuffer[0], 1;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_collect_messages();
	glRectf(-1, -1, 1, 1);
	pass = several ? kb_expect_message(GL_INVALID_OPERATION,
		"GL_FRONT_AND_BACK, which stands for several color buffers)") :
		piglit_check_gl_error(GL_NO_ERROR);
	kb_stop_messages();
	pass = piglit_probe_rect_rgb(0, 0, piglit_width, piglit_height,
				     (float[3]) { wanted, wanted, wanted }) &&
		pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
depth_test(void *data)
{
	bool pass;

	kb_program("MOV result.kbuffer[0], fragment.color;");
	glClearColor(0, 0, 0, 0);
	glClearDepth(.5);
	glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
	glEnable(GL_DEPTH_TEST);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	glColor4f(1, 0, 0, 1);
	piglit_draw_rect_z(.5, -1, -1, 2, 2);
	glColor4f(0, 1, 0, 1);
	piglit_draw_rect_z(-.5, -1, -1, 1, 2);
	pass = piglit_probe_rect_rgb(0, 0, piglit_width / 2, piglit_height,
				     (float[3]) { 0, 1, 0 });
	pass = piglit_probe_rect_rgb(piglit_width / 2, 0, piglit_width / 2,
				     piglit_height, (float[3]) { 0, 0, 0 }) &&
		pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("accumulate", accumulate, NULL),
	KB_SUBTEST("position", position, NULL),
	KB_SUBTEST("one-entry", one_entry, NULL),
	KB_SUBTEST("several-buffers", several_buffers, NULL),
	KB_SUBTEST("depth-test", depth_test, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(30)
