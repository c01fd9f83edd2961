/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-tiles.c
 * Where a fragment lies does not matter: scenes moved by 1 to 64 pixels,
 * framebuffers of many tiles and layers, more primitives than a driver holds
 * at a time.
 */

#include "peel-common.h"

/** Triangles in a viewport that moves over tiles and blocks. */
static enum piglit_result
moved(void *data)
{
	enum { W = 104, H = 96, NUM = 9 };
	struct peel p = peel_create(&(struct peel_shape) {
		3, W, H, 0, GL_DEPTH_COMPONENT32F, { GL_R32UI } });
	struct peel_vertex vertices[3 * NUM];
	bool pass = true;

	peel_seed(1);
	peel_random_triangles(vertices, NUM, 1);
	for (int i = 0; i <= 64 && pass; i += i < 9 ? 1 : 11) {
		peel_clear(&p);
		glViewport(i, i * 7 % 65, 35, 28);
		peel_draw_captured(&p, GL_TRIANGLES, vertices, 3 * NUM);
		pass = peel_check_layers(&p);
		if (!pass)
			printf("moved by (%d, %d)\n", i, i * 7 % 65);
	}
	return peel_end(&p, pass);
}

/** Quads moved likewise. */
static enum piglit_result
moved_quads(void *data)
{
	enum { W = 200, H = 136, NUM = 30 };
	struct peel p = peel_create(&(struct peel_shape) {
		5, W, H, 0, GL_DEPTH_COMPONENT32F, { GL_RGBA8 } });
	bool pass = true;

	for (int i = 0; i <= 64 && pass; i += 8 - i % 3) {
		struct peel_quad quads[NUM];

		peel_seed(1);
		for (int j = 0; j < NUM; j++) {
			const int x = i + peel_random(60);
			const int y = i + peel_random(40);

			quads[j] = (struct peel_quad) {
				x, y, x + 1 + peel_random(70),
				y + 1 + peel_random(30),
				(1 + peel_random(12)) / 16., i * NUM + j
			};
		}
		peel_clear(&p);
		peel_draw(&p, quads, NUM);
		pass = peel_check_layers(&p);
	}
	return peel_end(&p, pass);
}

/** Sizes around those of tiles and blocks. */
static enum piglit_result
sizes(void *data)
{
	static const int edges[] = { 1, 2, 3, 4, 5, 63, 64, 65, 129 };
	bool pass = true;

	for (int i = 0; i < ARRAY_SIZE(edges) * 2 && pass; i++) {
		const int w = i % 2 ? edges[i / 2] : 67;
		const int h = i % 2 ? 35 : edges[i / 2];
		struct peel p = peel_create(&(struct peel_shape) {
			4, w, h, 0, GL_DEPTH_COMPONENT32F, { GL_R16F } });

		peel_seed(i);
		for (int j = 0; j < 12; j++) {
			struct peel_quad q = peel_full(
				&p, (1 + peel_random(9)) / 16., j);

			q.x0 = peel_random(w);
			q.y1 -= peel_random(h);
			peel_draw(&p, &q, 1);
		}
		pass = peel_check(&p);
		if (!pass)
			printf("in %d x %d\n", w, h);
		peel_end(&p, pass);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Many tiles, many layers: 34 MB of color. */
static enum piglit_result
big(void *data)
{
	enum { W = 400, H = 330, NUM = 40 };
	struct peel p = peel_create(&(struct peel_shape) {
		16, W, H, 0, GL_DEPTH_COMPONENT32F, { GL_RGBA32F } });
	struct peel_quad quads[NUM];

	peel_seed(3);
	for (int i = 0; i < NUM; i++) {
		const int x = peel_random(250), y = peel_random(200);

		quads[i] = (struct peel_quad) {
			x, y, x + 1 + peel_random(150), y + 1 + peel_random(130),
			(1 + peel_random(200)) / 256., i
		};
	}
	peel_draw(&p, quads, NUM);
	return peel_end(&p, peel_check(&p));
}

/** Tens of thousands of tiny quads, in one draw and in hundreds. */
static enum piglit_result
tiny(void *data)
{
	enum { W = 130, H = 70, NUM = 60000 };
	struct peel p = peel_create(&(struct peel_shape) {
		8, W, H, 0, GL_DEPTH_COMPONENT32F, { GL_RGBA8, GL_R32UI } });
	const int at_a_time = *(const int *)data;
	struct peel_quad *quads = malloc(NUM * sizeof(*quads));
	bool pass;

	peel_seed(4);
	for (int i = 0; i < NUM; i++) {
		const int x = peel_random(W), y = peel_random(H);

		quads[i] = (struct peel_quad) {
			x, y, x + 1 + peel_random(3), y + 1 + peel_random(3),
			(1 + peel_random(1000)) / 1024., i
		};
	}
	for (int i = 0; i < NUM; i += at_a_time)
		peel_draw(&p, quads + i, MIN2(at_a_time, NUM - i));
	pass = peel_check(&p);
	free(quads);
	return peel_end(&p, pass);
}

static const int once = 60000, often = 150;

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("moved", moved, NULL),
	KB_SUBTEST("moved-quads", moved_quads, NULL),
	KB_SUBTEST("sizes", sizes, NULL),
	KB_SUBTEST("big", big, NULL),
	KB_SUBTEST("tiny-in-one-draw", tiny, &once),
	KB_SUBTEST("tiny-in-400-draws", tiny, &often),
	KB_SUBTEST_END
};

PEEL_TEST(32)
