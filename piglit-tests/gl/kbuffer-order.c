/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-order.c
 * The programs of one sample run one after the other in primitive order, over
 * thousands of overlapping fragments, within a draw and from draw to draw,
 * with no command between them.
 *
 * The accumulation is x' = (1229 x + c) mod 4096.  It depends on the order of
 * all fragments, and is exact: 1229 * 4095 + 4095 < 2^24, and the division by
 * 4096 only changes the exponent.
 */

#include "kbuffer-common.h"

/* Several tiles of 64x64 and parts of such. */
#define W 200
#define H 150

struct rect { int x, y, w, h, c; };

static const char accumulate[] =
	"TEMP t;\n"
	/* 0.300048828125 = 1229 / 4096; the color is c / 4096. */
	"MAD t.x, kbuffer[0].x, 0.300048828125, fragment.color.x;\n"
	"FRC t.x, t.x;\nMUL result.kbuffer[0].x, t.x, 4096;\n"
	/* And the number of fragments. */
	"ADD result.kbuffer[0].y, kbuffer[0].y, 1;";

static uint32_t state;

static int
random_below(int n)
{
	state = state * 1664525 + 1013904223;
	return (state >> 8) % n;
}

static struct rect *
random_rects(int n)
{
	struct rect *r = malloc(n * sizeof(*r));

	state = 1;
	for (int i = 0; i < n; i++) {
		/* Every fourth is small, for many primitives in one tile. */
		const int max = i % 4 ? W : 12;

		r[i].x = random_below(W);
		r[i].y = random_below(H);
		r[i].w = 1 + random_below(max);
		r[i].h = 1 + random_below(max);
		r[i].c = random_below(4096);
	}
	return r;
}

static void
vertices(const struct rect *r)
{
	const float x0 = 2.0f * r->x / W - 1, x1 = 2.0f * (r->x + r->w) / W - 1;
	const float y0 = 2.0f * r->y / H - 1, y1 = 2.0f * (r->y + r->h) / H - 1;

	glColor4f(r->c / 4096.0f, 0, 0, 0);
	glVertex2f(x0, y0);
	glVertex2f(x1, y0);
	glVertex2f(x1, y1);
	glVertex2f(x0, y1);
}

static bool
check(const struct kb *kb, const struct rect *rects, int n)
{
	int *value = calloc(W * H, sizeof(int));
	int *count = calloc(W * H, sizeof(int));
	float *got = kb_read(kb, 0);
	bool pass = true;

	for (int i = 0; i < n; i++) {
		const struct rect *r = rects + i;

		for (int y = r->y; y < MIN2(r->y + r->h, H); y++) {
			for (int x = r->x; x < MIN2(r->x + r->w, W); x++) {
				int *v = value + y * W + x;

				*v = (*v * 1229 + r->c) % 4096;
				count[y * W + x]++;
			}
		}
	}
	for (int i = 0; i < W * H && pass; i++) {
		pass = got[4 * i] == value[i] && got[4 * i + 1] == count[i];
		if (!pass)
			printf("(%d, %d): %g after %g fragments, expected %d "
			       "after %d\n", i % W, i / W, got[4 * i],
			       got[4 * i + 1], value[i], count[i]);
	}
	free(value);
	free(count);
	free(got);
	return pass;
}

enum how { ONE_DRAW, MANY_DRAWS, PROGRAM_CHANGES, QUERIES_AND_FLUSHES };

