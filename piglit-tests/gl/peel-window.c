/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-window.c
 * The default framebuffer has no layers: drawing to it with depth peeling is
 * an error and draws nothing.  Not with -fbo: the window system's buffers are
 * meant.
 */

#include "kbuffer-messages.h"
#include "peel-common.h"

static enum piglit_result
refused(void *data)
{
	static const float blue[4] = { 0, 0, 1, 1 }, green[4] = { 0, 1, 0, 1 };
	bool pass;

	glClearColor(0, 0, 1, 1);
	glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
	glColor4fv(green);
	glEnable(GL_DEPTH_PEELING_MESA);
	kb_collect_messages();
	glRectf(-1, -1, 1, 1);
	pass = kb_expect_message(GL_INVALID_OPERATION,
				 "(depth peeling in the default framebuffer)");
	kb_stop_messages();
	pass = piglit_probe_rect_rgba(0, 0, piglit_width, piglit_height,
				      blue) && pass;

	/* Clears are none of its business. */
	glClearColor(1, 1, 1, 1);
	glClear(GL_COLOR_BUFFER_BIT);
	pass = piglit_probe_pixel_rgba(3, 3, (float[4]) { 1, 1, 1, 1 }) && pass;

	glDisable(GL_DEPTH_PEELING_MESA);
	glRectf(-1, -1, 1, 1);
	pass = piglit_probe_rect_rgba(0, 0, piglit_width, piglit_height,
				      green) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("refused", refused, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
