/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file expect-fail-peel.c
 * Tests the tester: the model gets coplanar quads in another order than GL, a
 * depth one unit in the last place away, a color of another bit, one layer or
 * one fragment too many, another OVERFLOW; an error is missing.
 */

#include "peel-common.h"

#define W 16    /* of peel_simple() */

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

/** The layers of one depth, which only colors tell apart, exchanged. */
static enum piglit_result
layer(void *data)
{
	struct peel p = peel_simple(3);
	const struct peel_quad quads[3] = {
		peel_full(&p, .25, 1), peel_full(&p, .5, 2),
		peel_full(&p, .5, 3)
	};

	peel_draw(&p, quads, 3);
	for (int i = 0; i < W * W; i++) {
		uint32_t (*color)[4] = p.model.color + i * 3;
		const uint32_t second = color[1][0];

		color[1][0] = color[2][0];
		color[2][0] = second;
	}
	return peel_end(&p, peel_check(&p));
}

/** The lowest bit of one component of one pixel of one layer. */
static enum piglit_result
color_bit(void *data)
{
	struct peel p = peel_simple(3);
	const struct peel_quad q = peel_full(&p, .5, 1);

	peel_draw(&p, &q, 1);
	p.model.color[0][0] ^= 1;
	return peel_end(&p, peel_check(&p));
}

/** In one pixel. */
static enum piglit_result
fragment(void *data)
{
	struct peel p = peel_simple(3);
	const struct peel_quad q = { W - 1, W - 1, W, W, .5, 1 };

	peel_draw_gl(&p, &q, 1);
	return peel_end(&p, peel_check(&p));
}

static enum piglit_result
missing_error(void *data)
{
	struct peel p = peel_simple(1);
	const struct peel_quad q = peel_full(&p, .5, 1);

	peel_draw(&p, &q, 1);
	return peel_end(&p, piglit_check_gl_error(GL_INVALID_OPERATION));
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("order", order, NULL),
	KB_SUBTEST("depth", depth, NULL),
	KB_SUBTEST("overflow", overflow, NULL),
	KB_SUBTEST("layer", layer, NULL),
	KB_SUBTEST("color-bit", color_bit, NULL),
	KB_SUBTEST("fragment", fragment, NULL),
	KB_SUBTEST("missing-error", missing_error, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
