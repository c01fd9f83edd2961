/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-tests-before.c
 * The program runs for the fragments that pass scissor, stipple, alpha,
 * stencil and depth test, and for no others; those tests and their writes are
 * as without it.
 */

#include "kbuffer-common.h"

#define W 64

static const float zero[4], one[4] = { 1, 1, 1, 1 };

/** Counts fragments in entry 0. */
static struct kb
make(void)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);

	kb_program("ADD result.kbuffer[0], kbuffer[0], 1;");
	/* What a draw without the program would leave. */
	glColor4f(0, 0, 0, 0);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	return kb;
}

static void
attach_depth_stencil(void)
{
	GLuint rb;

	glGenRenderbuffers(1, &rb);
	glBindRenderbuffer(GL_RENDERBUFFER, rb);
	glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, W, W);
	glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT,
				  GL_RENDERBUFFER, rb);
	glClearDepth(1);
	glClearStencil(0);
	glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
}

static enum piglit_result
scissor(void *data)
{
	struct kb kb = make();

	glScissor(7, 9, 21, 30);
	glEnable(GL_SCISSOR_TEST);
	kb_draw(&kb);
	return kb_expect_only_rect(&kb, 0, 7, 9, 21, 30, one, zero) ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
stipple(void *data)
{
	struct kb kb = make();
	GLubyte pattern[128];
	float *got;
	bool pass = true;

	memset(pattern, 0xaa, sizeof(pattern));
	glPolygonStipple(pattern);
	glEnable(GL_POLYGON_STIPPLE);
	kb_draw(&kb);
	got = kb_read(&kb, 0);
	for (int i = 0; i < W * W; i++)
		pass = got[4 * i] == (i % 2 ? 0 : 1) && pass;
	if (!pass)
		printf("first pixels: %g %g\n", got[0], got[4]);
	free(got);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Alpha .25, .5, .75 with each function and the reference .5. */
static enum piglit_result
alpha(void *data)
{
	static const struct { GLenum func; int passing; } tests[] = {
		{ GL_NEVER, 0 }, { GL_LESS, 1 }, { GL_EQUAL, 2 },
		{ GL_LEQUAL, 3 }, { GL_GREATER, 4 }, { GL_NOTEQUAL, 5 },
		{ GL_GEQUAL, 6 }, { GL_ALWAYS, 7 },
	};
	bool pass = true;

	for (int i = 0; i < ARRAY_SIZE(tests); i++) {
		struct kb kb = make();

		/* Weights 1, 2, 4. */
		kb_program("ADD result.kbuffer[0].x, kbuffer[0], "
			   "fragment.color;");
		glAlphaFunc(tests[i].func, .5);
		glEnable(GL_ALPHA_TEST);
		for (int a = 0; a < 3; a++) {
			kb_fragment_value(1 << a, 0, 0, .25 * (a + 1));
			kb_draw(&kb);
		}
		if (!kb_expect(&kb, 0, 0, tests[i].passing, 0, 0, 0)) {
			printf("%s\n", piglit_get_gl_enum_name(tests[i].func));
			pass = false;
		}
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Depths .25, .5, .75 before a buffer of .5. */
static enum piglit_result
depth(void *data)
{
	static const struct { GLenum func; int passing; } tests[] = {
		{ GL_NEVER, 0 }, { GL_LESS, 1 }, { GL_EQUAL, 2 },
		{ GL_LEQUAL, 3 }, { GL_GREATER, 4 }, { GL_NOTEQUAL, 5 },
		{ GL_GEQUAL, 6 }, { GL_ALWAYS, 7 },
	};
	static const GLenum formats[] = {
		GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT24,
		GL_DEPTH_COMPONENT32F,
	};
	bool pass = true;

	for (int f = 0; f < ARRAY_SIZE(formats) * ARRAY_SIZE(tests); f++) {
		const int i = f % ARRAY_SIZE(tests);
		struct kb kb = make();

		kb_attach_depth(&kb, formats[f / ARRAY_SIZE(tests)]);
		kb_program("ADD result.kbuffer[0].x, kbuffer[0], "
			   "fragment.color;");
		glClearDepth(1);
		glClear(GL_DEPTH_BUFFER_BIT);
		glEnable(GL_DEPTH_TEST);
		glDepthFunc(GL_ALWAYS);
		glDepthMask(GL_TRUE);
		kb_fragment_value(0, 0, 0, 0);
		kb_draw(&kb);
		glDepthMask(GL_FALSE);
		glDepthFunc(tests[i].func);
		for (int a = 0; a < 3; a++) {
			kb_fragment_value(1 << a, 0, 0, 0);
			kb_draw_rect(&kb, 0, 0, W, W, .25 * (a + 1));
		}
		if (!kb_expect(&kb, 0, 0, tests[i].passing, 0, 0, 0)) {
			printf("%s\n", piglit_get_gl_enum_name(tests[i].func));
			pass = false;
		}
		glDepthMask(GL_TRUE);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Depth is written by what passes, and tested by what comes next. */
static enum piglit_result
depth_writes(void *data)
{
	static const float z[6] = { .5, .75, .25, .375, .25, .125 };
	struct kb kb = make();
	bool pass;

	kb_attach_depth(&kb, GL_DEPTH_COMPONENT24);
	glClearDepth(1);
	glClear(GL_DEPTH_BUFFER_BIT);
	glEnable(GL_DEPTH_TEST);
	glDepthFunc(GL_LESS);
	for (int i = 0; i < 6; i++)
		kb_draw_rect(&kb, 0, 0, W, W, z[i]);
	pass = kb_expect(&kb, 0, 0, 3, 3, 3, 3);
	pass = piglit_probe_rect_depth(0, 0, W, W, .125) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Alpha test and shader depth: the depth test comes late. */
static enum piglit_result
late_depth(void *data)
{
	static const char fp[] = "!!ARBfp1.0\nTEMP t;\n"
		"SGE t, fragment.position.x, 32;\n"
		"MAD result.depth.z, t.x, 0.5, 0.25;\n"
		"MOV result.color, 0;\nEND\n";
	struct kb kb = make();
	bool pass;

	kb_attach_depth(&kb, GL_DEPTH_COMPONENT32F);
	glClearDepth(.5);
	glClear(GL_DEPTH_BUFFER_BIT);
	glEnable(GL_DEPTH_TEST);
	kb_fragment_value(0, 0, 0, 0);
	if (kb_load(GL_FRAGMENT_PROGRAM_ARB, fp, strlen(fp)))
		return PIGLIT_FAIL;
	kb_draw_rect(&kb, 0, 0, W, W, .9);
	pass = kb_expect_only_rect(&kb, 0, 0, 0, 32, W, one, zero);
	pass = piglit_probe_rect_depth(0, 0, 32, W, .25) && pass;
	pass = piglit_probe_rect_depth(32, 0, 32, W, .5) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
stencil(void *data)
{
	struct kb kb = make();
	bool pass;

	attach_depth_stencil();
	glEnable(GL_STENCIL_TEST);
	/* Mark a rectangle; color is masked, so that nothing is counted. */
	glStencilFunc(GL_ALWAYS, 1, 255);
	glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
	glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
	kb_draw_rect(&kb, 10, 20, 30, 25, .5);
	glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
	pass = kb_expect(&kb, 0, 0, 0, 0, 0, 0);

	/* Fail, depth fail and pass are told apart. */
	glStencilFunc(GL_EQUAL, 1, 255);
	glStencilOp(GL_INVERT, GL_KEEP, GL_INCR);
	kb_draw(&kb);
	pass = kb_expect_only_rect(&kb, 0, 10, 20, 30, 25, one, zero) && pass;
	pass = piglit_probe_rect_stencil(10, 20, 30, 25, 2) && pass;
	pass = piglit_probe_rect_stencil(0, 0, 10, W, 255) && pass;

	glEnable(GL_DEPTH_TEST);
	glDepthFunc(GL_NEVER);
	glStencilFunc(GL_ALWAYS, 1, 255);
	glStencilOp(GL_KEEP, GL_ZERO, GL_KEEP);
	kb_draw(&kb);
	pass = kb_expect_only_rect(&kb, 0, 10, 20, 30, 25, one, zero) && pass;
	pass = piglit_probe_rect_stencil(0, 0, W, W, 0) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
rasterizer_discard(void *data)
{
	struct kb kb = make();

	kb_draw(&kb);
	glEnable(GL_RASTERIZER_DISCARD);
	kb_draw(&kb);
	glDisable(GL_RASTERIZER_DISCARD);
	return kb_expect(&kb, 0, 0, 1, 1, 1, 1) ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Points and lines make fragments, too. */
static enum piglit_result
points_and_lines(void *data)
{
	struct kb kb = make();

	glBegin(GL_POINTS);
	glVertex2f((2 * 20.5f) / W - 1, (2 * 30.5f) / W - 1);
	glEnd();
	glPointSize(5);
	glBegin(GL_POINTS);
	glVertex2f((2 * 20.5f) / W - 1, (2 * 30.5f) / W - 1);
	glEnd();
	glBegin(GL_LINES);
	/* From pixel (3, 5) up to, without, (43, 5). */
	glVertex2f((2 * 3.5f) / W - 1, (2 * 5.5f) / W - 1);
	glVertex2f((2 * 43.5f) / W - 1, (2 * 5.5f) / W - 1);
	glEnd();
	return kb_expect_rect(&kb, 0, 20, 30, 1, 1, 0, 2, 2, 2, 2) &&
		kb_expect_rect(&kb, 0, 18, 28, 2, 5, 0, 1, 1, 1, 1) &&
		kb_expect_rect(&kb, 0, 21, 28, 2, 5, 0, 1, 1, 1, 1) &&
		kb_expect_rect(&kb, 0, 3, 5, 40, 1, 0, 1, 1, 1, 1) &&
		kb_expect_rect(&kb, 0, 0, 6, W, 20, 0, 0, 0, 0, 0) ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("scissor", scissor, NULL),
	KB_SUBTEST("stipple", stipple, NULL),
	KB_SUBTEST("alpha", alpha, NULL),
	KB_SUBTEST("depth", depth, NULL),
	KB_SUBTEST("depth-writes", depth_writes, NULL),
	KB_SUBTEST("late-depth", late_depth, NULL),
	KB_SUBTEST("stencil", stencil, NULL),
	KB_SUBTEST("rasterizer-discard", rasterizer_discard, NULL),
	KB_SUBTEST("points-and-lines", points_and_lines, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
