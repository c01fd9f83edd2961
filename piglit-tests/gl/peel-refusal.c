/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-refusal.c
 * What an implementation refuses early cannot be seen.  Scenes of many slanted
 * triangles are drawn into k layers, of which most fragments fall out, and
 * into so many that none does, where there is nothing to refuse: the first k
 * layers are equal, bit for bit.
 */

#include "peel-common.h"

#define NUM 110
#define MANY 128

struct scene {
	GLenum func, depth;
	int samples;
	void (*setup)(struct peel *p);
	/** Triangles' size, the order, and the range of depths. */
	float size;
	int order;
	float near, far;
};

static struct peel
make(const struct scene *s, int layers)
{
	struct peel p = peel_create(&(struct peel_shape) {
		layers, s->samples ? 50 : 150, s->samples ? 40 : 100,
		s->samples, s->depth, { GL_R32UI } });

	if (s->setup)
		s->setup(&p);
	return p;
}

static float
random_float(float from, float to)
{
	return from + (to - from) * peel_random(10000) / 10000;
}

/** By the depth of the first corner. */
static int
compare(const void *a, const void *b)
{
	const struct peel_vertex *p = a, *q = b;
	const float x = p->z / p->w, y = q->z / q->w;

	return (x > y) - (x < y);
}

static void
triangles(const struct scene *s, struct peel_vertex *v)
{
	for (int i = 0; i < NUM; i++) {
		const float x = random_float(-1, 1), y = random_float(-1, 1);

		for (int j = 0; j < 3; j++) {
			const float w = random_float(1, 3);

			v[3 * i + j] = (struct peel_vertex) {
				(x + random_float(-s->size, s->size)) * w,
				(y + random_float(-s->size, s->size)) * w,
				random_float(s->near, s->far) * w, w
			};
		}
	}
	if (s->order)
		qsort(v, NUM, 3 * sizeof(*v), compare);
	for (int i = 0; s->order < 0 && i < NUM / 2; i++) {
		for (int j = 0; j < 3; j++) {
			const int o = 3 * (NUM - 1 - i) + j;
			const struct peel_vertex swap = v[3 * i + j];

			v[3 * i + j] = v[o];
			v[o] = swap;
		}
	}
	/* Each fifth is the one before it: equal depths. */
	for (int i = 5; i < NUM; i += 5)
		memcpy(v + 3 * i, v + 3 * i - 3, 3 * sizeof(*v));
	for (int i = 0; i < 3 * NUM; i++)
		v[i].id = 1 + i / 3;
}

/** Read an attachment in the order sample, layer, y, x. */
static uint32_t *
read_codes(const struct peel *p, bool color)
{
	if (p->samples)
		return peel_read_samples(p, color ? p->color_tex[0] :
					 p->depth_tex, color ? p->color[0] :
					 p->depth);
	return color ? peel_read_color(p, 0) : peel_read_depth(p);
}

static bool
first_layers_equal(const struct peel *p, const struct peel *whole, bool color)
{
	const int n = p->width * p->height * (color ? 4 : 1);
	uint32_t *a = read_codes(p, color), *b = read_codes(whole, color);
	bool pass = true;

	for (int i = 0; i < MAX2(p->samples, 1) * p->layers * n && pass; i++) {
		const int s = i / n / p->layers, l = i / n % p->layers;
		const int pixel = i % n / (color ? 4 : 1);
		const uint32_t expected = b[(s * MANY + l) * n + i % n];

		if (a[i] == expected)
			continue;
		printf("%s of layer %d of %d at (%d, %d), sample %d: %08x, "
		       "expected %08x\n", color ? "color" : "depth", l,
		       p->layers, pixel % p->width, pixel / p->width, s, a[i],
		       expected);
		pass = false;
	}
	free(a);
	free(b);
	return pass;
}

static enum piglit_result
refusal(void *data)
{
	const struct scene *s = data;
	struct peel whole;
	struct peel_vertex vertices[3 * NUM];
	GLint max = 0;
	bool pass = true;

	glGetIntegerv(GL_MAX_SAMPLES, &max);
	if (max < s->samples) {
		printf("there are no %d samples here\n", s->samples);
		return PIGLIT_SKIP;
	}
	glDepthFunc(s->func);
	glClearDepth(s->func == GL_LESS || s->func == GL_LEQUAL ? 1 : 0);
	peel_seed(17);
	triangles(s, vertices);
	whole = make(s, MANY);
	peel_draw_vertices(GL_TRIANGLES, vertices, 3 * NUM);
	if (peel_get(GL_DEPTH_PEELING_OVERFLOW_MESA)) {
		printf("%d layers are not enough\n", MANY);
		pass = false;
	}
	for (int k = 1; k <= 16 && pass; k = 2 * k + (k == 2)) {
		struct peel p = make(s, k);

		/* Half of them each in a draw of its own. */
		for (int i = 0; i < NUM / 2; i++)
			peel_draw_vertices(GL_TRIANGLES, vertices + 3 * i, 3);
		peel_draw_vertices(GL_TRIANGLES, vertices + 3 * (NUM / 2),
				   3 * (NUM - NUM / 2));
		pass = first_layers_equal(&p, &whole, false) &&
			first_layers_equal(&p, &whole, true);
		glBindFramebuffer(GL_FRAMEBUFFER, p.fbo);
		if (pass && !peel_get(GL_DEPTH_PEELING_OVERFLOW_MESA)) {
			printf("%d layers are enough\n", k);
			pass = false;
		}
		peel_end(&p, pass);
	}
	return peel_end(&whole, pass);
}

