/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-overflow.c
 * OVERFLOW is zero if no fragment has fallen behind the last layer since
 * FIRST_LAYER was set.  It is not zero if one has.  A fragment that would have
 * been discarded may count, but the loop over the passes ends all the same,
 * at most one pass later.
 */

#include "peel-common.h"

#define K 4

static bool
overflow_is(bool expected)
{
	const int value = peel_get(GL_DEPTH_PEELING_OVERFLOW_MESA);

	if ((value != 0) == expected)
		return true;
	printf("overflow is %d, expected %s\n", value,
	       expected ? "another" : "0");
	return false;
}

/** Fragments over all pixels, in front of one another. */
static void
draw_full(struct peel *p, int n, bool back_to_front)
{
	for (int i = 0; i < n; i++) {
		const int rank = back_to_front ? n - 1 - i : i;
		const struct peel_quad q =
			peel_full(p, (rank + 1) / 64., rank);

		peel_draw(p, &q, 1);
	}
}

static enum piglit_result
exactly_full(void *data)
{
	const bool back_to_front = *(const int *)data;
	struct peel p = peel_simple(K);
	bool pass = overflow_is(false);

	draw_full(&p, K, back_to_front);
	pass = overflow_is(false) && peel_check(&p) && pass;
	peel_clear(&p);
	draw_full(&p, K + 1, back_to_front);
	pass = overflow_is(true) && peel_check(&p) && pass;
	return peel_end(&p, pass);
}

/** One fragment more at one pixel of many. */
static enum piglit_result
one_pixel(void *data)
{
	bool pass = true;

	for (int i = 0; i < 6 && pass; i++) {
		struct peel p = peel_create(&(struct peel_shape) {
			K, 150, 100, 0, GL_DEPTH_COMPONENT32F, { GL_R8 } });
		const int x = 29 * i, y = 19 * i;
		const struct peel_quad dot = {
			x, y, x + 1, y + 1, i % 2 ? .875 : .001, 9
		};

		draw_full(&p, K, false);
		pass = overflow_is(false);
		peel_draw(&p, &dot, 1);
		pass = overflow_is(true) && peel_check(&p) && pass;
		peel_end(&p, pass);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** What does not take part does not fall behind. */
static enum piglit_result
not_taken(void *data)
{
	struct peel p = peel_simple(K);
	const struct peel_quad at_clear = peel_full(&p, .5, 20);
	const struct peel_quad behind_clear = peel_full(&p, .75, 21);
	const struct peel_quad near = peel_full(&p, .25, 22);
	bool pass = true;

	glClearDepth(.5);
	peel_clear(&p);
	draw_full(&p, K, false);
	peel_draw(&p, &at_clear, 1);
	peel_draw(&p, &behind_clear, 1);
	if (!overflow_is(false)) {
		printf("fragments that are not nearer than the clear value\n");
		pass = false;
	}
	glDepthMask(GL_FALSE);
	peel_draw(&p, &near, 1);
	if (!overflow_is(false)) {
		printf("a masked draw\n");
		pass = false;
	}
	glDepthMask(GL_TRUE);
	glEnable(GL_SCISSOR_TEST);
	glScissor(0, 0, 0, 0);
	peel_draw(&p, &near, 1);
	if (!overflow_is(false)) {
		printf("a draw outside of the scissor box\n");
		pass = false;
	}
	glDisable(GL_SCISSOR_TEST);
	return peel_end(&p, peel_check(&p) && pass);
}

/** Only setting FIRST_LAYER makes it zero again. */
static enum piglit_result
stays_set(void *data)
{
	struct peel p = peel_simple(K);
	bool pass;

	draw_full(&p, K + 3, true);
	pass = overflow_is(true);
	peel_clear(&p);
	if (!overflow_is(true)) {
		printf("after a clear\n");
		pass = false;
	}
	draw_full(&p, 1, false);
	pass = overflow_is(true) && pass;
	peel_restart(&p);
	if (!overflow_is(false)) {
		printf("after FIRST_LAYER was set to 0\n");
		pass = false;
	}
	draw_full(&p, K + 3, true);
	pass = overflow_is(true) && pass;
	peel_next(&p);
	if (!overflow_is(false)) {
		printf("after FIRST_LAYER was set to k\n");
		pass = false;
	}
	draw_full(&p, K + 3, true);
	/* Three are left; those in front do not count. */
	pass = overflow_is(false) && peel_check(&p) && pass;
	return peel_end(&p, pass);
}

/** Each framebuffer has its own. */
static enum piglit_result
each_framebuffer(void *data)
{
	struct peel p = peel_simple(K), q = peel_simple(K);
	bool pass;

	draw_full(&q, K + 1, false);
	draw_full(&q, K + 1, false);
	pass = overflow_is(true);
	glBindFramebuffer(GL_FRAMEBUFFER, p.fbo);
	draw_full(&p, K, false);
	pass = overflow_is(false) && pass;
	glBindFramebuffer(GL_FRAMEBUFFER, q.fbo);
	pass = overflow_is(true) && pass;
	peel_end(&p, pass);
	return peel_end(&q, pass);
}

static bool
odd_pixels(int x, int y, int sample, uint32_t id)
{
	return (x + y + id) % 2;
}

/** With a shader that discards the loop ends, at most one pass later. */
static enum piglit_result
conservative(void *data)
{
	enum { NUM = 40 };
	struct peel p = peel_simple(K);
	struct peel_quad quads[NUM];
	int passes = 0;
	bool pass = true, more = true;

	peel_use_program(&p, "", "if ((uint(gl_FragCoord.x) + "
			 "uint(gl_FragCoord.y) + id) % 2u == 0u) discard;");
	p.stays = odd_pixels;
	peel_seed(11);
	for (int i = 0; i < NUM; i++)
		quads[i] = peel_full(&p, (1 + peel_random(12)) / 16., i);
	/* Each pixel has half of them. */
	while (more && pass && passes < NUM) {
		if (passes++ > 0)
			peel_next(&p);
		peel_draw(&p, quads, NUM);
		pass = peel_check_layers(&p);
		more = peel_get(GL_DEPTH_PEELING_OVERFLOW_MESA) != 0;
		if (p.model.overflow && !more) {
			printf("overflow is 0 but a fragment fell behind\n");
			pass = false;
		}
	}
	if (pass && passes != NUM / 2 / K && passes != NUM / 2 / K + 1) {
		printf("%d passes for %d layers of %d\n", passes, NUM / 2, K);
		pass = false;
	}
	return peel_end(&p, pass);
}

static const int front_to_back = 0, back_to_front = 1;

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("exactly-full", exactly_full, &front_to_back),
	KB_SUBTEST("exactly-full-back-to-front", exactly_full, &back_to_front),
	KB_SUBTEST("one-pixel", one_pixel, NULL),
	KB_SUBTEST("not-taken", not_taken, NULL),
	KB_SUBTEST("stays-set", stays_set, NULL),
	KB_SUBTEST("each-framebuffer", each_framebuffer, NULL),
	KB_SUBTEST("conservative", conservative, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
