/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file expect-fail-kbuffer.c
 * Tests the tester: correct results are compared with values that are wrong by
 * as little as can be, in one pixel, in one entry or one layer; errors are left
 * and are missing.  The runner demands that each of these fails.
 */

#include "kbuffer-common.h"

#define W 16

/** Entries hold e + 1 everywhere. */
static struct kb
drawn(GLenum format, int attachments, int layers)
{
	struct kb kb = kb_create(format, attachments, layers, W, W);
	char body[1024] = "";

	for (int e = 0; e < kb_entries(&kb); e++)
		sprintf(body + strlen(body),
			"MUL result.kbuffer[%d], fragment.color, %d;\n", e,
			e + 1);
	kb_program(body);
	kb_fragment_value(1, 1, 1, 1);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	return kb;
}

/** One unit in the last place of one component. */
static enum piglit_result
wrong_bit(void *data)
{
	static const uint32_t nearly_one[4] = {
		0x3f800000, 0x3f800000, 0x3f800000, 0x3f800001
	};
	struct kb kb = drawn(GL_RGBA32F, 1, 0);

	return kb_expect_bits(&kb, 0, nearly_one) ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** One of the 256 values of a component. */
static enum piglit_result
wrong_byte(void *data)
{
	struct kb kb = drawn(GL_RGBA8, 1, 0);

	return kb_expect(&kb, 0, 0, 1, 254 / 255.f, 1, 1) ? PIGLIT_PASS :
		PIGLIT_FAIL;
}

static enum piglit_result
wrong_pixel(void *data)
{
	struct kb kb = drawn(GL_RGBA32F, 1, 0);

	glEnable(GL_SCISSOR_TEST);
	glScissor(W - 1, W - 1, 1, 1);
	glClear(GL_COLOR_BUFFER_BIT);
	return kb_expect(&kb, 0, 0, 1, 1, 1, 1) ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Of its neighbour. */
static enum piglit_result
wrong_entry(void *data)
{
	struct kb kb = drawn(GL_RGBA32F, 2, 0);

	return kb_expect(&kb, 1, 0, 1, 1, 1, 1) ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
wrong_layer(void *data)
{
	struct kb kb = drawn(GL_RGBA32F, 1, 3);

	return kb_expect(&kb, 2, 0, 2, 2, 2, 2) ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
left_error(void *data)
{
	glEnable(GL_PROGRAM_LENGTH_ARB);
	return PIGLIT_PASS;
}

static enum piglit_result
missing_error(void *data)
{
	drawn(GL_RGBA32F, 1, 0);
	return piglit_check_gl_error(GL_INVALID_OPERATION) ? PIGLIT_PASS :
		PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("wrong-bit", wrong_bit, NULL),
	KB_SUBTEST("wrong-byte", wrong_byte, NULL),
	KB_SUBTEST("wrong-pixel", wrong_pixel, NULL),
	KB_SUBTEST("wrong-entry", wrong_entry, NULL),
	KB_SUBTEST("wrong-layer", wrong_layer, NULL),
	KB_SUBTEST("left-error", left_error, NULL),
	KB_SUBTEST("missing-error", missing_error, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(30)
