/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-kil.c
 * A fragment that the k-buffer program kills keeps all entries bit for bit,
 * wherever the KIL stands; depth and stencil were written before it ran.
 */

#include "kbuffer-common.h"

#define W 32

static const uint32_t odd[4] = { 0x7f800001, 0x00000001, 0x80000000, 0x3f800001 };

/** KIL as first, middle and last instruction. */
static enum piglit_result
keeps_all_entries(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 2, 2, W, W);
	bool pass = true;

	for (int e = 0; e < 4; e++)
		kb_fill_bits(&kb, e, odd);
	kb_program((const char *)data);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	for (int e = 0; e < 4; e++)
		pass = kb_expect_bits(&kb, e, odd) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Any of the four components that is negative kills; zero does not. */
static enum piglit_result
condition(void *data)
{
	static const float values[6][4] = {
		{ -1, 1, 1, 1 }, { 1, -1, 1, 1 }, { 1, 1, -1e-20, 1 },
		{ 1, 1, 1, -INFINITY }, { 0, 0, 0, 0 }, { 1, 2, 3, 4 },
	};
	bool pass = true;

	for (int i = 0; i < 6; i++) {
		struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
		const float e = i < 4 ? 5 : 9;

		kb_fill(&kb, 0, 5, 5, 5, 5);
		kb_program("KIL fragment.color;\nMOV result.kbuffer[0], 9;");
		kb_fragment_values(&values[i], 1);
		glEnable(GL_KBUFFER_PROGRAM_MESA);
		kb_draw(&kb);
		if (!kb_expect(&kb, 0, 0, e, e, e, e)) {
			printf("value %d\n", i);
			pass = false;
		}
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Pixel by pixel: those left of a diagonal are killed. */
static enum piglit_result
per_pixel(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	float *pixels;
	bool pass = true;

	kb_program("TEMP t;\nSUB t, fragment.position.x, fragment.position.y;\n"
		   "KIL t.x;\nADD result.kbuffer[0], kbuffer[0], 1;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	kb_draw(&kb);
	pixels = kb_read(&kb, 0);
	for (int y = 0; y < W; y++) {
		for (int x = 0; x < W; x++)
			pass = pixels[4 * (y * W + x)] == (x >= y ? 2 : 0) &&
				pass;
	}
	free(pixels);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** A condition that depends on the entry: a counter that stops at 3. */
static enum piglit_result
on_entry(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);

	kb_program("TEMP t;\nSUB t, 2, kbuffer[0];\nKIL t.x;\n"
		   "ADD result.kbuffer[0].x, kbuffer[0], 1;\n"
		   "ADD result.kbuffer[0].y, kbuffer[0], 10;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	for (int i = 0; i < 10; i++)
		kb_draw(&kb);
	return kb_expect(&kb, 0, 0, 3, 30, 0, 0) ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
nan_condition(void *data)
{
	static const float nan[1][4] = { { NAN, NAN, NAN, NAN } };
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);

	/* A comparison with NaN is false: neither is less than the other, so
	 * "kill unless less" kills, and a NaN itself is not negative. */
	kb_fill(&kb, 0, 5, 5, 5, 5);
	kb_program("TEMP t;\nSLT t, fragment.color, kbuffer[0];\n"
		   "SUB t, t, 0.5;\nKIL t;\nMOV result.kbuffer[0], 9;");
	kb_fragment_values(nan, 1);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	if (!kb_expect(&kb, 0, 0, 5, 5, 5, 5))
		return PIGLIT_FAIL;
	kb_program("TEMP t;\nSGE t, fragment.color, kbuffer[0];\n"
		   "CMP t.y, fragment.color, 1, 2;\n"
		   "MOV result.kbuffer[0], t;");
	kb_draw(&kb);
	return kb_expect(&kb, 0, 0, 0, 2, 0, 0) ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** The depth and stencil buffers are updated as if the fragment was drawn. */
static enum piglit_result
depth_and_stencil(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	GLuint ds;
	bool pass;

	glGenRenderbuffers(1, &ds);
	glBindRenderbuffer(GL_RENDERBUFFER, ds);
	glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, W, W);
	glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT,
				  GL_RENDERBUFFER, ds);
	glClearDepth(1);
	glClearStencil(7);
	glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
	glEnable(GL_DEPTH_TEST);
	glEnable(GL_STENCIL_TEST);
	glStencilFunc(GL_ALWAYS, 0, 255);
	glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);

	kb_fill(&kb, 0, 1, 2, 3, 4);
	kb_program("KIL -1;\nMOV result.kbuffer[0], 0;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw_rect(&kb, 0, 0, W, W, 0.25);
	pass = piglit_check_gl_error(GL_NO_ERROR);
	pass = kb_expect(&kb, 0, 0, 1, 2, 3, 4) && pass;
	pass = piglit_probe_rect_depth(0, 0, W, W, 0.25) && pass;
	pass = piglit_probe_rect_stencil(0, 0, W, W, 8) && pass;

	/* Behind it now: neither counted nor drawn. */
	kb_program("MOV result.kbuffer[0], 0;");
	kb_draw_rect(&kb, 0, 0, W, W, 0.5);
	pass = kb_expect(&kb, 0, 0, 1, 2, 3, 4) && pass;
	pass = piglit_probe_rect_stencil(0, 0, W, W, 8) && pass;
	glDeleteRenderbuffers(1, &ds);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** The fragment stage's own discard: the program does not run. */
static enum piglit_result
fragment_discard(void *data)
{
	static const char fp[] = "!!ARBfp1.0\nTEMP t;\n"
		"SUB t, fragment.position.x, 16;\nKIL t.x;\n"
		"MOV result.color, 1;\nEND\n";
	static const float inside[4] = { 2, 2, 2, 2 }, outside[4];
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);

	kb_program("MAD result.kbuffer[0], fragment.color, 2, kbuffer[0];");
	kb_fragment_value(1, 1, 1, 1);
	if (kb_load(GL_FRAGMENT_PROGRAM_ARB, fp, strlen(fp)))
		return PIGLIT_FAIL;
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	return kb_expect_only_rect(&kb, 0, 16, 0, 16, W, inside, outside) ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("first-instruction", keeps_all_entries,
		   "KIL -1;\nMOV result.kbuffer[0], 2;\n"
		   "MOV result.kbuffer[3], 2;"),
	KB_SUBTEST("middle-instruction", keeps_all_entries,
		   "MOV result.kbuffer[0], 2;\nKIL -1;\n"
		   "MOV result.kbuffer[3], 2;"),
	KB_SUBTEST("last-instruction", keeps_all_entries,
		   "MOV result.kbuffer[0], kbuffer[1];\n"
		   "MOV result.kbuffer[3].y, 2;\nKIL -1;"),
	KB_SUBTEST("only-instruction", keeps_all_entries, "KIL -1;"),
	KB_SUBTEST("condition", condition, NULL),
	KB_SUBTEST("per-pixel", per_pixel, NULL),
	KB_SUBTEST("on-entry", on_entry, NULL),
	KB_SUBTEST("nan-condition", nan_condition, NULL),
	KB_SUBTEST("depth-and-stencil", depth_and_stencil, NULL),
	KB_SUBTEST("fragment-discard", fragment_discard, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
