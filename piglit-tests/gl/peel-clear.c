/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-clear.c
 * All layers are cleared by the commands that clear a framebuffer.  What is
 * not nearer than the clear depth is never kept, and a layer that is not
 * nearer is empty.
 */

#include "peel-common.h"

#define W 70
#define H 40
#define K 4

static struct peel
make(GLenum depth)
{
	return peel_create(&(struct peel_shape) {
		K, W, H, 0, depth, { GL_RGBA8, GL_R32UI } });
}

static void
draw(struct peel *p, int n, int seed)
{
	peel_seed(seed);
	for (int i = 0; i < n; i++) {
		const int x = peel_random(30), y = peel_random(20);
		const struct peel_quad q = {
			x, y, W - peel_random(30), H - peel_random(20),
			(1 + peel_random(15)) / 16., seed * 100 + i
		};

		peel_draw(p, &q, 1);
	}
}

/** Give the model's pixels of a rectangle a color, a depth, or both. */
static void
model_clear(struct peel *p, int x, int y, int w, int h, int attachment,
	    const uint32_t *color, uint32_t depth)
{
	for (int i = 0; i < W * H * K; i++) {
		const int px = i / K % W, py = i / K / W;

		if (px < x || px >= x + w || py < y || py >= y + h)
			continue;
		if (color)
			memcpy(p->model.color[i * p->colors + attachment],
			       color, 16);
		else
			p->model.depth[i] = depth;
	}
}

