/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-lines-points.c
 * Fragments of lines and points, of any width, are inserted as those of
 * triangles; with those of triangles in the order of drawing.
 */

#include "peel-common.h"

#define NUM 14

static struct peel
make(int layers)
{
	return peel_create(&(struct peel_shape) {
		layers, 45, 38, 0, GL_DEPTH_COMPONENT32F, { GL_R32UI } });
}

static bool
draw(struct peel *p, GLenum mode, int vertices_each)
{
	struct peel_vertex vertices[3 * NUM];

	peel_random_triangles(vertices, NUM, peel_random(1000));
	if (mode == GL_POINTS) {
		/* Points near another, and some on the same pixel. */
		for (int i = 0; i < NUM; i++) {
			vertices[i].x /= 4;
			vertices[i].y /= 4;
		}
	}
	peel_draw_captured(p, mode, vertices, vertices_each * NUM);
	return peel_check(p);
}

static enum piglit_result
points(void *data)
{
	struct peel p = make(4);

	glPointSize(*(const float *)data);
	peel_seed(1);
	return peel_end(&p, draw(&p, GL_POINTS, 1));
}

static enum piglit_result
lines(void *data)
{
	struct peel p = make(4);

	glLineWidth(*(const float *)data);
	peel_seed(2);
	return peel_end(&p, draw(&p, GL_LINES, 2));
}

static enum piglit_result
stippled_lines(void *data)
{
	struct peel p = make(4);

	glEnable(GL_LINE_STIPPLE);
	glLineStipple(2, 0x5b37);
	peel_seed(3);
	return peel_end(&p, draw(&p, GL_LINES, 2));
}

static enum piglit_result
mixed(void *data)
{
	struct peel p = make(6);
	bool pass = true;

	peel_seed(4);
	glPointSize(6);
	for (int i = 0; i < 6 && pass; i++) {
		const int vertices = 1 + (i + 1) % 3;

		pass = draw(&p, vertices == 1 ? GL_POINTS : vertices == 2 ?
			    GL_LINES : GL_TRIANGLES, vertices);
	}
	return peel_end(&p, pass);
}

/** A sequence of single fragments at each pixel. */
static enum piglit_result
fragments(void *data)
{
	enum { N = 3000 };
	struct peel p = make(7);
	struct peel_vertex *vertices = malloc(N * sizeof(*vertices));
	bool pass;

	peel_seed(5);
	for (int i = 0; i < N; i++) {
		const int x = peel_random(11), y = peel_random(9);
		const struct peel_quad q = {
			x, y, x + 1, y + 1, (1 + peel_random(20)) / 32., i
		};

		vertices[i] = (struct peel_vertex) {
			(2 * x + 1) / 45. - 1, (2 * y + 1) / 38. - 1, q.z, 1, i
		};
		peel_draw_model(&p, &q, 1);
	}
	peel_draw_vertices(GL_POINTS, vertices, N);
	pass = peel_check(&p);
	free(vertices);
	return peel_end(&p, pass);
}

/** The corners of triangles are the same as points. */
static enum piglit_result
polygon_mode(void *data)
{
	struct peel p = make(4), q = make(4);
	struct peel_vertex vertices[3 * NUM];
	uint32_t *depth, *color;
	bool pass, full = false;

	peel_seed(6);
	peel_random_triangles(vertices, NUM, 1);
	/* Inside of the view, so that nothing is clipped. */
	for (int i = 0; i < 3 * NUM; i++) {
		vertices[i].w *= 1.5;
		vertices[i].z = vertices[i].w * (i % 16 + 1) / 32.;
	}
	glPointSize(7);
	peel_draw_vertices(GL_POINTS, vertices, 3 * NUM);
	depth = peel_read_depth(&q);
	color = peel_read_color(&q, 0);
	/* The model of p is what q holds. */
	for (int i = 0; i < 45 * 38 * 4; i++) {
		const int at = i % (45 * 38) * 4 + i / (45 * 38);

		p.model.depth[at] = depth[i];
		full |= i >= 45 * 38 * 3 && depth[i] < peel_max_depth(q.depth);
		memcpy(p.model.color[at], color + 4 * i, 16);
	}
	p.model.overflow = peel_get(GL_DEPTH_PEELING_OVERFLOW_MESA);
	glBindFramebuffer(GL_FRAMEBUFFER, p.fbo);
	glPolygonMode(GL_FRONT_AND_BACK, GL_POINT);
	peel_draw_vertices(GL_TRIANGLES, vertices, 3 * NUM);
	pass = peel_check(&p);
	if (!full) {
		printf("there is nothing in the last layer\n");
		pass = false;
	}
	free(depth);
	free(color);
	peel_end(&p, pass);
	return peel_end(&q, pass);
}

static const float one = 1, wide = 5;

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("points", points, &one),
	KB_SUBTEST("wide-points", points, &wide),
	KB_SUBTEST("lines", lines, &one),
	KB_SUBTEST("wide-lines", lines, &wide),
	KB_SUBTEST("stippled-lines", stippled_lines, NULL),
	KB_SUBTEST("mixed", mixed, NULL),
	KB_SUBTEST("fragments", fragments, NULL),
	KB_SUBTEST("polygon-mode-point", polygon_mode, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
