/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-interleaved.c
 * Peeling, ordinary draws, k-buffer programs, clears, uploads and readbacks
 * in random order on one framebuffer, with nothing between them, against the
 * model.
 */

#include "peel-common.h"

#define W 150
#define H 77

static struct peel_quad
random_quad(uint32_t id)
{
	const int x = peel_random(W), y = peel_random(H);
	const int w = 1 + peel_random(peel_random(3) ? 20 : W);
	const int h = 1 + peel_random(peel_random(3) ? 20 : H);

	return (struct peel_quad) {
		x, y, MIN2(W, x + w), MIN2(H, y + h),
		(1 + peel_random(30)) / 32., id
	};
}

/** What every operation does to the model: all pixels of a rectangle. */
#define FOR_EACH_PIXEL(i, q)                                            \
	for (int i##_y = (q).y0; i##_y < (q).y1; i##_y++)               \
		for (int i##_x = (q).x0, i = i##_y * W + i##_x;         \
		     i##_x < (q).x1; i##_x++, i++)

/** The depth test and the color write of layer 0. */
static void
draw_plain(struct peel *p, const struct peel_quad *q, bool depth_test)
{
	const int k = p->layers;
	const uint32_t z = peel_depth_code(p->depth, q->z);

	glDisable(GL_DEPTH_PEELING_MESA);
	if (depth_test)
		glEnable(GL_DEPTH_TEST);
	peel_draw_gl(p, q, 1);
	glDisable(GL_DEPTH_TEST);
	glEnable(GL_DEPTH_PEELING_MESA);
	FOR_EACH_PIXEL(i, *q) {
		if (depth_test && z >= p->model.depth[i * k])
			continue;
		if (depth_test)
			p->model.depth[i * k] = z;
		for (int a = 0; a < p->colors; a++) {
			for (int c = 0; c < 4; c++)
				p->model.color[i * k * p->colors + a][c] =
					peel_color_code(p->color[a], a, c,
							q->id);
		}
	}
}

/** A program that swaps the first entry with the last. */
static void
draw_program(struct peel *p, const struct peel_quad *q)
{
	const int last = p->layers * p->colors - 1;

	glDisable(GL_DEPTH_PEELING_MESA);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	peel_draw_gl(p, q, 1);
	glDisable(GL_KBUFFER_PROGRAM_MESA);
	glEnable(GL_DEPTH_PEELING_MESA);
	FOR_EACH_PIXEL(i, *q) {
		uint32_t (*color)[4] = p->model.color + i * (last + 1);
		uint32_t swap[4];

		memcpy(swap, color[0], 16);
		memcpy(color[0], color[last], 16);
		memcpy(color[last], swap, 16);
	}
}

/** A layer of depths between those of the quads. */
static void
upload(struct peel *p, int layer, float z)
{
	float *depths = malloc(W * H * 4);

	for (int i = 0; i < W * H; i++) {
		depths[i] = z;
		p->model.depth[i * p->layers + layer] =
			peel_depth_code(p->depth, z);
	}
	glBindTexture(GL_TEXTURE_2D_ARRAY, p->depth_tex);
	glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, layer, W, H, 1,
			GL_DEPTH_COMPONENT, GL_FLOAT, depths);
	glBindTexture(GL_TEXTURE_2D_ARRAY, 0);
	free(depths);
}

static void
scissored_clear(struct peel *p, const struct peel_quad *q)
{
	glEnable(GL_SCISSOR_TEST);
	glScissor(q->x0, q->y0, q->x1 - q->x0, q->y1 - q->y0);
	glClear(GL_DEPTH_BUFFER_BIT);
	glDisable(GL_SCISSOR_TEST);
	FOR_EACH_PIXEL(i, *q) {
		for (int l = 0; l < p->layers; l++)
			p->model.depth[i * p->layers + l] =
				peel_max_depth(p->depth);
	}
}

/** A pixel of layer 0 is read back. */
static bool
read_pixel(const struct peel *p, int x, int y)
{
	uint32_t code;
	float z;

	/* As in the ordinary pipeline: the first layer. */
	glReadPixels(x, y, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &z);
	code = peel_depth_code(p->depth, z);
	if (code == p->model.depth[(y * W + x) * p->layers])
		return true;
	printf("ReadPixels gives depth %08x at (%d, %d), expected %08x\n",
	       code, x, y, p->model.depth[(y * W + x) * p->layers]);
	return false;
}

static enum piglit_result
interleaved(void *data)
{
	const struct peel_shape *shape = data;
	struct peel p = peel_create(shape);
	const bool programs = piglit_is_extension_supported(
		"GL_MESA_kbuffer_program") && p.colors > 0;
	bool pass = true;
	char text[256];

	sprintf(text, "MOV result.kbuffer[0], kbuffer[%d];\n"
		"MOV result.kbuffer[%d], kbuffer[0];",
		p.layers * p.colors - 1, p.layers * p.colors - 1);
	if (programs)
		kb_program(text);
	peel_seed(p.layers);
	for (int i = 0; i < 300 && pass; i++) {
		const struct peel_quad q = random_quad(i);
		struct peel_quad quads[10];
		const int n = 1 + peel_random(10);

		switch (peel_random(12)) {
		case 0:
			draw_plain(&p, &q, true);
			break;
		case 1:
			draw_plain(&p, &q, false);
			break;
		case 2:
			if (programs)
				draw_program(&p, &q);
			break;
		case 3:
			scissored_clear(&p, &q);
			break;
		case 4:
			pass = read_pixel(&p, q.x0, q.y0);
			break;
		case 5:
			/*
			 * Deeper than all that is there, so that the layers
			 * stay in order.
			 */
			if (i % 4 == 0)
				upload(&p, p.layers - 1, .96875 + i / 65536.);
			break;
		default:
			for (int j = 0; j < n; j++)
				quads[j] = random_quad(1000 * i + j);
			peel_draw(&p, quads, n);
		}
		/* Comparing ends the driver's batch, so not too often. */
		if (i % 61 == 60)
			pass = pass && peel_check(&p);
		if (i % 97 == 96)
			peel_clear(&p);
	}
	pass = pass && peel_check(&p);
	return peel_end(&p, pass);
}

static const struct peel_shape one = {
	1, W, H, 0, GL_DEPTH_COMPONENT32F, { GL_RGBA8 } };
static const struct peel_shape several = {
	4, W, H, 0, GL_DEPTH_COMPONENT32F, { GL_RGBA32F } };
static const struct peel_shape buffers = {
	3, W, H, 0, GL_DEPTH_COMPONENT32F, { GL_RGBA8, GL_RGBA8, GL_RGBA8 } };
static const struct peel_shape many = {
	33, W, H, 0, GL_DEPTH_COMPONENT32F, { GL_RGBA8 } };
static const struct peel_shape depth_only = {
	5, W, H, 0, GL_DEPTH_COMPONENT32F };

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("1-layer", interleaved, &one),
	KB_SUBTEST("4-layers", interleaved, &several),
	KB_SUBTEST("3-buffers", interleaved, &buffers),
	KB_SUBTEST("33-layers", interleaved, &many),
	KB_SUBTEST("depth-only", interleaved, &depth_only),
	KB_SUBTEST_END
};

PEEL_TEST(32)
