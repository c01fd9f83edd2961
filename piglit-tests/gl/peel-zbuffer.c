/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-zbuffer.c
 * One layer with LESS is the Z-buffer, bit for bit, and so are the other three
 * functions: random triangles are drawn with both.  Rounding errors that leave
 * [0, 1] in an ordinary depth buffer of floats are none here.
 */

#include "peel-common.h"

#define NUM 150

/** Do the two hold the same bits? */
static bool
same(const struct peel *p, const struct peel *q)
{
	const int n = p->width * p->height;
	uint32_t *a = peel_read_depth(p), *b = peel_read_depth(q);
	bool pass = true;
	int covered = 0;

	for (int i = 0; i < n && pass; i++) {
		covered += a[i] != a[0];
		pass = a[i] == peel_clamp_depth(q->depth, b[i]);
		if (!pass)
			printf("depth at (%d, %d) is %08x, with the depth test "
			       "%08x\n", i % p->width, i / p->width, a[i],
			       b[i]);
	}
	if (covered == 0) {
		printf("nothing was drawn\n");
		pass = false;
	}
	free(a);
	free(b);
	a = peel_read_color(p, 0);
	b = peel_read_color(q, 0);
	for (int i = 0; i < n && pass; i++) {
		pass = memcmp(a + 4 * i, b + 4 * i, 16) == 0;
		if (!pass)
			printf("color at (%d, %d) is %08x, with the depth test "
			       "%08x\n", i % p->width, i / p->width, a[4 * i],
			       b[4 * i]);
	}
	free(a);
	free(b);
	return pass;
}

static bool
zbuffer(GLenum func, GLenum format, float clear)
{
	const struct peel_shape shape = {
		1, 70, 45, 0, format, { GL_RGBA32UI }
	};
	struct peel p, q;
	struct peel_vertex vertices[3 * NUM];
	bool pass;

	peel_seed(func + format);
	peel_random_triangles(vertices, NUM, 1);
	/* Some of them twice, for equal depths. */
	for (int i = 0; i < NUM / 10; i++) {
		for (int j = 0; j < 3; j++) {
			vertices[3 * (NUM - 1 - i) + j] = vertices[3 * i + j];
			vertices[3 * (NUM - 1 - i) + j].id = NUM - 1 - i;
		}
	}
	glDepthFunc(func);
	glClearDepth(clear);
	p = peel_create(&shape);
	peel_draw_vertices(GL_TRIANGLES, vertices, 3 * NUM);
	q = peel_create(&shape);
	glDisable(GL_DEPTH_PEELING_MESA);
	glEnable(GL_DEPTH_TEST);
	peel_draw_vertices(GL_TRIANGLES, vertices, 3 * NUM);
	glDisable(GL_DEPTH_TEST);
	pass = same(&p, &q);
	peel_end(&p, pass);
	return peel_end(&q, pass) == PIGLIT_PASS;
}

static enum piglit_result
test(void *data)
{
	static const GLenum formats[] = {
		GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT24,
		GL_DEPTH_COMPONENT16, GL_DEPTH24_STENCIL8,
		GL_DEPTH32F_STENCIL8,
	};
	const GLenum func = *(const GLenum *)data;
	const bool less = func == GL_LESS || func == GL_LEQUAL;

	for (int i = 0; i < ARRAY_SIZE(formats); i++) {
		if (!zbuffer(func, formats[i], less ? 1 : 0) ||
		    !zbuffer(func, formats[i], less ? .625 : .375)) {
			printf("in %s\n", piglit_get_gl_enum_name(formats[i]));
			return PIGLIT_FAIL;
		}
	}
	return PIGLIT_PASS;
}

static const GLenum funcs[] = { GL_LESS, GL_LEQUAL, GL_GREATER, GL_GEQUAL };

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("less", test, &funcs[0]),
	KB_SUBTEST("lequal", test, &funcs[1]),
	KB_SUBTEST("greater", test, &funcs[2]),
	KB_SUBTEST("gequal", test, &funcs[3]),
	KB_SUBTEST_END
};

PEEL_TEST(32)
