/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-masks.c
 * With DepthMask false nothing is inserted.  A component that ColorMask leaves
 * out keeps its bits in all layers, while the others move.
 */

#include "peel-common.h"

#define K 5
#define NUM 9

static struct peel
make(GLenum a, GLenum b, GLenum c)
{
	return peel_create(&(struct peel_shape) {
		K, 21, 11, 0, GL_DEPTH_COMPONENT32F, { a, b, c } });
}

static void
draw(struct peel *p, int seed)
{
	struct peel_quad quads[NUM];

	peel_seed(seed);
	for (int i = 0; i < NUM; i++)
		quads[i] = (struct peel_quad) {
			peel_random(9), peel_random(5), 21 - peel_random(9),
			11 - peel_random(5), (1 + peel_random(12)) / 16.,
			seed * NUM + i
		};
	peel_draw(p, quads, NUM);
}

static enum piglit_result
depth_mask(void *data)
{
	struct peel p = make(GL_RGBA8, GL_R32UI, 0);
	bool pass;

	draw(&p, 1);
	glDepthMask(GL_FALSE);
	draw(&p, 2);
	pass = peel_check(&p);
	glDepthMask(GL_TRUE);
	draw(&p, 3);
	glDepthMask(GL_FALSE);
	draw(&p, 4);
	return peel_end(&p, peel_check(&p) && pass);
}

/** Masked fragments are no arrivals for the continuation either. */
static enum piglit_result
depth_mask_in_passes(void *data)
{
	struct peel p = make(GL_R32UI, 0, 0);
	bool pass = true;

	for (int i = 0; i < 5 && pass; i++) {
		if (i > 0)
			peel_next(&p);
		for (int j = 0; j < 20; j++) {
			const struct peel_quad q = peel_full(&p, .5, j);

			glDepthMask(j % 3 != 1);
			peel_draw(&p, &q, 1);
		}
		glDepthMask(GL_TRUE);
		pass = peel_check(&p);
	}
	return peel_end(&p, pass);
}

/** Layers that hold something before are drawn to with each mask. */
static enum piglit_result
components(void *data)
{
	static const int masks[] = { 1, 2, 4, 8, 5, 10, 7, 14, 0 };
	struct peel p = make(*(const GLenum *)data, 0, 0);
	bool pass = true;

	draw(&p, 100);
	for (int i = 0; i < ARRAY_SIZE(masks) && pass; i++) {
		const int mask = masks[i];

		glColorMask(mask & 1, mask >> 1 & 1, mask >> 2 & 1,
			    mask >> 3 & 1);
		draw(&p, mask);
		pass = peel_check(&p);
		if (!pass)
			printf("with mask %x\n", mask);
		/* Room for others to come in. */
		if (i % 4 == 3) {
			glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
			peel_clear(&p);
			draw(&p, 200 + mask);
		}
	}
	return peel_end(&p, pass);
}

/** A mask for each draw buffer. */
static enum piglit_result
draw_buffers(void *data)
{
	struct peel p = make(GL_RGBA8, GL_RGBA16F, GL_RG32UI);
	bool pass = true;

	draw(&p, 100);
	for (int i = 0; i < 30 && pass; i++) {
		for (int b = 0; b < 3; b++)
			glColorMaski(b, peel_random(2), peel_random(2),
				     peel_random(2), peel_random(2));
		if (i % 5 == 4)
			glColorMaski(i % 3, GL_FALSE, GL_FALSE, GL_FALSE,
				     GL_FALSE);
		draw(&p, i);
		pass = peel_check(&p);
		if (i % 4 == 3)
			peel_clear(&p);
	}
	return peel_end(&p, pass);
}

/** Depths go in order also where no color is written. */
static enum piglit_result
all_masked(void *data)
{
	struct peel p = make(GL_RGBA32F, GL_RGBA8UI, 0);
	bool pass;

	draw(&p, 1);
	glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
	draw(&p, 2);
	pass = peel_check(&p);
	glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
	draw(&p, 3);
	return peel_end(&p, peel_check(&p) && pass);
}

#define COMPONENTS(name) \
	{ "components-" #name, "components-" #name, components, \
	  (void *)&(const GLenum) { GL_##name } }

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("depth-mask", depth_mask, NULL),
	KB_SUBTEST("depth-mask-in-passes", depth_mask_in_passes, NULL),
	COMPONENTS(RGBA8),
	COMPONENTS(RGBA16F),
	COMPONENTS(RGBA32F),
	COMPONENTS(RGBA16UI),
	COMPONENTS(RGBA32I),
	COMPONENTS(RGB565),
	COMPONENTS(RGBA4),
	COMPONENTS(RGB5_A1),
	COMPONENTS(RGB10_A2),
	COMPONENTS(R11F_G11F_B10F),
	COMPONENTS(RG8),
	COMPONENTS(RG16I),
	COMPONENTS(SRGB8_ALPHA8),
	COMPONENTS(RGBA16_SNORM),
	KB_SUBTEST("draw-buffers", draw_buffers, NULL),
	KB_SUBTEST("all-masked", all_masked, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
