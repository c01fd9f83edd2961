/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-conversion.c
 * What the program writes is stored as the same color is by a fragment without
 * blending and without the extension, in every format, also where it is NaN,
 * infinite, out of range, denormal, or half way between two values.
 */

#include "kbuffer-values.h"

static bool
check(const struct kb_format *f, int layers)
{
	kb_values values, plain, got;
	const int last = MAX2(layers, 1) - 1;
	struct kb kb;

	kb_hard_values(f, values);
	kb = kb_create_values(f, 0);
	kb_use_values(f, values);
	kb_draw(&kb);
	kb_read_values(&kb, f, 0, plain);

	kb = kb_create_values(f, layers);
	kb_use_values(f, values);
	kb_program(layers ? "MOV result.kbuffer[3], fragment.color;" :
		   "MOV result.kbuffer[0], fragment.color;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	glDisable(GL_KBUFFER_PROGRAM_MESA);
	kb_read_values(&kb, f, last, got);
	return kb_check_values(f, values, plain, got);
}

static enum piglit_result
test_format(void *format)
{
	return !kb_is_renderable(format) ||
		(check(format, 0) && check(format, 4)) ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_COLOR_FORMATS(KB_FORMAT_SUBTEST)
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
