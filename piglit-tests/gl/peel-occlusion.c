/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-occlusion.c
 * Occlusion queries count the samples at which a fragment was inserted.
 */

#include "peel-common.h"

#define K 3
#define NUM 25

static struct peel
make(int samples)
{
	return peel_create(&(struct peel_shape) {
		K, 50, 37, samples, GL_DEPTH_COMPONENT32F, { GL_R8 } });
}

static GLuint
begin(struct peel *p, GLenum target)
{
	GLuint query;

	glGenQueries(1, &query);
	glBeginQuery(target, query);
	p->inserted = 0;
	return query;
}

static bool
end(struct peel *p, GLenum target, GLuint query)
{
	const GLuint expected = target == GL_SAMPLES_PASSED ? p->inserted :
		p->inserted > 0;
	GLuint n = ~0u;

	glEndQuery(target);
	glGetQueryObjectuiv(query, GL_QUERY_RESULT, &n);
	glDeleteQueries(1, &query);
	if (n == expected)
		return true;
	printf("%s is %u, expected %u\n", piglit_get_gl_enum_name(target), n,
	       expected);
	return false;
}

static void
draw(struct peel *p, int seed)
{
	struct peel_quad quads[NUM];

	peel_seed(seed);
	for (int i = 0; i < NUM; i++) {
		const int x = peel_random(30), y = peel_random(20);

		quads[i] = (struct peel_quad) {
			x, y, x + 1 + peel_random(20), y + 1 + peel_random(17),
			(1 + peel_random(9)) / 16., i
		};
	}
	peel_draw(p, quads, NUM);
}

static bool
count(struct peel *p)
{
	bool pass = true;

	for (int i = 0; i < 4; i++) {
		GLuint query = begin(p, GL_SAMPLES_PASSED);

		draw(p, i);
		pass = end(p, GL_SAMPLES_PASSED, query) && pass;
	}
	return peel_check(p) && pass;
}

static enum piglit_result
samples_passed(void *data)
{
	static const GLenum funcs[] = { GL_LESS, GL_LEQUAL, GL_GREATER };
	bool pass = true;

	for (int i = 0; i < ARRAY_SIZE(funcs); i++) {
		struct peel p;

		glDepthFunc(funcs[i]);
		glClearDepth(funcs[i] == GL_GREATER ? 0 : 1);
		p = make(0);
		pass = count(&p) && pass;
		peel_end(&p, pass);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Of full layers only what comes in counts. */
static enum piglit_result
refused(void *data)
{
	struct peel p = make(0);
	struct peel_quad q = peel_full(&p, .25, 1);
	const GLenum target = *(const GLenum *)data;
	bool pass;
	GLuint query;

	for (int i = 0; i < K; i++)
		peel_draw(&p, &q, 1);
	query = begin(&p, target);
	peel_draw(&p, &q, 1);
	pass = p.inserted == 0 && end(&p, target, query);

	query = begin(&p, target);
	peel_draw(&p, &q, 1);
	q = (struct peel_quad) { 3, 4, 8, 7, .125, 2 };
	peel_draw(&p, &q, 1);
	pass = p.inserted == 15 && end(&p, target, query) && pass;

	/* Nor does what is not nearer than the clear depth, */
	peel_clear(&p);
	glClearDepth(.25);
	q = peel_full(&p, .25, 1);
	query = begin(&p, target);
	peel_draw(&p, &q, 1);
	pass = p.inserted == 0 && end(&p, target, query) && pass;

	/* nor anything with DepthMask false. */
	glDepthMask(GL_FALSE);
	q = peel_full(&p, .125, 1);
	query = begin(&p, target);
	peel_draw(&p, &q, 1);
	pass = p.inserted == 0 && end(&p, target, query) && pass;
	return peel_end(&p, pass);
}

/** Colors that are masked do not matter. */
static enum piglit_result
color_masked(void *data)
{
	struct peel p = make(0);
	bool pass;

	glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
	pass = count(&p);
	return peel_end(&p, pass);
}

/** Nor whether there are any. */
static enum piglit_result
no_color(void *data)
{
	struct peel p = peel_create(&(struct peel_shape) {
		K, 50, 37, 0, GL_DEPTH_COMPONENT24 });
	bool pass = count(&p);

	return peel_end(&p, pass);
}

static bool
even(int x, int y, int sample, uint32_t id)
{
	return x % 2 == 0;
}

static enum piglit_result
discarded(void *data)
{
	struct peel p = make(0);
	GLuint query;
	bool pass;

	peel_use_program(&p, "", "if (int(gl_FragCoord.x) % 2 == 1) discard;");
	p.stays = even;
	query = begin(&p, GL_SAMPLES_PASSED);
	draw(&p, 3);
	pass = end(&p, GL_SAMPLES_PASSED, query);
	return peel_end(&p, peel_check_layers(&p) && pass);
}

static enum piglit_result
shader_depth(void *data)
{
	struct peel p = make(0);
	bool pass;

	peel_use_program(&p, "", "gl_FragDepth = gl_FragCoord.z;");
	pass = count(&p);
	return peel_end(&p, pass);
}

/** In later passes, what is behind the bound. */
static enum piglit_result
passes(void *data)
{
	struct peel p = make(0);
	bool pass = true;

	for (int i = 0; i < 4; i++) {
		GLuint query;

		if (i > 0)
			peel_next(&p);
		query = begin(&p, GL_SAMPLES_PASSED);
		draw(&p, 7);
		pass = end(&p, GL_SAMPLES_PASSED, query) && pass;
	}
	return peel_end(&p, peel_check(&p) && pass);
}

/** The query decides over a later draw. */
static enum piglit_result
conditional_render(void *data)
{
	struct peel p = make(0);
	struct peel_quad q = peel_full(&p, .5, 1);
	GLuint query;
	bool pass;

	for (int i = 0; i < K; i++)
		peel_draw(&p, &q, 1);
	glGenQueries(1, &query);
	glBeginQuery(GL_SAMPLES_PASSED, query);
	peel_draw(&p, &q, 1);
	glEndQuery(GL_SAMPLES_PASSED);
	q.z = .25;
	glBeginConditionalRender(query, GL_QUERY_WAIT);
	peel_draw_gl(&p, &q, 1);
	glEndConditionalRender();
	pass = peel_check(&p);
	glDeleteQueries(1, &query);
	return peel_end(&p, pass);
}

static const GLenum samples = GL_SAMPLES_PASSED, any = GL_ANY_SAMPLES_PASSED;

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("samples-passed", samples_passed, NULL),
	KB_SUBTEST("refused", refused, &samples),
	KB_SUBTEST("any-refused", refused, &any),
	KB_SUBTEST("color-masked", color_masked, NULL),
	KB_SUBTEST("no-color", no_color, NULL),
	KB_SUBTEST("discarded", discarded, NULL),
	KB_SUBTEST("shader-depth", shader_depth, NULL),
	KB_SUBTEST("passes", passes, NULL),
	KB_SUBTEST("conditional-render", conditional_render, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