static void
discard(struct peel *p)
{
	peel_use_program(p, "", "if ((int(gl_FragCoord.x) ^ "
			 "int(gl_FragCoord.y) ^ int(id)) % 3 == 0) discard;");
}

static void
shader_depth(struct peel *p)
{
	peel_use_program(p, "", "gl_FragDepth = 1.0 - gl_FragCoord.z;");
}

static void
offset(struct peel *p)
{
	glEnable(GL_POLYGON_OFFSET_FILL);
	glPolygonOffset(1.5, 1000);
}

static void
depth_range(struct peel *p)
{
	glDepthRange(.75, .25);
}

static void
depth_clamp(struct peel *p)
{
	glEnable(GL_DEPTH_CLAMP);
}

#define SCENE(...) &(const struct scene) { __VA_ARGS__ }
#define F32 GL_DEPTH_COMPONENT32F
#define F24 GL_DEPTH_COMPONENT24
#define F16 GL_DEPTH_COMPONENT16

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("less", refusal, SCENE(GL_LESS, F32, 0, NULL, 1, 0, 0, 1)),
	KB_SUBTEST("lequal", refusal,
		   SCENE(GL_LEQUAL, F24, 0, NULL, 1, 0, 0, 1)),
	KB_SUBTEST("greater", refusal,
		   SCENE(GL_GREATER, F16, 0, NULL, 1, 0, 0, 1)),
	KB_SUBTEST("gequal", refusal,
		   SCENE(GL_GEQUAL, F32, 0, NULL, 1, 0, 0, 1)),
	KB_SUBTEST("front-to-back", refusal,
		   SCENE(GL_LESS, F32, 0, NULL, 2, 1, .2, .9)),
	KB_SUBTEST("back-to-front", refusal,
		   SCENE(GL_LESS, F24, 0, NULL, 2, -1, .2, .9)),
	KB_SUBTEST("front-to-back-greater", refusal,
		   SCENE(GL_GREATER, F24, 0, NULL, 2, -1, .2, .9)),
	KB_SUBTEST("small", refusal,
		   SCENE(GL_LESS, F32, 0, NULL, .5, 0, .1, .9)),
	KB_SUBTEST("close", refusal,
		   SCENE(GL_LESS, F32, 0, NULL, 1, 0, .5, .50001)),
	KB_SUBTEST("close-16", refusal,
		   SCENE(GL_LESS, F16, 0, NULL, 1, 1, .5, .501)),
	KB_SUBTEST("huge", refusal,
		   SCENE(GL_LESS, F24, 0, NULL, 30, 0, .4, .6)),
	KB_SUBTEST("clipped-by-depth", refusal,
		   SCENE(GL_LESS, F32, 0, NULL, 1, 0, -.5, 1.5)),
	KB_SUBTEST("discard", refusal,
		   SCENE(GL_LESS, F32, 0, discard, 1, 1, 0, 1)),
	KB_SUBTEST("shader-depth", refusal,
		   SCENE(GL_LESS, F32, 0, shader_depth, 1, 1, 0, 1)),
	KB_SUBTEST("polygon-offset", refusal,
		   SCENE(GL_LESS, F24, 0, offset, 1, 1, 0, .9)),
	KB_SUBTEST("depth-range-reversed", refusal,
		   SCENE(GL_LESS, F32, 0, depth_range, 1, -1, 0, 1)),
	KB_SUBTEST("depth-clamp", refusal,
		   SCENE(GL_GREATER, F32, 0, depth_clamp, 1, -1, -.5, 1.5)),
	KB_SUBTEST("4-samples", refusal,
		   SCENE(GL_LESS, F32, 4, NULL, 1, 1, 0, 1)),
	KB_SUBTEST("4-samples-greater", refusal,
		   SCENE(GL_GREATER, F16, 4, NULL, 1, 0, 0, 1)),
	KB_SUBTEST_END
};

PEEL_TEST(32)
