/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-ties.c
 * Fragments of equal depth are kept in the order of arrival with LESS and
 * GREATER, in the reverse with LEQUAL and GEQUAL, inside of a draw and from
 * one to the next.
 */

#include "peel-common.h"

#define NUM 60

static const int layers[] = { 1, 2, 3, 4, 5, 7, 8, 16, 17, 33, NUM, 64 };

/** \p depths different depths, \p at_a_time quads in a draw. */
static bool
ties(GLenum func, int k, int depths, int at_a_time)
{
	struct peel p = peel_simple(k);
	struct peel_quad quads[NUM];
	bool pass;

	peel_seed(k + depths);
	glDepthFunc(func);
	glClearDepth(func == GL_LESS || func == GL_LEQUAL ? 1 : 0);
	peel_clear(&p);
	for (int i = 0; i < NUM; i++) {
		const float z = (1 + peel_random(depths)) / 16.;

		quads[i] = peel_full(&p, z, i);
		/* Half of them not in all pixels. */
		if (i % 2)
			quads[i].x0 = peel_random(p.width - 1);
	}
	for (int i = 0; i < NUM; i += at_a_time)
		peel_draw(&p, quads + i, MIN2(at_a_time, NUM - i));
	pass = peel_check_ranks(&p, quads, NUM) && peel_check(&p);
	if (!pass)
		printf("%d layers, %d depths, %d quads in a draw\n", k, depths,
		       at_a_time);
	return peel_end(&p, pass) == PIGLIT_PASS;
}

static enum piglit_result
test(void *data)
{
	const GLenum func = *(const GLenum *)data;
	bool pass = true;

	for (int i = 0; i < ARRAY_SIZE(layers) && pass; i++)
		pass = ties(func, layers[i], 1, NUM) &&
			ties(func, layers[i], 1, 1) &&
			ties(func, layers[i], 4, NUM) &&
			ties(func, layers[i], 4, 7);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** The form of the comparison may change between draws. */
static enum piglit_result
change(void *data)
{
	struct peel p = peel_simple(9);
	bool pass;

	peel_seed(5);
	for (int i = 0; i < 40; i++) {
		const struct peel_quad q =
			peel_full(&p, (1 + peel_random(3)) / 4., i);

		glDepthFunc(peel_random(2) ? GL_LESS : GL_LEQUAL);
		peel_draw(&p, &q, 1);
	}
	pass = peel_check(&p);
	return peel_end(&p, pass);
}

static const GLenum funcs[] = { GL_LESS, GL_LEQUAL, GL_GREATER, GL_GEQUAL };

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("less", test, &funcs[0]),
	KB_SUBTEST("lequal", test, &funcs[1]),
	KB_SUBTEST("greater", test, &funcs[2]),
	KB_SUBTEST("gequal", test, &funcs[3]),
	KB_SUBTEST("less-and-lequal", change, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
