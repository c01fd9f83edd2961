/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-replace.c
 * The smallest use: a program that moves the fragment's color into entry 0
 * runs in place of blending, when enabled and only then.
 */

#include "kbuffer-common.h"

static enum piglit_result
replace(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, 64, 64);
	bool pass = true;

	kb_program("MOV result.kbuffer[0], fragment.color.wzyx;");
	kb_fragment_value(0.125f, 2.0f, -3.0f, 0.75f);

	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 0.125f, 2.0f, -3.0f, 0.75f) && pass;

	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 0.75f, -3.0f, 2.0f, 0.125f) && pass;

	glDisable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 0.125f, 2.0f, -3.0f, 0.75f) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
covered_only(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, 64, 64);
	static const float inside[4] = { 2, 4, 6, 8 }, outside[4];

	kb_program("ADD result.kbuffer[0], fragment.color, fragment.color;");
	kb_fragment_value(1, 2, 3, 4);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw_rect(&kb, 3, 5, 30, 20, 0.5f);
	return kb_expect_only_rect(&kb, 0, 3, 5, 30, 20, inside, outside) ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("replace", replace, NULL),
	KB_SUBTEST("covered-only", covered_only, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(20)
