/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file expect-fail-wrong-value.c
 * Tests the tester: a correct result is compared with a wrong value, one unit
 * in the last place away.  The runner demands that this fails.
 */

#include "kbuffer-common.h"

static enum piglit_result
wrong_value(void *data)
{
	static const uint32_t nearly_one[4] = {
		0x3f800000, 0x3f800000, 0x3f800000, 0x3f800001
	};
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, 64, 64);

	kb_program("MOV result.kbuffer[0], fragment.color;");
	kb_fragment_value(1, 1, 1, 1);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	return kb_expect_bits(&kb, 0, nearly_one) ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
left_error(void *data)
{
	glEnable(GL_PROGRAM_LENGTH_ARB);
	return PIGLIT_PASS;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("wrong-value", wrong_value, NULL),
	KB_SUBTEST("left-error", left_error, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(20)
