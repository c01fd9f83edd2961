/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-entries.c
 * Entry e is the color buffer of draw buffer (e mod A) in layer (e div A):
 * for every shape up to 64 entries, each is read and written where it should.
 */

#include "kbuffer-common.h"

#define W 16

struct shape { int attachments, layers; };

/** Distinct per entry, component and quadrant of the image. */
static float
value(int entry, int c)
{
	return entry * 8 + c + 1;
}

/** Rotate: entry e gets what entry e + 1 held, plus 1000. */
static enum piglit_result
rotate(void *data)
{
	const struct shape *shape = data;
	struct kb kb = kb_create(GL_RGBA32F, shape->attachments, shape->layers,
				 W, W);
	const int n = MIN2(kb_entries(&kb), 64);
	char *body = calloc(n, 64), *end = body;
	bool pass = true;

	for (int e = 0; e < kb_entries(&kb); e++)
		kb_fill(&kb, e, value(e, 0), value(e, 1), value(e, 2),
			value(e, 3));
	for (int e = 0; e < n; e++)
		end += sprintf(end, "ADD result.kbuffer[%d], kbuffer[%d], "
			       "1000;\n", e, (e + 1) % n);
	kb_program(body);
	free(body);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw_rect(&kb, 0, 0, W / 2, W, 0.5);

	for (int e = 0; e < kb_entries(&kb); e++) {
		const int from = (e + 1) % n;
		const float add = e < n ? 1000 : 0;
		const int f = e < n ? from : e;

		pass = kb_expect_rect(&kb, e, 0, 0, W / 2, W, 0,
				      value(f, 0) + add, value(f, 1) + add,
				      value(f, 2) + add, value(f, 3) + add) &&
		       kb_expect_rect(&kb, e, W / 2, 0, W / 2, W, 0,
				      value(e, 0), value(e, 1), value(e, 2),
				      value(e, 3)) && pass;
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** One entry of many is touched; all others keep their value. */
static enum piglit_result
one_of_many(void *data)
{
	const struct shape *shape = data;
	bool pass = true;

	for (int i = 0; i < 4; i++) {
		struct kb kb = kb_create(GL_RGBA32F, shape->attachments,
					 shape->layers, W, W);
		const int n = kb_entries(&kb), which = (n - 1) * i / 3;
		char body[128];

		for (int e = 0; e < n; e++)
			kb_fill(&kb, e, value(e, 0), 0, 0, value(e, 3));
		snprintf(body, sizeof(body),
			 "ADD result.kbuffer[%d].xw, kbuffer[%d], 1000;",
			 which, which);
		kb_program(body);
		glEnable(GL_KBUFFER_PROGRAM_MESA);
		kb_draw(&kb);
		for (int e = 0; e < n; e++) {
			const float add = e == which ? 1000 : 0;

			pass = kb_expect(&kb, e, 0, value(e, 0) + add, 0, 0,
					 value(e, 3) + add) && pass;
		}
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Color output n of the fragment stage goes to entry n by the program. */
static enum piglit_result
eight_colors(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 8, 0, W, W);
	float values[8][4];
	char body[1024] = "", *end = body;
	bool pass = true;

	for (int i = 0; i < 8; i++) {
		for (int c = 0; c < 4; c++)
			values[i][c] = value(i, c);
		end += sprintf(end, "ADD result.kbuffer[%d], kbuffer[%d], "
			       "fragment.color[%d];\n", 7 - i, 7 - i, i);
	}
	kb_program(body);
	kb_fragment_values(values, 8);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	for (int i = 0; i < 3; i++)
		kb_draw(&kb);
	for (int i = 0; i < 8; i++) {
		const float *v = values[i];

		pass = kb_expect(&kb, 7 - i, 0, 3 * v[0], 3 * v[1], 3 * v[2],
				 3 * v[3]) && pass;
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** The draw buffers, not the attachments, count: swapped and repeated use. */
static enum piglit_result
draw_buffer_order(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 3, 0, W, W);

	glDrawBuffers(2, (GLenum[]) { GL_COLOR_ATTACHMENT2,
				      GL_COLOR_ATTACHMENT0 });
	kb_program("MOV result.kbuffer[0], 1;\nMOV result.kbuffer[1], 2;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	return kb_expect(&kb, 0, 0, 2, 2, 2, 2) &&
		kb_expect(&kb, 1, 0, 0, 0, 0, 0) &&
		kb_expect(&kb, 2, 0, 1, 1, 1, 1) ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Attachments of different formats, sizes: each converts by its own. */
static enum piglit_result
mixed_formats(void *data)
{
	struct kb a = kb_create(GL_RGBA8, 1, 0, W, W);
	struct kb b = kb_create(GL_RGBA16F, 1, 0, W, 2 * W);
	struct kb c = kb_create(GL_R32F, 1, 0, 2 * W, W);
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	bool pass;

	glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, a.tex[0], 0);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT2, b.tex[0], 0);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT3, c.tex[0], 0);
	glDrawBuffers(4, (GLenum[]) {
		GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1,
		GL_COLOR_ATTACHMENT2, GL_COLOR_ATTACHMENT3 });
	kb_program("PARAM one = 1;\nADD result.kbuffer[0], kbuffer[0], one;\n"
		   "ADD result.kbuffer[1], kbuffer[1], 0.2;\n"
		   "ADD result.kbuffer[2], kbuffer[2], one;\n"
		   "ADD result.kbuffer[3], kbuffer[3], 0.1;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	kb_draw(&kb);
	pass = piglit_check_gl_error(GL_NO_ERROR);
	pass = kb_expect(&kb, 0, 0, 2, 2, 2, 2) && pass;
	/* 0.2 and 0.4 are 51 and 102 of 255. */
	pass = kb_expect(&a, 0, 1e-6, .4, .4, .4, .4) && pass;
	pass = kb_expect_rect(&b, 0, 0, 0, W, W, 0, 2, 2, 2, 2) && pass;
	pass = kb_expect_rect(&b, 0, 0, W, W, W, 0, 0, 0, 0, 0) && pass;
	pass = kb_expect_rect(&c, 0, 0, 0, W, W, 1e-7, .2, 0, 0, 1) && pass;
	pass = kb_expect_rect(&c, 0, W, 0, W, W, 0, 0, 0, 0, 1) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static const struct shape s1 = { 1, 0 }, s8 = { 8, 0 }, s1x1 = { 1, 1 },
	s8x8 = { 8, 8 }, s1x64 = { 1, 64 }, s3x21 = { 3, 21 }, s3x5 = { 3, 5 },
	s2x32 = { 2, 32 }, s5x20 = { 5, 20 };

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("1", rotate, &s1),
	KB_SUBTEST("8", rotate, &s8),
	KB_SUBTEST("1x1", rotate, &s1x1),
	KB_SUBTEST("8x8", rotate, &s8x8),
	KB_SUBTEST("1x64", rotate, &s1x64),
	KB_SUBTEST("2x32", rotate, &s2x32),
	KB_SUBTEST("3x5", rotate, &s3x5),
	KB_SUBTEST("3x21", rotate, &s3x21),
	/* 100 layers times attachments: the first 64 entries count. */
	KB_SUBTEST("more-than-64", rotate, &s5x20),
	KB_SUBTEST("one-of-8", one_of_many, &s8),
	KB_SUBTEST("one-of-8x8", one_of_many, &s8x8),
	KB_SUBTEST("one-of-1x64", one_of_many, &s1x64),
	KB_SUBTEST("eight-colors", eight_colors, NULL),
	KB_SUBTEST("draw-buffer-order", draw_buffer_order, NULL),
	KB_SUBTEST("mixed-formats", mixed_formats, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
