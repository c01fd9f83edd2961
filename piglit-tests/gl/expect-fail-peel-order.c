/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file expect-fail-peel-order.c
 * Tests the tester: the model gets coplanar quads in another order than GL, a
 * depth one unit in the last place away, another OVERFLOW.
 */

#include "peel-common.h"

static enum piglit_result
order(void *data)
{
	struct peel p = peel_simple(2);
	const struct peel_quad quads[2] = {
		peel_full(&p, .5, 1), peel_full(&p, .5, 2)
	};

	peel_draw_gl(&p, quads, 2);
	peel_draw_model(&p, quads + 1, 1);
	peel_draw_model(&p, quads, 1);
	return peel_end(&p, peel_check(&p));
}

/** The next float. */
static enum piglit_result
depth(void *data)
{
	struct peel p = peel_simple(2);
	struct peel_quad q = peel_full(&p, .5, 1);

	peel_draw_gl(&p, &q, 1);
	q.z = nextafterf(q.z, 1);
	peel_draw_model(&p, &q, 1);
	return peel_end(&p, peel_check(&p));
}

static enum piglit_result
overflow(void *data)
{
	struct peel p = peel_simple(1);
	const struct peel_quad q = peel_full(&p, .5, 1);

	peel_draw(&p, &q, 1);
	p.model.overflow = true;
	return peel_end(&p, peel_check(&p));
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("order", order, NULL),
	KB_SUBTEST("depth", depth, NULL),
	KB_SUBTEST("overflow", overflow, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