/** The depth that clears store differs from 1. */
static enum piglit_result
clear_depth(void *data)
{
	static const double depths[] = { .3, .53, .6251, .999999, .1 };
	const GLenum formats[] = {
		GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT24,
		GL_DEPTH_COMPONENT16, GL_DEPTH24_STENCIL8,
	};
	const GLenum func = *(const GLenum *)data;
	bool pass = true;

	glDepthFunc(func);
	for (int i = 0; i < ARRAY_SIZE(formats) * 5 && pass; i++) {
		struct peel p;
		const double clear = depths[i % 5];
		uint32_t *stored;

		glClearDepth(clear);
		p = make(formats[i / 5]);
		/* As the driver rounds it. */
		stored = peel_read_depth(&p);
		model_clear(&p, 0, 0, W, H, 0, NULL, stored[0]);
		for (int j = 1; j < K * W * H && pass; j++)
			pass = stored[j] == stored[0];
		free(stored);
		draw(&p, 12, i);
		pass = peel_check(&p) && pass;
		if (!pass)
			printf("clear depth %g in %s\n", clear,
			       piglit_get_gl_enum_name(formats[i / 5]));
		peel_end(&p, pass);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** The clear depth that counts is that of the draw. */
static enum piglit_result
changed(void *data)
{
	struct peel p = make(GL_DEPTH_COMPONENT32F);
	bool pass;

	draw(&p, 3, 1);
	glClearDepth(.5);
	/* The layers of 1 are empty now as before. */
	draw(&p, 6, 2);
	pass = peel_check(&p);
	glClearDepth(.75);
	draw(&p, 6, 3);
	return peel_end(&p, peel_check(&p) && pass);
}

static enum piglit_result
scissored(void *data)
{
	static const uint32_t white[4] = { 255, 255, 255, 255 };
	static const GLuint seven[4] = { 7, 0, 0, 0 };
	struct peel p = make(GL_DEPTH_COMPONENT32F);
	bool pass;

	draw(&p, 8, 1);
	glEnable(GL_SCISSOR_TEST);
	glScissor(9, 5, 40, 21);
	glClear(GL_DEPTH_BUFFER_BIT);
	model_clear(&p, 9, 5, 40, 21, 0, NULL, 0x3f800000);
	glDisable(GL_SCISSOR_TEST);
	draw(&p, 3, 2);
	pass = peel_check(&p);
	glEnable(GL_SCISSOR_TEST);
	glScissor(20, 11, 33, 17);
	glClearBufferfv(GL_COLOR, 0, (const GLfloat[]) { 1, 1, 1, 1 });
	model_clear(&p, 20, 11, 33, 17, 0, white, 0);
	glClearBufferuiv(GL_COLOR, 1, seven);
	model_clear(&p, 20, 11, 33, 17, 1, seven, 0);
	glDisable(GL_SCISSOR_TEST);
	draw(&p, 5, 3);
	return peel_end(&p, peel_check(&p) && pass);
}

static enum piglit_result
clear_buffer(void *data)
{
	struct peel p = make(GL_DEPTH_COMPONENT32F);
	const float half = .5;
	bool pass;

	draw(&p, 8, 1);
	/* .5 is nearer than the clear depth: layers full of fragments. */
	glClearBufferfv(GL_DEPTH, 0, &half);
	model_clear(&p, 0, 0, W, H, 0, NULL, 0x3f000000);
	draw(&p, 6, 2);
	pass = peel_check(&p);
	peel_end(&p, pass);

	p = make(GL_DEPTH32F_STENCIL8);
	draw(&p, 8, 1);
	glClearBufferfi(GL_DEPTH_STENCIL, 0, 1, 0x55);
	model_clear(&p, 0, 0, W, H, 0, NULL, 0x3f800000);
	draw(&p, 6, 2);
	return peel_end(&p, peel_check(&p) && pass);
}

/**
 * Integers that would be zero or denormal as floats, in the tiles that are
 * drawn to and in others.
 */
static enum piglit_result
integers(void *data)
{
	static const uint32_t values[][4] = {
		{ 1, 0, 0, 0 }, { 8388607, 1, 2, 3 }, { 0x80000000, 0, 0, 0 },
		{ 0, 0, 0, 1 }, { 0x80000001, 0x807fffff, 0, 5 },
	};
	const GLenum format = *(const GLenum *)data;
	bool pass = true;

	for (int i = 0; i < ARRAY_SIZE(values) && pass; i++) {
		struct peel p = peel_create(&(struct peel_shape) {
			K, W, H, 0, GL_DEPTH_COMPONENT32F, { format } });
		const struct peel_quad q = { 3, 2, 40, 20, .5, 8388600 + i };
		uint32_t stored[4] = { 0 };

		for (int c = 0; c < 4 && p.color[0]->bits[c]; c++)
			stored[c] = values[i][c];
		if (p.color[0]->kind == PEEL_INT)
			glClearBufferiv(GL_COLOR, 0, (const GLint *)values[i]);
		else
			glClearBufferuiv(GL_COLOR, 0, values[i]);
		model_clear(&p, 0, 0, W, H, 0, stored, 0);
		peel_draw(&p, &q, 1);
		pass = peel_check(&p);
		/* Once more, by a draw that does not peel. */
		glClearBufferfv(GL_DEPTH, 0, &(const float) { 1 });
		if (p.color[0]->kind == PEEL_INT)
			glClearBufferiv(GL_COLOR, 0, (const GLint *)values[i]);
		else
			glClearBufferuiv(GL_COLOR, 0, values[i]);
		model_clear(&p, 0, 0, W, H, 0, NULL, 0x3f800000);
		model_clear(&p, 0, 0, W, H, 0, stored, 0);
		glDisable(GL_DEPTH_PEELING_MESA);
		glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
		peel_draw_gl(&p, &q, 1);
		glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
		pass = peel_check(&p) && pass;
		if (!pass)
			printf("cleared to %08x %08x %08x %08x\n", values[i][0],
			       values[i][1], values[i][2], values[i][3]);
		peel_end(&p, pass);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Depth without color, and color without depth. */
static enum piglit_result
separately(void *data)
{
	static const uint32_t zero[4];
	struct peel p = make(GL_DEPTH_COMPONENT24);
	bool pass;

	draw(&p, 8, 1);
	glClear(GL_DEPTH_BUFFER_BIT);
	model_clear(&p, 0, 0, W, H, 0, NULL, peel_max_depth(p.depth));
	draw(&p, 2, 2);
	pass = peel_check(&p);
	glClearBufferuiv(GL_COLOR, 1, zero);
	model_clear(&p, 0, 0, W, H, 1, zero, 0);
	draw(&p, 2, 3);
	return peel_end(&p, peel_check(&p) && pass);
}

/** Masks hold for clears. */
static enum piglit_result
masked(void *data)
{
	struct peel p = make(GL_DEPTH_COMPONENT32F);
	bool pass;

	draw(&p, 8, 1);
	glDepthMask(GL_FALSE);
	glClear(GL_DEPTH_BUFFER_BIT);
	glDepthMask(GL_TRUE);
	draw(&p, 2, 2);
	pass = peel_check(&p);
	glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_TRUE);
	glClearBufferfv(GL_COLOR, 0, (const GLfloat[]) { 1, 1, 1, 1 });
	for (int i = 0; i < W * H * K; i++)
		p.model.color[2 * i][1] = p.model.color[2 * i][3] = 255;
	glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
	draw(&p, 3, 3);
	return peel_end(&p, peel_check(&p) && pass);
}

/** One layer, by a framebuffer that has only that. */
static enum piglit_result
one_layer(void *data)
{
	struct peel p = make(GL_DEPTH_COMPONENT32F);
	GLuint fbo = kb_new_framebuffer();
	bool pass;

	draw(&p, 8, 1);
	glBindFramebuffer(GL_FRAMEBUFFER, fbo);
	glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT,
				  p.depth_tex, 0, K - 1);
	glClear(GL_DEPTH_BUFFER_BIT);
	for (int i = 0; i < W * H; i++)
		p.model.depth[i * K + K - 1] = 0x3f800000;
	glBindFramebuffer(GL_FRAMEBUFFER, p.fbo);
	draw(&p, 4, 2);
	pass = peel_check(&p);
	return peel_end(&p, pass);
}

/** Between draws that do not peel, with no other change of state. */
static enum piglit_result
between_plain_draws(void *data)
{
	const struct peel_quad all = { 0, 0, W, H, .5, 1 };
	const struct peel_quad some = { 5, 6, 50, 30, .5, 2 };
	struct peel p = make(GL_DEPTH_COMPONENT32F);

	draw(&p, 8, 1);
	glDisable(GL_DEPTH_PEELING_MESA);
	peel_draw_gl(&p, &all, 1);
	peel_clear(&p);
	peel_draw_gl(&p, &some, 1);
	glEnable(GL_DEPTH_PEELING_MESA);
	for (int a = 0; a < p.colors; a++) {
		uint32_t color[4];

		for (int c = 0; c < 4; c++)
			color[c] = peel_color_code(p.color[a], a, c, some.id);
		for (int y = some.y0; y < some.y1; y++) {
			for (int x = some.x0; x < some.x1; x++) {
				const int i = (y * W + x) * K;

				memcpy(p.model.color[i * p.colors + a], color,
				       sizeof color);
			}
		}
	}
	return peel_end(&p, peel_check(&p));
}

/** Many times, with draws of a few pixels between. */
static enum piglit_result
often(void *data)
{
	struct peel p = make(GL_DEPTH_COMPONENT32F);
	bool pass = true;

	for (int i = 0; i < 60 && pass; i++) {
		draw(&p, 1 + i % 6, i);
		if (i % 10 == 9)
			pass = peel_check(&p);
		if (i % 3)
			peel_clear(&p);
	}
	return peel_end(&p, pass);
}

static const GLenum less = GL_LESS, greater = GL_GREATER;
static const GLenum r32ui = GL_R32UI, r32i = GL_R32I, rgba32ui = GL_RGBA32UI;

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("clear-depth", clear_depth, &less),
	KB_SUBTEST("clear-depth-greater", clear_depth, &greater),
	KB_SUBTEST("changed", changed, NULL),
	KB_SUBTEST("scissored", scissored, NULL),
	KB_SUBTEST("clear-buffer", clear_buffer, NULL),
	KB_SUBTEST("integers-r32ui", integers, &r32ui),
	KB_SUBTEST("integers-r32i", integers, &r32i),
	KB_SUBTEST("integers-rgba32ui", integers, &rgba32ui),
	KB_SUBTEST("separately", separately, NULL),
	KB_SUBTEST("masked", masked, NULL),
	KB_SUBTEST("one-layer", one_layer, NULL),
	KB_SUBTEST("between-plain-draws", between_plain_draws, NULL),
	KB_SUBTEST("often", often, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