static enum piglit_result
rects(void *data)
{
	const enum how how = (enum how)(intptr_t)data;
	const int n = how == ONE_DRAW ? 6000 : 2000;
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, H);
	struct rect *r = random_rects(n);
	GLuint programs[2], query;
	bool pass;

	/* Flat, so that the color reaches the program exactly. */
	glShadeModel(GL_FLAT);
	programs[0] = kb_program(accumulate);
	/* The same meaning with an entry read and written back as a whole. */
	programs[1] = kb_program(
		"TEMP t, u;\nMOV u, kbuffer[0];\n"
		"MUL t.x, u.x, 0.300048828125;\n"
		"ADD t.x, t.x, fragment.color.x;\nFRC t.x, t.x;\n"
		"MUL u.x, t.x, 4096;\nADD u.y, u.y, 1;\n"
		"MOV result.kbuffer[0], u;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	glGenQueries(1, &query);
	if (how == ONE_DRAW)
		glBegin(GL_QUADS);
	for (int i = 0; i < n; i++) {
		if (how == PROGRAM_CHANGES)
			glBindProgramARB(GL_KBUFFER_PROGRAM_MESA,
					 programs[i % 2]);
		if (how == QUERIES_AND_FLUSHES && i % 100 == 0)
			glBeginQuery(GL_SAMPLES_PASSED, query);
		if (how != ONE_DRAW)
			glBegin(GL_QUADS);
		vertices(r + i);
		if (how != ONE_DRAW)
			glEnd();
		if (how == QUERIES_AND_FLUSHES && i % 100 == 50)
			glEndQuery(GL_SAMPLES_PASSED);
		if (how == QUERIES_AND_FLUSHES && i % 130 == 0)
			glFlush();
	}
	if (how == ONE_DRAW)
		glEnd();
	pass = check(&kb, r, n);
	glDeleteQueries(1, &query);
	free(r);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Many primitives of one small area: one bin has all the work. */
static enum piglit_result
one_pixel_often(void *data)
{
	const int n = 20000;
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, H);
	struct rect *r = random_rects(n);
	bool pass;

	for (int i = 0; i < n; i++)
		r[i] = (struct rect) { 100 + i % 3, 63, 2, 2, r[i].c };
	glShadeModel(GL_FLAT);
	kb_program(accumulate);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	glBegin(GL_QUADS);
	for (int i = 0; i < n; i++)
		vertices(r + i);
	glEnd();
	pass = check(&kb, r, n);
	free(r);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static void
fan(void)
{
	glBegin(GL_TRIANGLE_FAN);
	glVertex2f(0.137, -0.211);
	for (int i = 0; i <= 720; i++) {
		/* Far outside: the whole framebuffer is covered. */
		glVertex2f(3 * cos(M_PI / 360 * (i % 720)),
			   3 * sin(M_PI / 360 * (i % 720)));
	}
	glEnd();
}

/**
 * Triangles that share edges: the program runs as often as blending does,
 * which with thin triangles is not always once.
 */
static enum piglit_result
shared_edges(void *data)
{
	struct kb blended = kb_create(GL_RGBA32F, 1, 0, W, H), kb;
	float *wanted, *got;
	bool pass = true;

	kb_fragment_value(1, 1, 1, 1);
	glEnable(GL_BLEND);
	glBlendFunc(GL_ONE, GL_ONE);
	fan();
	wanted = kb_read(&blended, 0);

	kb = kb_create(GL_RGBA32F, 1, 0, W, H);
	/* Twice what was blended, which a draw without it does not give. */
	kb_program("MAD result.kbuffer[0], fragment.color, 2, kbuffer[0];");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	fan();
	got = kb_read(&kb, 0);
	for (int i = 0; i < W * H * 4 && pass; i++) {
		pass = got[i] == 2 * wanted[i];
		if (!pass)
			printf("(%d, %d): ran %g times, blended %g times\n",
			       i / 4 % W, i / 4 / W, got[i] / 2, wanted[i]);
	}
	pass = pass && got[0] == 2;
	free(wanted);
	free(got);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("one-draw", rects, ONE_DRAW),
	KB_SUBTEST("many-draws", rects, MANY_DRAWS),
	KB_SUBTEST("program-changes", rects, PROGRAM_CHANGES),
	KB_SUBTEST("queries-and-flushes", rects, QUERIES_AND_FLUSHES),
	KB_SUBTEST("one-pixel-often", one_pixel_often, NULL),
	KB_SUBTEST("shared-edges", shared_edges, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(30)
