/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-enable.c
 * GL_KBUFFER_PROGRAM_MESA is a capability: initially disabled, enabled and
 * disabled, queried, saved by PushAttrib(ENABLE_BIT) and compiled into display
 * lists like any other.
 */

#include "kbuffer-capability.h"

/** What a popped enable says is what the next draw does. */
static enum piglit_result
pop_takes_effect(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, 8, 8);
	bool pass;

	kb_program("MOV result.kbuffer[0], 3;");
	kb_fragment_value(1, 1, 1, 1);
	glPushAttrib(GL_ENABLE_BIT);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 3, 3, 3, 3);
	glPopAttrib();
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 1, 1, 1, 1) && pass;

	glEnable(GL_KBUFFER_PROGRAM_MESA);
	glPushAttrib(GL_ALL_ATTRIB_BITS);
	glDisable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	glPopAttrib();
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 3, 3, 3, 3) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_CAPABILITY_SUBTESTS(GL_KBUFFER_PROGRAM_MESA, "color-buffer-bit",
			       GL_COLOR_BUFFER_BIT),
	KB_SUBTEST("pop-takes-effect", pop_takes_effect, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(30)
