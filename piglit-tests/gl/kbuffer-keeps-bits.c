/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-keeps-bits.c
 * An entry or a component that is not written keeps its bits, and what is
 * only moved or selected is moved bit for bit: NaN payloads, denormalized
 * numbers, infinities, negative zero.
 */

#include "kbuffer-common.h"

/* Two signalling NaNs, a quiet one, smallest and largest denormalized number,
 * infinity, negative zero, an ordinary value. */
static const uint32_t odd[8] = {
	0x7f800001, 0xffbfffff, 0x7fc12345, 0x00000001,
	0x807fffff, 0xff800000, 0x80000000, 0x3f800001,
};

static void
fill(const struct kb *kb)
{
	for (int e = 0; e < kb_entries(kb); e++)
		kb_fill_bits(kb, e, e % 2 ? odd + 4 : odd);
}

static bool
check_filled(const struct kb *kb, int entry)
{
	return kb_expect_bits(kb, entry, entry % 2 ? odd + 4 : odd);
}

/** The upload and the readback themselves keep bits. */
static enum piglit_result
no_draw(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 2, 0, 16, 16);

	fill(&kb);
	return check_filled(&kb, 0) && check_filled(&kb, 1) ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
unwritten_entries(void *data)
{
	const int layers = (int)(intptr_t)data;
	struct kb kb = kb_create(GL_RGBA32F, 4, layers, 16, 16);
	bool pass = true;

	fill(&kb);
	kb_program("MOV result.kbuffer[2], fragment.color;");
	kb_fragment_value(1, 2, 3, 4);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	for (int e = 0; e < kb_entries(&kb); e++) {
		if (e == 2)
			pass = kb_expect(&kb, e, 0, 1, 2, 3, 4) && pass;
		else
			pass = check_filled(&kb, e) && pass;
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Nothing is written at all. */
static enum piglit_result
no_output(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 2, 0, 16, 16);

	fill(&kb);
	kb_program("TEMP t;\nADD t, kbuffer[0], kbuffer[1];");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	return check_filled(&kb, 0) && check_filled(&kb, 1) ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

/** All 15 write masks. */
static enum piglit_result
unwritten_components(void *data)
{
	bool pass = true;

	for (int mask = 1; mask < 16; mask++) {
		struct kb kb = kb_create(GL_RGBA32F, 2, 0, 16, 16);
		uint32_t expected[2][4];
		char body[128], letters[5] = "", *l = letters;

		for (int c = 0; c < 4; c++) {
			if (mask & 1 << c)
				*l++ = "xyzw"[c];
		}
		*l = 0;
		snprintf(body, sizeof(body),
			 "MOV result.kbuffer[0].%s, 2;\n"
			 "MOV result.kbuffer[1].%s, kbuffer[0];",
			 letters, letters);
		fill(&kb);
		kb_program(body);
		glEnable(GL_KBUFFER_PROGRAM_MESA);
		kb_draw(&kb);
		for (int c = 0; c < 4; c++) {
			const bool written = mask & 1 << c;

			expected[0][c] = written ? 0x40000000 : odd[c];
			expected[1][c] = written ? odd[c] : odd[4 + c];
		}
		if (!kb_expect_bits(&kb, 0, expected[0]) ||
		    !kb_expect_bits(&kb, 1, expected[1])) {
			printf("write mask .%s\n", letters);
			pass = false;
		}
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** The same in formats of fewer bits: what is not written is not converted. */
static enum piglit_result
unwritten_in_format(void *data)
{
	const GLenum format = (GLenum)(intptr_t)data;
	struct kb kb = kb_create(format, 1, 0, 16, 16);
	float *before, *after;
	bool pass = true;

	kb_fill(&kb, 0, 0.1f, 0.3f, 0.7f, 0.9f);
	before = kb_read(&kb, 0);
	kb_program("MOV result.kbuffer[0].y, 0;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	for (int i = 0; i < 10; i++)
		kb_draw(&kb);
	after = kb_read(&kb, 0);
	for (int i = 0; i < 16 * 16 * 4 && pass; i++)
		pass = after[i] == (i % 4 == 1 ? 0 : before[i]);
	if (!pass)
		printf("%g %g %g %g became %g %g %g %g\n", before[0],
		       before[1], before[2], before[3], after[0], after[1],
		       after[2], after[3]);
	free(before);
	free(after);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** MOV through entries, temporaries and swizzles. */
static enum piglit_result
moved(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 2, 0, 16, 16);
	const uint32_t reversed[4] = { odd[3], odd[2], odd[1], odd[0] };

	fill(&kb);
	kb_program("TEMP t, u;\nMOV t, kbuffer[0];\nMOV u, t.wzyx;\n"
		   "MOV result.kbuffer[0], kbuffer[1];\n"
		   "MOV result.kbuffer[1], u;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	return kb_expect_bits(&kb, 0, odd + 4) &&
		kb_expect_bits(&kb, 1, reversed) ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** CMP selects; what is not selected does not matter. */
static enum piglit_result
selected(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 2, 0, 16, 16);
	const uint32_t expected[2][4] = {
		{ odd[4], odd[1], odd[6], odd[3] },
		{ odd[0], odd[5], odd[2], odd[7] },
	};

	fill(&kb);
	kb_program("PARAM s = { 1, -1, 0, -2 };\n"
		   "CMP result.kbuffer[0], s, kbuffer[0], kbuffer[1];\n"
		   "CMP result.kbuffer[1], s, kbuffer[1], kbuffer[0];");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	return kb_expect_bits(&kb, 0, expected[0]) &&
		kb_expect_bits(&kb, 1, expected[1]) ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("no-draw", no_draw, NULL),
	KB_SUBTEST("unwritten-entries", unwritten_entries, 0),
	KB_SUBTEST("unwritten-entries-in-layers", unwritten_entries, 3),
	KB_SUBTEST("no-output", no_output, NULL),
	KB_SUBTEST("unwritten-components", unwritten_components, NULL),
	KB_SUBTEST("unwritten-in-rgba8", unwritten_in_format, GL_RGBA8),
	KB_SUBTEST("unwritten-in-rgba16", unwritten_in_format, GL_RGBA16),
	KB_SUBTEST("unwritten-in-rgba16f", unwritten_in_format, GL_RGBA16F),
	KB_SUBTEST("unwritten-in-rgb10-a2", unwritten_in_format, GL_RGB10_A2),
	KB_SUBTEST("unwritten-in-srgb8-alpha8", unwritten_in_format,
		   GL_SRGB8_ALPHA8),
	KB_SUBTEST("moved", moved, NULL),
	KB_SUBTEST("selected", selected, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
