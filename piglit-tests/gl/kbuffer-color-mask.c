/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-color-mask.c
 * The color mask of draw buffer (e mod A) applies to entry e, by component;
 * what it hides keeps its bits.
 */

#include "kbuffer-common.h"

static const uint32_t old[4] = { 0x7f800001, 0x00000001, 0x80000000, 0x42f60000 };

/** Fill with the odd bits, replace all by { 1, 2, 3, 4 } + e, compare. */
static bool
run(int attachments, int layers, const unsigned *masks)
{
	struct kb kb = kb_create(GL_RGBA32F, attachments, layers, 16, 16);
	char body[2048] = "", *end = body;
	bool pass = true;

	for (int e = 0; e < kb_entries(&kb); e++) {
		kb_fill_bits(&kb, e, old);
		end += sprintf(end, "MOV result.kbuffer[%d], "
			       "{ %d, %d, %d, %d };\n", e, 1 + e, 2 + e, 3 + e,
			       4 + e);
	}
	kb_program(body);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	for (int e = 0; e < kb_entries(&kb); e++) {
		const unsigned mask = masks[e % attachments];
		uint32_t expected[4];

		for (int c = 0; c < 4; c++) {
			const float value = c + 1 + e;

			memcpy(&expected[c], &value, 4);
			if (!(mask & 1 << c))
				expected[c] = old[c];
		}
		pass = kb_expect_bits(&kb, e, expected) && pass;
	}
	return pass;
}

static enum piglit_result
all_masks(void *data)
{
	bool pass = true;

	for (unsigned mask = 0; mask < 16; mask++) {
		const unsigned masks[2] = { mask, mask };

		glColorMask(mask & 1, mask & 2, mask & 4, mask & 8);
		if (!run(2, 0, masks)) {
			printf("mask %#x\n", mask);
			pass = false;
		}
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
by_draw_buffer(void *data)
{
	const int layers = (int)(intptr_t)data;
	static const unsigned masks[4] = { 0xf, 0x5, 0x0, 0x8 };

	for (int i = 0; i < 4; i++)
		glColorMaski(i, masks[i] & 1, masks[i] & 2, masks[i] & 4,
			     masks[i] & 8);
	return run(4, layers, masks) ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Together with a program that writes part of the components. */
static enum piglit_result
with_write_mask(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, 16, 16);

	kb_fill(&kb, 0, 1, 2, 3, 4);
	kb_program("ADD result.kbuffer[0].xyz, kbuffer[0], 10;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	glColorMask(GL_FALSE, GL_TRUE, GL_TRUE, GL_TRUE);
	kb_draw(&kb);
	return kb_expect(&kb, 0, 0, 1, 12, 13, 4) ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** In a packed format the neighbours' bits are in the same word. */
static enum piglit_result
format(void *data)
{
	struct kb kb = kb_create((GLenum)(intptr_t)data, 1, 0, 16, 16);
	float *before, *after;
	bool pass = true;

	kb_fill(&kb, 0, 0.1f, 0.3f, 0.7f, 0.9f);
	before = kb_read(&kb, 0);
	kb_program("MOV result.kbuffer[0], 1;");
	/* What a draw without the program would leave. */
	glColor4f(0, 0, 0, 0);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_TRUE);
	kb_draw(&kb);
	after = kb_read(&kb, 0);
	for (int i = 0; i < 16 * 16 * 4 && pass; i++)
		pass = after[i] == (i % 2 ? 1 : before[i]);
	if (!pass)
		printf("%g %g %g %g became %g %g %g %g\n", before[0],
		       before[1], before[2], before[3], after[0], after[1],
		       after[2], after[3]);
	free(before);
	free(after);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** A mask changes what is written, not what is read. */
static enum piglit_result
masked_is_read(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 2, 0, 16, 16);

	kb_fill(&kb, 0, 1, 2, 3, 4);
	kb_program("ADD result.kbuffer[1], kbuffer[1], kbuffer[0];\n"
		   "MOV result.kbuffer[0], 9;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	glColorMaski(0, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
	kb_draw(&kb);
	kb_draw(&kb);
	return kb_expect(&kb, 0, 0, 1, 2, 3, 4) &&
		kb_expect(&kb, 1, 0, 2, 4, 6, 8) ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("all-masks", all_masks, NULL),
	KB_SUBTEST("by-draw-buffer", by_draw_buffer, 0),
	KB_SUBTEST("by-draw-buffer-in-layers", by_draw_buffer, 3),
	KB_SUBTEST("with-write-mask", with_write_mask, NULL),
	KB_SUBTEST("rgba8", format, GL_RGBA8),
	KB_SUBTEST("rgb10-a2", format, GL_RGB10_A2),
	KB_SUBTEST("rgba4", format, GL_RGBA4),
	KB_SUBTEST("rgba16f", format, GL_RGBA16F),
	KB_SUBTEST("masked-is-read", masked_is_read, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
