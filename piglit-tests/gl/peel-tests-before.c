/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-tests-before.c
 * Fragments are inserted after the tests that come first: scissor, stipple,
 * discard, alpha test.  A fragment that such a test refuses leaves
 * no trace, whatever is in the layers.  Those of samples are in
 * peel-coverage.c.
 */

#include "peel-common.h"

#define K 4
#define NUM 10

static struct peel
make(void)
{
	return peel_create(&(struct peel_shape) {
		K, 40, 36, 0, GL_DEPTH_COMPONENT32F, { GL_RGBA8 } });
}

static void
random_quads(const struct peel *p, struct peel_quad *quads)
{
	peel_seed(8);
	for (int i = 0; i < NUM; i++)
		quads[i] = (struct peel_quad) {
			peel_random(p->width / 3), peel_random(p->height / 3),
			p->width - peel_random(p->width / 3),
			p->height - peel_random(p->height / 3),
			(1 + peel_random(7)) / 8., i
		};
}

static enum piglit_result
draw_and_check(struct peel *p)
{
	struct peel_quad quads[NUM];

	random_quads(p, quads);
	peel_draw(p, quads, NUM);
	/* A refused fragment may be taken for one that falls behind. */
	if (p->stays && peel_get(GL_DEPTH_PEELING_OVERFLOW_MESA))
		p->model.overflow = true;
	return peel_end(p, peel_check(p));
}

static enum piglit_result
draw_captured_and_check(struct peel *p)
{
	struct peel_vertex vertices[3 * NUM];

	peel_seed(8);
	peel_random_triangles(vertices, NUM, 1);
	peel_draw_captured(p, GL_TRIANGLES, vertices, 3 * NUM);
	if (peel_get(GL_DEPTH_PEELING_OVERFLOW_MESA))
		p->model.overflow = true;
	return peel_end(p, peel_check(p));
}

static enum piglit_result
scissor(void *data)
{
	struct peel p = make();

	glEnable(GL_SCISSOR_TEST);
	glScissor(7, 13, 19, 10);
	return draw_and_check(&p);
}

static bool
not_discarded(int x, int y, int sample, uint32_t id)
{
	return (x * 3 + y * 5 + id) % 4 != 0;
}

static enum piglit_result
discard(void *data)
{
	struct peel p = make();

	peel_use_program(&p, "", "if ((uint(gl_FragCoord.x) * 3u + "
			 "uint(gl_FragCoord.y) * 5u + id) % 4u == 0u) discard;");
	p.stays = not_discarded;
	return draw_and_check(&p);
}

static bool
never(int x, int y, int sample, uint32_t id)
{
	return false;
}

static enum piglit_result
discard_all(void *data)
{
	struct peel p = make();

	peel_use_program(&p, "", "discard;");
	p.stays = never;
	return draw_and_check(&p);
}

/** The alpha of RGBA8 fragments is a number of 255ths. */
static bool
alpha_passes(int x, int y, int sample, uint32_t id)
{
	return peel_color_code(peel_format(GL_RGBA8), 0, 3, id) >= 128;
}

static enum piglit_result
alpha_test(void *data)
{
	struct peel p = make();

	glEnable(GL_ALPHA_TEST);
	glAlphaFunc(GL_GEQUAL, .5);
	p.stays = alpha_passes;
	return draw_and_check(&p);
}

static enum piglit_result
alpha_test_never(void *data)
{
	struct peel p = make();

	glEnable(GL_ALPHA_TEST);
	glAlphaFunc(GL_NEVER, 0);
	p.stays = never;
	return draw_and_check(&p);
}

static enum piglit_result
stipple(void *data)
{
	struct peel p = make();
	GLubyte pattern[128];

	for (int i = 0; i < 128; i++)
		pattern[i] = 0x93 ^ i * 37;
	glPolygonStipple(pattern);
	glEnable(GL_POLYGON_STIPPLE);
	return draw_captured_and_check(&p);
}

/** What decides over whole primitives and their depth. */
static enum piglit_result
polygon_state(void *data)
{
	struct peel p = make();

	glEnable(GL_CULL_FACE);
	glEnable(GL_POLYGON_OFFSET_FILL);
	glPolygonOffset(2, 40);
	return draw_captured_and_check(&p);
}

static enum piglit_result
depth_clamp(void *data)
{
	struct peel p = make();

	glEnable(GL_DEPTH_CLAMP);
	glDepthRange(.25, .75);
	return draw_captured_and_check(&p);
}

/** The viewport that a primitive selects is not ignored. */
static enum piglit_result
viewport_index(void *data)
{
	static const int corners[6][2] = {
		{ -1, -1 }, { 1, -1 }, { 1, 1 }, { -1, -1 }, { 1, 1 }, { -1, 1 }
	};
	struct peel p = make();
	struct peel_quad q;

	if (!piglit_is_extension_supported("GL_ARB_viewport_array")) {
		printf("no viewport arrays here\n");
		peel_end(&p, true);
		return PIGLIT_SKIP;
	}
	p.program = kb_use_glsl(
		"#version 150 compatibility\n"
		"void main() { gl_Position = gl_Vertex; }\n",
		"#version 150 compatibility\n"
		"#extension GL_ARB_viewport_array: require\n"
		"layout(triangles) in;\n"
		"layout(triangle_strip, max_vertices = 3) out;\n"
		"uniform int viewport;\n"
		"void main() {\n"
		"  for (int i = 0; i < 3; i++) {\n"
		"    gl_ViewportIndex = viewport;\n"
		"    gl_Position = gl_in[i].gl_Position;\n"
		"    EmitVertex();\n"
		"  }\n"
		"}\n",
		"#version 150 compatibility\n"
		"uniform vec4 color;\nout vec4 o;\n"
		"void main() { o = color; }\n");
	for (int i = 0; i < NUM; i++) {
		const int v = i % 3;
		float color[4];

		q = (struct peel_quad) {
			7 * v, 5 * v, 7 * v + 20, 5 * v + 16,
			(1 + i * 3 % NUM) / 16., i
		};
		glViewportIndexedf(v, q.x0, q.y0, 20, 16);
		for (int c = 0; c < 4; c++)
			color[c] = peel_color_code(p.color[0], 0, c, i) / 255.;
		glUniform4fv(glGetUniformLocation(p.program, "color"), 1,
			     color);
		glUniform1i(glGetUniformLocation(p.program, "viewport"), v);
		glBegin(GL_TRIANGLES);
		for (int j = 0; j < 6; j++)
			glVertex3f(corners[j][0], corners[j][1], q.z);
		glEnd();
		peel_draw_model(&p, &q, 1);
	}
	return peel_end(&p, peel_check(&p));
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("scissor", scissor, NULL),
	KB_SUBTEST("discard", discard, NULL),
	KB_SUBTEST("discard-all", discard_all, NULL),
	KB_SUBTEST("alpha-test", alpha_test, NULL),
	KB_SUBTEST("alpha-test-never", alpha_test_never, NULL),
	KB_SUBTEST("stipple", stipple, NULL),
	KB_SUBTEST("polygon-state", polygon_state, NULL),
	KB_SUBTEST("depth-clamp", depth_clamp, NULL),
	KB_SUBTEST("viewport-index", viewport_index, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
