/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-attachments.c
 * 0 to 8 color attachments, of one format or of eight; draw buffers that are
 * none or in another order: colors move in all of them, and in no other.
 */

#include "peel-common.h"

#define K 6
#define NUM 15

static const GLenum mixed[PEEL_MAX_COLORS] = {
	GL_RGBA8, GL_R32UI, GL_RGBA16F, GL_RGBA32F, GL_R8, GL_RG16I,
	GL_RGB10_A2, GL_RGBA32I,
};

static struct peel
make(int n, const GLenum *formats, int step)
{
	struct peel_shape shape = {
		K, 18, 13, 0, GL_DEPTH_COMPONENT32F,
	};

	for (int a = 0; a < n; a++)
		shape.colors[a] = formats[a * step];
	return peel_create(&shape);
}

static void
draw(struct peel *p, int seed)
{
	struct peel_quad quads[NUM];

	peel_seed(seed);
	for (int i = 0; i < NUM; i++)
		quads[i] = (struct peel_quad) {
			peel_random(5), peel_random(5), 18 - peel_random(5),
			13 - peel_random(5), (1 + peel_random(20)) / 32.,
			seed * NUM + i
		};
	peel_draw(p, quads, NUM);
}

/** Only depths, when there is no color. */
static enum piglit_result
count(void *data)
{
	const int step = *(const int *)data;

	for (int n = 0; n <= PEEL_MAX_COLORS; n++) {
		struct peel p = make(n, mixed, step);
		bool pass;

		draw(&p, n);
		pass = peel_check(&p);
		if (!pass)
			printf("with %d attachments\n", n);
		if (peel_end(&p, pass) != PIGLIT_PASS)
			return PIGLIT_FAIL;
	}
	return PIGLIT_PASS;
}

/** Attachments that are no draw buffers keep what they hold. */
static enum piglit_result
holes(void *data)
{
	static const int buffers[][PEEL_MAX_COLORS] = {
		{ -1, 1, -1, 3, 4, -1, -1, 7 },
		{ -1, -1, -1, -1, -1, -1, -1, 7 },
		{ 0, -1, -1, -1, -1, -1, -1, -1 },
		{ -1, -1, -1, -1, -1, -1, -1, -1 },
		{ 7, 6, 5, 4, 3, 2, 1, 0 },
		{ 2, -1, 0, -1, 6, 5, -1, 1 },
		{ 0, 1, 2, 3, 4, 5, 6, 7 },
	};
	struct peel p = make(PEEL_MAX_COLORS, mixed, 1);
	bool pass = true;

	for (int i = 0; i < ARRAY_SIZE(buffers) && pass; i++) {
		peel_draw_buffers(&p, PEEL_MAX_COLORS, buffers[i]);
		peel_use_program(&p, "", "");
		if (i % 2 == 0)
			peel_clear(&p);
		draw(&p, i);
		pass = peel_check(&p);
		if (!pass)
			printf("with draw buffers of line %d\n", i);
	}
	return peel_end(&p, pass);
}

/**
 * Outputs that the shader has and the framebuffer has not; and draw buffers
 * without an attachment.
 */
static enum piglit_result
missing(void *data)
{
	static const GLenum buffers[4] = {
		GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1,
		GL_COLOR_ATTACHMENT2, GL_COLOR_ATTACHMENT3,
	};
	struct peel p = make(4, mixed, 1);
	bool pass;

	peel_clear(&p);
	/* The second has no texture now. */
	glFramebufferTexture(GL_FRAMEBUFFER, buffers[1], 0, 0);
	p.buffers[1] = -1;
	draw(&p, 1);
	/* And now the fourth is no draw buffer. */
	glDrawBuffers(3, buffers);
	p.buffers[3] = -1;
	draw(&p, 2);
	pass = peel_check(&p);
	return peel_end(&p, pass);
}

/** What the shader does not write is 0, 0, 0, 1. */
static enum piglit_result
unwritten(void *data)
{
	static const GLenum formats[4] = {
		GL_R32UI, GL_RGBA8, GL_RGBA32F, GL_RGBA32I,
	};
	static const uint32_t ones[4] = { 0, 255, 0x3f800000, 1 };
	struct peel p = make(4, formats, 1);
	const int identity[4] = { 0, 1, 2, 3 };
	bool pass;

	/* A shader for a framebuffer of which only the first is drawn to. */
	peel_draw_buffers(&p, 1, identity);
	peel_use_program(&p, "", "");
	peel_draw_buffers(&p, 4, identity);
	peel_clear(&p);
	draw(&p, 1);
	for (int i = 0; i < p.width * p.height * K; i++) {
		uint32_t (*color)[4] = p.model.color + 4 * i;

		for (int a = 1; a < 4; a++) {
			memset(color[a], 0, 16);
			if (p.model.depth[i] != peel_max_depth(p.depth))
				color[a][3] = ones[a];
		}
	}
	pass = peel_check(&p);
	return peel_end(&p, pass);
}

static const int different = 1, equal = 0;

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("mixed", count, &different),
	KB_SUBTEST("equal", count, &equal),
	KB_SUBTEST("draw-buffers", holes, NULL),
	KB_SUBTEST("missing", missing, NULL),
	KB_SUBTEST("unwritten", unwritten, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
