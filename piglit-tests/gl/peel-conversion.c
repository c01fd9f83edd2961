/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-conversion.c
 * The color of a fragment that is inserted is stored as it is without blending
 * and without the extension, in every format, also where it is NaN, infinite,
 * out of range, denormal, or half way between two values.
 */

#include "kbuffer-values.h"
#include "peel-common.h"

#define K 3

static enum piglit_result
test_format(void *format)
{
	const struct kb_format *f = format;
	kb_values values, plain, got;
	struct kb kb;
	bool pass = true;

	if (!kb_is_renderable(f))
		return PIGLIT_PASS;
	kb_hard_values(f, values);
	kb = kb_create_values(f, K);
	kb_attach_depth(&kb, GL_DEPTH_COMPONENT32F);
	kb_use_values(f, values);
	kb_draw(&kb);
	kb_read_values(&kb, f, 0, plain);

	/* The first is behind the second in the end. */
	glClear(GL_DEPTH_BUFFER_BIT);
	glEnable(GL_DEPTH_PEELING_MESA);
	for (int i = 0; i < 2; i++)
		kb_draw_rect(&kb, 0, 0, kb.width, kb.height, .75 - i * .5);
	glDisable(GL_DEPTH_PEELING_MESA);
	for (int i = 0; i < 2; i++) {
		kb_read_values(&kb, f, i, got);
		pass = kb_check_values(f, values, plain, got) && pass;
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_COLOR_FORMATS(KB_FORMAT_SUBTEST)
	KB_INTEGER_FORMATS(KB_FORMAT_SUBTEST)
	KB_SUBTEST_END
};

PEEL_TEST(32)
