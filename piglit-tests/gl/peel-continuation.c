/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-continuation.c
 * With FIRST_LAYER, passes of k layers give every fragment exactly once, in
 * order, however many share a depth; each pass equals the layers of one larger
 * pass.
 */

#include "peel-common.h"

#define MAX_NUM 320

/** Passes until OVERFLOW is zero: exactly as many as are needed. */
static bool
passes(struct peel *p, const struct peel_quad *quads, int n, int at_a_time,
       int deepest)
{
	const int k = p->layers, needed = MAX2(1, (deepest + k - 1) / k);
	int done = 0;

	do {
		if (done > 0)
			peel_next(p);
		for (int i = 0; i < n; i += at_a_time)
			peel_draw(p, quads + i, MIN2(at_a_time, n - i));
		if (!peel_check_ranks(p, quads, n) || !peel_check(p)) {
			printf("in pass %d of %d layers\n", done, k);
			return false;
		}
		done++;
	} while (peel_get(GL_DEPTH_PEELING_OVERFLOW_MESA) != 0 &&
		 done <= needed);

	if (done == needed)
		return true;
	printf("at least %d passes of %d layers for %d fragments\n", done, k,
	       deepest);
	return false;
}

struct scene { int num, depths; GLenum func, format; };

/** All pixels have all fragments. */
static enum piglit_result
coplanar(void *data)
{
	static const int layers[] = { 1, 3, 7, 8, 9, 64 };
	const struct scene *scene = data;
	bool pass = true;

	glDepthFunc(scene->func);
	glClearDepth(scene->func == GL_LESS ? 1 : 0);
	for (int i = 0; i < ARRAY_SIZE(layers) && pass; i++) {
		struct peel p;
		struct peel_quad quads[MAX_NUM];

		/* Hundreds of passes show nothing more. */
		if (scene->num / layers[i] > 60)
			continue;
		p = peel_create(&(struct peel_shape) {
			layers[i], 9, 6, 0, scene->format, { GL_R32UI } });
		peel_seed(i);
		for (int j = 0; j < scene->num; j++) {
			const int d = peel_random(scene->depths);
			const uint32_t code = peel_max_depth(p.depth) / 3 + d;

			quads[j] = peel_full(&p, peel_depth(p.depth, code), j);
		}
		pass = passes(&p, quads, scene->num, i % 2 ? scene->num : 13,
			      scene->num);
		peel_end(&p, pass);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Each pixel has others, some none; the deepest decides. */
static enum piglit_result
mixed(void *data)
{
	const struct scene *scene = data;
	bool pass = true;

	glDepthFunc(scene->func);
	glClearDepth(scene->func == GL_LESS ? 1 : 0);
	for (int k = 1; k < 12 && pass; k += 3) {
		struct peel p = peel_create(&(struct peel_shape) {
			k, 30, 20, 0, scene->format, { GL_R32UI, GL_RGBA8 } });
		struct peel_quad quads[MAX_NUM];
		int deepest = 0;

		peel_seed(k);
		for (int i = 0; i < scene->num; i++) {
			const int x = peel_random(20), y = peel_random(12);

			quads[i] = (struct peel_quad) {
				x, y, x + 10 + peel_random(21 - x),
				y + 8 + peel_random(13 - y),
				(1 + peel_random(scene->depths)) /
				(scene->depths + 1.), i
			};
		}
		for (int j = 0; j < 30 * 20; j++) {
			int n = 0;

			for (int i = 0; i < scene->num; i++)
				n += j % 30 >= quads[i].x0 &&
					j % 30 < quads[i].x1 &&
					j / 30 >= quads[i].y0 &&
					j / 30 < quads[i].y1;
			deepest = MAX2(deepest, n);
		}
		pass = passes(&p, quads, scene->num, 10, deepest);
		peel_end(&p, pass);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Four passes, and one with four times the layers, with slanted triangles. */
static enum piglit_result
larger_pass(void *data)
{
	enum { K = 3, NUM = 24 };
	const struct peel_shape shape = {
		4 * K, 40, 30, 0, GL_DEPTH_COMPONENT32F, { GL_R32UI }
	};
	struct peel_shape small = shape;
	struct peel_vertex vertices[3 * NUM];
	struct peel whole = peel_create(&shape), p;
	uint32_t *depth, *color;
	bool pass = true;

	peel_seed(4);
	peel_random_triangles(vertices, NUM / 2, 0);
	/* All twice. */
	memcpy(vertices + 3 * NUM / 2, vertices, sizeof(vertices) / 2);
	for (int i = 3 * NUM / 2; i < 3 * NUM; i++)
		vertices[i].id += NUM / 2;
	peel_draw_vertices(GL_TRIANGLES, vertices, 3 * NUM);
	depth = peel_read_depth(&whole);
	color = peel_read_color(&whole, 0);

	small.layers = K;
	p = peel_create(&small);
	for (int pass_no = 0; pass_no < 4 && pass; pass_no++) {
		const int n = K * shape.width * shape.height;
		uint32_t *d, *c;

		if (pass_no > 0)
			peel_next(&p);
		peel_draw_vertices(GL_TRIANGLES, vertices, 3 * NUM);
		d = peel_read_depth(&p);
		c = peel_read_color(&p, 0);
		pass = memcmp(d, depth + pass_no * n, n * 4) == 0 &&
			memcmp(c, color + pass_no * n * 4, n * 16) == 0;
		/* For the model's bound. */
		for (int i = 0; i < n; i++)
			p.model.depth[i % (n / K) * K + i / (n / K)] = d[i];
		if (!pass)
			printf("pass %d is not layers %d to %d\n", pass_no,
			       pass_no * K, pass_no * K + K - 1);
		free(d);
		free(c);
	}
	free(depth);
	free(color);
	peel_end(&whole, pass);
	return peel_end(&p, pass);
}

/**
 * The depth of a fragment does not depend on the fragment shader, so that each
 * pass can have another: all are the layers of a larger pass with one shader.
 */
static enum piglit_result
other_shaders(void *data)
{
	enum { K = 3, NUM = 40, PASSES = 5 };
	static const struct { const char *declarations, *statements; }
	shaders[PASSES] = {
		{ "", "" },
		{ "", "if (gl_FragCoord.x < 0) discard;" },
		{ "", "if (dFdx(gl_FragCoord.z) > 1e9) discard;" },
		{ "", "if (gl_FragCoord.w < -1 && !gl_FrontFacing) discard;" },
		{ "#extension GL_ARB_shader_bit_encoding: require\n",
		  "if (floatBitsToUint(gl_FragCoord.z) == 1u) discard;" },
	};
	const struct peel_shape shape = {
		PASSES * K, 60, 45, 0, *(const GLenum *)data, { GL_R32UI }
	};
	struct peel_shape small = shape;
	struct peel_vertex vertices[3 * NUM];
	struct peel whole = peel_create(&shape), p;
	const int n = K * shape.width * shape.height;
	uint32_t *depth, *color;
	bool pass = true;

	peel_seed(12);
	peel_random_triangles(vertices, NUM, 0);
	peel_draw_vertices(GL_TRIANGLES, vertices, 3 * NUM);
	depth = peel_read_depth(&whole);
	color = peel_read_color(&whole, 0);

	small.layers = K;
	p = peel_create(&small);
	for (int i = 0; i < PASSES && pass; i++) {
		uint32_t *d, *c;

		if (i > 0) {
			glFramebufferParameteri(GL_FRAMEBUFFER,
				GL_DEPTH_PEELING_FIRST_LAYER_MESA, i * K);
			peel_clear(&p);
		}
		peel_use_program(&p, shaders[i].declarations,
				 shaders[i].statements);
		peel_draw_vertices(GL_TRIANGLES, vertices, 3 * NUM);
		d = peel_read_depth(&p);
		c = peel_read_color(&p, 0);
		pass = memcmp(d, depth + i * n, n * 4) == 0 &&
			memcmp(c, color + i * n * 4, n * 16) == 0;
		if (!pass)
			printf("pass %d is not layers %d to %d\n", i, i * K,
			       i * K + K - 1);
		free(d);
		free(c);
	}
	free(depth);
	free(color);
	peel_end(&whole, pass);
	return peel_end(&p, pass);
}

/** 0 starts over, from any pass, as often as one likes. */
static enum piglit_result
start_over(void *data)
{
	struct peel p = peel_simple(3);
	struct peel_quad quads[11];
	bool pass = true;

	for (int i = 0; i < 11; i++)
		quads[i] = peel_full(&p, (1 + i % 4) / 8., i);
	for (int times = 0; times < 4 && pass; times++) {
		for (int i = 0; i <= times && pass; i++) {
			peel_draw(&p, quads, 11);
			pass = peel_check_ranks(&p, quads, 11) &&
				peel_check(&p);
			if (i < times)
				peel_next(&p);
		}
		peel_restart(&p);
	}
	return peel_end(&p, pass);
}

/** Behind the last fragment there is nothing, in any number of passes. */
static enum piglit_result
exhausted(void *data)
{
	struct peel p = peel_simple(4);
	const struct peel_quad quads[4] = {
		peel_full(&p, .5, 1), peel_full(&p, .5, 2),
		peel_full(&p, .25, 3), peel_full(&p, .5, 4),
	};
	bool pass = true;

	for (int i = 0; i < 5 && pass; i++) {
		if (i > 0)
			peel_next(&p);
		/* Exactly full, or one fragment short of it. */
		peel_draw(&p, quads, *(const int *)data);
		pass = peel_check_ranks(&p, quads, *(const int *)data) &&
			peel_check(&p);
	}
	return peel_end(&p, pass);
}

/**
 * Without clears nothing new comes into the layers, but the loop ends: no
 * sample gets further than its bound, so that all are exhausted.
 */
static enum piglit_result
never_cleared(void *data)
{
	struct peel p = peel_simple(3);
	struct peel_quad quads[10];
	int first = 0;
	bool pass;

	for (int i = 0; i < 10; i++)
		quads[i] = peel_full(&p, (1 + i % *(const int *)data) / 16., i);
	do {
		if (first > 0)
			glFramebufferParameteri(GL_FRAMEBUFFER,
				GL_DEPTH_PEELING_FIRST_LAYER_MESA, first);
		peel_draw_gl(&p, quads, 10);
		first += 3;
	} while (first < 30 && peel_get(GL_DEPTH_PEELING_OVERFLOW_MESA));
	/* The model does only the first pass, which is what is seen. */
	peel_draw_model(&p, quads, 10);
	pass = first < 30 && peel_check_layers(&p);
	if (!pass)
		printf("%d passes\n", first / 3);
	return peel_end(&p, pass);
}

/**
 * A bound counts fragments, and empty layers are none: those that come at just
 * the depth that empty layers had, when another depth is empty, are new.
 */
static enum piglit_result
at_former_empty_depth(void *data)
{
	struct peel p = peel_simple(*(const int *)data);
	struct peel_quad quads[7];
	bool pass = true;

	/* Pixels on the right are full, so that not all are exhausted. */
	glClearDepth(.5);
	peel_clear(&p);
	for (int i = 0; i < 7; i++)
		quads[i] = (struct peel_quad) { 9, 0, 16, 16, .25, 1 + i };
	peel_draw(&p, quads, 7);
	pass = peel_check(&p);

	peel_next(&p);
	glClearDepth(1);
	peel_clear(&p);
	for (int i = 0; i < 7; i++)
		quads[i] = peel_full(&p, .5, 10 + i);
	peel_draw(&p, quads, 7);
	pass = peel_check(&p) && pass;
	return peel_end(&p, pass);
}

/** Two framebuffers, each with a bound of its own, in turn. */
static enum piglit_result
two_framebuffers(void *data)
{
	struct peel p[2] = { peel_simple(2), peel_simple(5) };
	struct peel_quad quads[2][12];
	bool pass = true;

	for (int i = 0; i < 12; i++) {
		quads[0][i] = peel_full(&p[0], (1 + i % 3) / 8., i);
		quads[1][i] = peel_full(&p[1], (1 + i % 2) / 8., 100 + i);
	}
	for (int pass_no = 0; pass_no < 6; pass_no++) {
		for (int f = 0; f < 2; f++) {
			glBindFramebuffer(GL_FRAMEBUFFER, p[f].fbo);
			glUseProgram(p[f].program);
			if (pass_no > 0)
				peel_next(&p[f]);
		}
		for (int i = 0; i < 12; i += 4) {
			for (int f = 0; f < 2; f++) {
				glBindFramebuffer(GL_FRAMEBUFFER, p[f].fbo);
				peel_draw(&p[f], quads[f] + i, 4);
			}
		}
		for (int f = 0; f < 2 && pass; f++) {
			glBindFramebuffer(GL_FRAMEBUFFER, p[f].fbo);
			pass = peel_check_ranks(&p[f], quads[f], 12) &&
				peel_check(&p[f]);
		}
	}
	peel_end(&p[0], pass);
	return peel_end(&p[1], pass);
}

#define SCENE(num, depths, func, format) \
	&(const struct scene) { num, depths, GL_##func, GL_DEPTH_COMPONENT##format }

static const GLenum d32f = GL_DEPTH_COMPONENT32F, d24 = GL_DEPTH_COMPONENT24,
	d16 = GL_DEPTH_COMPONENT16;
static const int full = 4, short_of_full = 3, one_depth = 1, depths = 5;

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("40-coplanar", coplanar, SCENE(40, 1, LESS, 32F)),
	KB_SUBTEST("40-coplanar-greater", coplanar, SCENE(40, 1, GREATER, 32F)),
	KB_SUBTEST("40-coplanar-16", coplanar, SCENE(40, 1, LESS, 16)),
	KB_SUBTEST("300-coplanar", coplanar, SCENE(300, 1, LESS, 32F)),
	KB_SUBTEST("300-of-5-depths", coplanar, SCENE(300, 5, LESS, 32F)),
	KB_SUBTEST("100-neighbours", coplanar, SCENE(100, 100, LESS, 24)),
	KB_SUBTEST("mixed", mixed, SCENE(40, 5, LESS, 32F)),
	KB_SUBTEST("mixed-greater", mixed, SCENE(40, 5, GREATER, 32F)),
	KB_SUBTEST("mixed-16", mixed, SCENE(40, 5, LESS, 16)),
	KB_SUBTEST("mixed-24-many-depths", mixed, SCENE(60, 1000, LESS, 24)),
	KB_SUBTEST("larger-pass", larger_pass, NULL),
	KB_SUBTEST("other-shaders-32f", other_shaders, &d32f),
	KB_SUBTEST("other-shaders-24", other_shaders, &d24),
	KB_SUBTEST("other-shaders-16", other_shaders, &d16),
	KB_SUBTEST("start-over", start_over, NULL),
	KB_SUBTEST("exhausted-full", exhausted, &full),
	KB_SUBTEST("exhausted-short", exhausted, &short_of_full),
	KB_SUBTEST("never-cleared", never_cleared, &depths),
	KB_SUBTEST("never-cleared-coplanar", never_cleared, &one_depth),
	KB_SUBTEST("at-former-empty-depth", at_former_empty_depth,
		   &short_of_full),
	KB_SUBTEST("two-framebuffers", two_framebuffers, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
