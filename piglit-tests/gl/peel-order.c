/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-order.c
 * Layer i holds the i-th fragment in the order of DepthFunc, whatever the
 * order of drawing, for every number of layers up to 64 and some up to the
 * limit.
 */

#include "peel-common.h"

#define W 12
#define H 9

static enum piglit_result
order(GLenum func, int k)
{
	struct peel p = peel_create(&(struct peel_shape) {
		k, W, H, 0, GL_DEPTH_COMPONENT32F, { GL_R32UI } });
	/* Some more than there are layers, and at most pixels some fewer. */
	const int n = k + k / 2 + 5;
	struct peel_quad *quads = malloc(n * sizeof(*quads));
	bool pass;

	peel_seed(k);
	glDepthFunc(func);
	glClearDepth(func == GL_LESS ? 1 : 0);
	peel_clear(&p);
	for (int i = 0; i < n; i++) {
		const int x = peel_random(W / 3), y = peel_random(H / 3);

		quads[i] = (struct peel_quad) {
			x, y, W - peel_random(W / 3), H - peel_random(H / 3),
			(i + 1) / (float)(n + 1), i
		};
	}
	peel_shuffle(quads, n);
	/* Part of them in a draw each. */
	for (int i = 0; i < n / 2; i++)
		peel_draw(&p, quads + i, 1);
	peel_draw(&p, quads + n / 2, n - n / 2);
	pass = peel_check_ranks(&p, quads, n) && peel_check(&p);
	if (!pass)
		printf("with %d layers\n", k);
	free(quads);
	return peel_end(&p, pass);
}

struct range { GLenum func; int first, last; };

static enum piglit_result
orders(void *data)
{
	const struct range *range = data;

	for (int k = range->first; k <= range->last; k++) {
		if (order(range->func, k) != PIGLIT_PASS)
			return PIGLIT_FAIL;
	}
	return PIGLIT_PASS;
}

static enum piglit_result
beyond(void *data)
{
	GLint limit;

	glGetIntegerv(GL_MAX_DEPTH_PEELING_LAYERS_MESA, &limit);
	if (limit < 64) {
		printf("only %d layers\n", limit);
		return PIGLIT_FAIL;
	}
	for (int k = 65; k < limit; k = 3 * k / 2) {
		if (order(*(const GLenum *)data, k) != PIGLIT_PASS)
			return PIGLIT_FAIL;
	}
	if (order(*(const GLenum *)data, limit - 1) != PIGLIT_PASS)
		return PIGLIT_FAIL;
	return order(*(const GLenum *)data, limit);
}

/** Fragments that arrive in their order, and in the reverse. */
static enum piglit_result
sorted(void *data)
{
	const bool back_to_front = *(const GLenum *)data == GL_GREATER;
	struct peel p = peel_simple(6);
	struct peel_quad quads[9];

	for (int i = 0; i < 9; i++)
		quads[i] = peel_full(&p, (back_to_front ? 9 - i : i + 1) / 16.,
				     i);
	peel_draw(&p, quads, 9);
	return peel_end(&p, peel_check_ranks(&p, quads, 9) && peel_check(&p));
}

static const GLenum less = GL_LESS, greater = GL_GREATER;

#define RANGE(func, first, last) &(const struct range) { func, first, last }

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("front-to-back", sorted, &less),
	KB_SUBTEST("back-to-front", sorted, &greater),
	KB_SUBTEST("less-1-32", orders, RANGE(GL_LESS, 1, 32)),
	KB_SUBTEST("less-33-64", orders, RANGE(GL_LESS, 33, 64)),
	KB_SUBTEST("less-beyond", beyond, &less),
	KB_SUBTEST("greater-1-32", orders, RANGE(GL_GREATER, 1, 32)),
	KB_SUBTEST("greater-33-64", orders, RANGE(GL_GREATER, 33, 64)),
	KB_SUBTEST("greater-beyond", beyond, &greater),
	KB_SUBTEST_END
};

PEEL_TEST(32)
