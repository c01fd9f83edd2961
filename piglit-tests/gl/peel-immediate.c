/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-immediate.c
 * Vertices between Begin and End, which an implementation gathers over several
 * of them: state that follows is that of later vertices, not of these.
 */

#include "peel-common.h"

#define K 3

static struct peel
make(void)
{
	struct peel p = peel_create(&(struct peel_shape) {
		K, 32, 24, 0, GL_DEPTH_COMPONENT32F, { GL_RGBA8 } });

	glUseProgram(0);
	return p;
}

/** A quad over all pixels, drawn with what peel_draw_model() takes for it. */
static struct peel_quad
draw(struct peel *p, float z, uint32_t id)
{
	const struct peel_quad q = peel_full(p, z, id);
	GLubyte color[4];

	for (int c = 0; c < 4; c++)
		color[c] = peel_color_code(p->color[0], 0, c, id);
	glBegin(GL_QUADS);
	glColor4ubv(color);
	glVertex3f(-1, -1, z);
	glVertex3f(1, -1, z);
	glVertex3f(1, 1, z);
	glVertex3f(-1, 1, z);
	glEnd();
	return q;
}

static enum piglit_result
clear_depth(void *data)
{
	struct peel p = make();
	struct peel_quad q[3];

	q[0] = draw(&p, .5, 1);
	glClearDepth(.25);
	q[1] = draw(&p, .375, 2);
	glClearDepth(1);
	q[2] = draw(&p, .75, 3);

	/* The first and the third. */
	peel_draw_model(&p, &q[0], 1);
	peel_draw_model(&p, &q[2], 1);
	return peel_end(&p, peel_check(&p));
}

static enum piglit_result
depth_func(void *data)
{
	struct peel p = make();
	struct peel_quad q[4];

	for (int i = 0; i < 4; i++) {
		glDepthFunc(i % 2 ? GL_LEQUAL : GL_LESS);
		q[i] = draw(&p, .5, i);
	}
	for (int i = 0; i < 4; i++) {
		glDepthFunc(i % 2 ? GL_LEQUAL : GL_LESS);
		peel_draw_model(&p, &q[i], 1);
	}
	return peel_end(&p, peel_check(&p));
}

static enum piglit_result
masks(void *data)
{
	struct peel p = make();
	struct peel_quad q[4];

	for (int times = 0; times < 2; times++) {
		for (int i = 0; i < 4; i++) {
			glDepthMask(i != 1);
			glColorMask(GL_TRUE, i != 2, GL_TRUE, i != 3);
			if (times == 0)
				q[i] = draw(&p, .5 - i / 16., i);
			else
				peel_draw_model(&p, &q[i], 1);
		}
	}
	return peel_end(&p, peel_check(&p));
}

/** One fragment by the depth test, among inserted ones. */
static enum piglit_result
disable(void *data)
{
	struct peel p = make();
	struct peel_quad q[3];

	q[0] = draw(&p, .5, 1);
	glDisable(GL_DEPTH_PEELING_MESA);
	glEnable(GL_DEPTH_TEST);
	q[1] = draw(&p, .25, 2);
	glDisable(GL_DEPTH_TEST);
	glEnable(GL_DEPTH_PEELING_MESA);
	q[2] = draw(&p, .375, 3);

	/* The second takes the place of the first. */
	peel_draw_model(&p, &q[1], 1);
	peel_draw_model(&p, &q[2], 1);
	return peel_end(&p, peel_check(&p));
}

static enum piglit_result
overflow(void *data)
{
	struct peel p = make();
	bool pass;

	for (int i = 0; i < K; i++)
		draw(&p, .5, i);
	pass = peel_get(GL_DEPTH_PEELING_OVERFLOW_MESA) == 0;
	draw(&p, .5, K);
	pass = peel_get(GL_DEPTH_PEELING_OVERFLOW_MESA) != 0 && pass;
	if (!pass)
		printf("OVERFLOW is not that of the draws before\n");
	return peel_end(&p, pass);
}

/** The bound is taken from what was drawn before it. */
static enum piglit_result
first_layer(void *data)
{
	struct peel p = make();
	struct peel_quad q[7];
	bool pass = true;

	for (int i = 0; i < 3; i++) {
		for (int j = 0; j < 7; j++)
			q[j] = draw(&p, .5 - j % 2 / 4., j);
		peel_draw_model(&p, q, 7);
		if (i < 2)
			peel_next(&p);
	}
	pass = peel_check_ranks(&p, q, 7) && peel_check(&p);
	return peel_end(&p, pass);
}

/** All of it in a display list. */
static enum piglit_result
display_list(void *data)
{
	struct peel p = make();
	struct peel_quad q[6];
	const GLuint list = glGenLists(1);

	glDisable(GL_DEPTH_PEELING_MESA);
	glNewList(list, GL_COMPILE);
	glEnable(GL_DEPTH_PEELING_MESA);
	for (int i = 0; i < 6; i++)
		q[i] = draw(&p, (1 + i * 5 % 6) / 8., i);
	glDisable(GL_DEPTH_PEELING_MESA);
	glEndList();
	glCallList(list);
	glDeleteLists(list, 1);
	peel_draw_model(&p, q, 6);
	return peel_end(&p, peel_check_ranks(&p, q, 6) && peel_check(&p));
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("clear-depth", clear_depth, NULL),
	KB_SUBTEST("depth-func", depth_func, NULL),
	KB_SUBTEST("masks", masks, NULL),
	KB_SUBTEST("disable", disable, NULL),
	KB_SUBTEST("overflow", overflow, NULL),
	KB_SUBTEST("first-layer", first_layer, NULL),
	KB_SUBTEST("display-list", display_list, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
