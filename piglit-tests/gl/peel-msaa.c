/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-msaa.c
 * With multisampling every sample has layers of its own, at its own depth.
 */

#include "peel-common.h"

#define W 37
#define H 22

static struct peel
make(int layers, GLenum depth, GLenum color, GLenum second)
{
	return peel_create(&(struct peel_shape) {
		layers, W, H, 4, depth, { color, second } });
}

/** Slanted triangles: edges and depths differ from sample to sample. */
static enum piglit_result
triangles(void *data)
{
	enum { NUM = 10 };
	struct peel_vertex vertices[3 * NUM];
	bool pass = true;

	peel_seed(5);
	peel_random_triangles(vertices, NUM, 1);
	for (int k = 1; k <= 8 && pass; k += 1 + k / 3) {
		struct peel p = make(k, *(const GLenum *)data, GL_RGBA8,
				     GL_R32UI);

		peel_draw_captured(&p, GL_TRIANGLES, vertices, 3 * NUM);
		pass = peel_check(&p);
		if (!pass)
			printf("%d layers\n", k);
		peel_end(&p, pass);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Quads whose edges lie between the samples of a pixel. */
static void
random_quads(struct peel_quad *quads, int n, int depths)
{
	for (int i = 0; i < n; i++)
		quads[i] = (struct peel_quad) {
			peel_random(160) / 16. + 1 / 32.,
			peel_random(100) / 16. + 1 / 32.,
			W - peel_random(160) / 16. - 1 / 32.,
			H - peel_random(100) / 16. - 1 / 32.,
			(1 + peel_random(depths)) / 16., i
		};
}

static enum piglit_result
quads(void *data)
{
	enum { NUM = 30 };
	static const GLenum formats[] = {
		GL_RGBA8, GL_RGBA16F, GL_RGBA32F, GL_RGBA32UI, GL_RG16I,
	};
	struct peel_quad list[NUM];
	bool pass = true;

	glDepthFunc(*(const GLenum *)data);
	glClearDepth(*(const GLenum *)data == GL_GEQUAL ? 0 : 1);
	for (int i = 0; i < ARRAY_SIZE(formats) && pass; i++) {
		struct peel p = make(2 + 3 * i, GL_DEPTH_COMPONENT32F,
				     formats[i], 0);

		peel_seed(i);
		random_quads(list, NUM, 9);
		peel_draw(&p, list, NUM);
		pass = peel_check(&p);
		if (!pass)
			printf("%d layers of %s\n", p.layers,
			       piglit_get_gl_enum_name(formats[i]));
		peel_end(&p, pass);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Every fragment of every sample once, with many at one depth. */
static enum piglit_result
continuation(void *data)
{
	enum { NUM = 24 };
	struct peel p = make(3, GL_DEPTH_COMPONENT32F, GL_R32UI, 0);
	struct peel_quad list[NUM];
	int passes = 0;
	bool pass;

	peel_seed(2);
	random_quads(list, NUM, 4);
	do {
		if (passes++ > 0)
			peel_next(&p);
		peel_draw(&p, list, NUM);
		pass = peel_check(&p);
	} while (pass && peel_get(GL_DEPTH_PEELING_OVERFLOW_MESA) &&
		 passes <= NUM);
	if (pass && passes != NUM / 3) {
		/* The pixels in the middle have all of them. */
		printf("%d passes for %d fragments\n", passes, NUM);
		pass = false;
	}
	return peel_end(&p, pass);
}

/** All samples are at the pixel's center. */
static enum piglit_result
multisample_off(void *data)
{
	enum { NUM = 15 };
	struct peel p = make(5, GL_DEPTH_COMPONENT32F, GL_RGBA8, 0);
	struct peel_quad list[NUM];
	bool pass;

	glDisable(GL_MULTISAMPLE);
	peel_seed(3);
	random_quads(list, NUM, 9);
	peel_draw(&p, list, NUM);
	pass = peel_check(&p);
	/* And again with it, into the same layers. */
	glEnable(GL_MULTISAMPLE);
	random_quads(list, NUM, 9);
	peel_draw(&p, list, NUM);
	return peel_end(&p, peel_check(&p) && pass);
}

/** A shader that runs for each sample gives each its own color. */
static enum piglit_result
sample_shading(void *data)
{
	enum { NUM = 6 };
	struct peel p = make(4, GL_DEPTH_COMPONENT32F, GL_RGBA32F, 0);
	struct peel_vertex vertices[3 * NUM];

	if (!piglit_is_extension_supported("GL_ARB_sample_shading")) {
		printf("no sample shading here\n");
		return PIGLIT_SKIP;
	}
	p.program = kb_use_glsl("#version 150 compatibility\n"
		    "void main() { gl_Position = gl_Vertex; }\n", NULL,
		    "#version 150 compatibility\n"
		    "#extension GL_ARB_sample_shading: require\n"
		    "out vec4 o;\nvoid main() {\n"
		    "  o = vec4(gl_SampleID + 1, gl_SamplePosition, 1);\n}\n");
	peel_seed(4);
	peel_random_triangles(vertices, NUM, 0);
	peel_draw_captured(&p, GL_TRIANGLES, vertices, 3 * NUM);
	return peel_end(&p, peel_check(&p));
}

/** A depth that the shader writes is that of all samples. */
static enum piglit_result
shader_depth(void *data)
{
	enum { NUM = 8 };
	struct peel p = make(3, GL_DEPTH_COMPONENT32F, GL_R32UI, 0);
	struct peel_vertex vertices[3 * NUM];

	peel_use_program(&p, "", "gl_FragDepth = float(id * 5u % 8u + 1u) / 16.0;");
	peel_seed(6);
	peel_random_triangles(vertices, NUM, 0);
	peel_draw_captured(&p, GL_TRIANGLES, vertices, 3 * NUM);
	return peel_end(&p, peel_check(&p));
}

static enum piglit_result
occlusion(void *data)
{
	enum { NUM = 30 };
	struct peel p = make(3, GL_DEPTH_COMPONENT32F, GL_R8, 0);
	struct peel_quad list[NUM];
	GLuint query, n = 0;
	bool pass;

	peel_seed(1);
	random_quads(list, NUM, 9);
	glGenQueries(1, &query);
	glBeginQuery(GL_SAMPLES_PASSED, query);
	peel_draw(&p, list, NUM);
	glEndQuery(GL_SAMPLES_PASSED);
	glGetQueryObjectuiv(query, GL_QUERY_RESULT, &n);
	glDeleteQueries(1, &query);
	pass = n == p.inserted;
	if (!pass)
		printf("%u samples counted, %d inserted\n", n, p.inserted);
	return peel_end(&p, peel_check(&p) && pass);
}

static const GLenum d16 = GL_DEPTH_COMPONENT16, d24 = GL_DEPTH_COMPONENT24,
	d24s8 = GL_DEPTH24_STENCIL8, d32f = GL_DEPTH_COMPONENT32F;
static const GLenum less = GL_LESS, lequal = GL_LEQUAL, gequal = GL_GEQUAL;

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("triangles-16", triangles, &d16),
	KB_SUBTEST("triangles-24", triangles, &d24),
	KB_SUBTEST("triangles-24-8", triangles, &d24s8),
	KB_SUBTEST("triangles-32f", triangles, &d32f),
	KB_SUBTEST("less", quads, &less),
	KB_SUBTEST("lequal", quads, &lequal),
	KB_SUBTEST("gequal", quads, &gequal),
	KB_SUBTEST("continuation", continuation, NULL),
	KB_SUBTEST("multisample-off", multisample_off, NULL),
	KB_SUBTEST("sample-shading", sample_shading, NULL),
	KB_SUBTEST("shader-depth", shader_depth, NULL),
	KB_SUBTEST("occlusion", occlusion, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
