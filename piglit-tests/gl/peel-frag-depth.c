/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-frag-depth.c
 * The depth that a shader writes is the fragment's, clamped; NaN is never
 * kept.  The depth range may be reversed, or flat.
 */

#include "peel-common.h"

#define K 6
#define NUM 14

static struct peel
make(GLenum format)
{
	return peel_create(&(struct peel_shape) {
		K, 18, 10, 0, format, { GL_R32UI, GL_RGBA8 } });
}

/** Draw quads whose depth the shader replaces by depths[id]. */
static void
draw_with_depths(struct peel *p, const float *depths, int n)
{
	uint32_t bits[NUM];
	GLuint program;

	program = peel_use_program(p,
		"#extension GL_ARB_shader_bit_encoding: require\n"
		"uniform uint bits[14];\n",
		"gl_FragDepth = uintBitsToFloat(bits[id]);");
	for (int i = 0; i < n; i++) {
		/* Where it is not a matter of rounding. */
		const float z = p->depth->bits[0] < 32 && depths[i] > 0 &&
			depths[i] < 1 ? peel_depth(p->depth, peel_depth_code(
				p->depth, depths[i])) : depths[i];

		memcpy(&bits[i], &z, 4);
	}
	glUniform1uiv(glGetUniformLocation(program, "bits"), n, bits);
	for (int i = 0; i < n; i++) {
		/* The plane's own depths are in another order. */
		struct peel_quad q = peel_full(p, (i * 5 % n + 1) / 32., i);

		q.x0 = i % 3;
		peel_draw_gl(p, &q, 1);
		q.z = depths[i];
		if (!isnan(q.z))
			peel_draw_model(p, &q, 1);
	}
}

static enum piglit_result
in_range(void *data)
{
	struct peel p = make(*(const GLenum *)data);
	float depths[NUM];

	peel_seed(1);
	for (int i = 0; i < NUM; i++)
		depths[i] = peel_depth(p.depth, peel_max_depth(p.depth) / 16 *
				       (1 + peel_random(14)));
	draw_with_depths(&p, depths, NUM);
	return peel_end(&p, peel_check(&p));
}

/** With early tests the shader's depth is not the fragment's. */
static enum piglit_result
early_tests(void *data)
{
	struct peel p = make(*(const GLenum *)data);

	if (!piglit_is_extension_supported("GL_ARB_shader_image_load_store")) {
		printf("no early fragment tests here\n");
		return peel_end(&p, true) == PIGLIT_PASS ? PIGLIT_SKIP :
			PIGLIT_FAIL;
	}
	peel_use_program(&p, "#extension GL_ARB_shader_image_load_store: "
			 "require\nlayout(early_fragment_tests) in;\n",
			 "gl_FragDepth = float(id) / 32.;");
	for (int i = 0; i < NUM; i++) {
		const struct peel_quad q =
			peel_full(&p, peel_depth(p.depth, peel_depth_code(
				p.depth, (i * 5 % NUM + 1) / 32.)), i);

		peel_draw(&p, &q, 1);
	}
	return peel_end(&p, peel_check(&p));
}

/** NaN among others: as third of eight, and first, and last. */
static enum piglit_result
nan_depth(void *data)
{
	struct peel p = make(*(const GLenum *)data);
	static const uint32_t nans[2] = { 0x7fc00000, 0xffc00001 };
	float depths[10] = { 0, .125, .75, 0, .5, .25, 0, .375, .875, 0 };
	bool pass = true;

	for (int i = 0; i < 2; i++) {
		for (int j = 0; j < 10; j++)
			if (depths[j] == 0 || isnan(depths[j]))
				memcpy(&depths[j], &nans[i], 4);
		glDepthFunc(GL_LESS);
		glClearDepth(1);
		peel_clear(&p);
		draw_with_depths(&p, depths, 10);
		pass = peel_check(&p) && pass;
		glDepthFunc(GL_GEQUAL);
		glClearDepth(0);
		peel_clear(&p);
		draw_with_depths(&p, depths, 10);
		pass = peel_check(&p) && pass;
	}
	return peel_end(&p, pass);
}

/** Depths out of range are clamped, and so may be equal. */
static enum piglit_result
clamped(void *data)
{
	struct peel p = make(*(const GLenum *)data);
	const float depths[] = {
		.5, -1, -INFINITY, 1.5, 0, INFINITY, -1e-20, .25, 1.00001, 1,
	};
	bool pass;

	/* 1 and what is beyond is no nearer than the clear depth. */
	draw_with_depths(&p, depths, ARRAY_SIZE(depths));
	pass = peel_check(&p);
	glDepthFunc(GL_GREATER);
	glClearDepth(0);
	peel_clear(&p);
	draw_with_depths(&p, depths, ARRAY_SIZE(depths));
	return peel_end(&p, peel_check(&p) && pass);
}

/** With depth clamping, to the depth range. */
static enum piglit_result
clamped_to_range(void *data)
{
	struct peel p = make(GL_DEPTH_COMPONENT32F);
	static const float written[] = { .5, .125, .75, .9, .3, -2, 3 };
	/* In the range .25 to .75. */
	static const float depths[] = { .5, .25, .75, .75, .3, .25, .75 };
	uint32_t bits[ARRAY_SIZE(written)];
	GLuint program = peel_use_program(&p,
		"#extension GL_ARB_shader_bit_encoding: require\n"
		"uniform uint bits[7];\n",
		"gl_FragDepth = uintBitsToFloat(bits[id]);");

	/* Stock softpipe clamps to another range with ZERO_TO_ONE. */
	glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
	glEnable(GL_DEPTH_CLAMP);
	glDepthRange(.25, .75);
	memcpy(bits, written, sizeof(bits));
	glUniform1uiv(glGetUniformLocation(program, "bits"),
		      ARRAY_SIZE(bits), bits);
	for (int i = 0; i < ARRAY_SIZE(depths); i++) {
		struct peel_quad q = peel_full(&p, .5, i);

		peel_draw_gl(&p, &q, 1);
		q.z = depths[i];
		peel_draw_model(&p, &q, 1);
	}
	return peel_end(&p, peel_check(&p));
}

/** Some fragments write another depth, some keep that of the plane. */
static enum piglit_result
written_by_some(void *data)
{
	struct peel p = make(GL_DEPTH_COMPONENT32F);
	struct peel_quad quads[NUM];

	peel_use_program(&p, "", "gl_FragDepth = id % 3u == 0u ? "
			 "1.0 - gl_FragCoord.z : gl_FragCoord.z;");
	for (int i = 0; i < NUM; i++) {
		quads[i] = peel_full(&p, (1 + i * 5 % NUM) / 16., i);
		peel_draw_gl(&p, &quads[i], 1);
		if (i % 3 == 0)
			quads[i].z = 1 - quads[i].z;
		peel_draw_model(&p, &quads[i], 1);
	}
	return peel_end(&p, peel_check_ranks(&p, quads, NUM) &&
			peel_check(&p));
}

/** glDepthRange(1, 0) and GREATER is LESS with the ordinary range. */
static enum piglit_result
reversed(void *data)
{
	struct peel p = make(*(const GLenum *)data);
	struct peel_quad quads[NUM];

	glDepthRange(1, 0);
	glDepthFunc(GL_GREATER);
	glClearDepth(0);
	peel_clear(&p);
	peel_seed(2);
	for (int i = 0; i < NUM; i++) {
		quads[i] = peel_full(&p, (1 + peel_random(15)) / 16., i);
		quads[i].y0 = i % 4;
		peel_draw_gl(&p, &quads[i], 1);
		/* 1/16 are exact in floats; codes are the driver's own. */
		quads[i].z = 1 - quads[i].z;
		peel_draw_model(&p, &quads[i], 1);
	}
	return peel_end(&p, peel_check_ranks(&p, quads, NUM) &&
			peel_check(&p));
}

static const GLenum d16 = GL_DEPTH_COMPONENT16, d24 = GL_DEPTH_COMPONENT24,
	d32f = GL_DEPTH_COMPONENT32F;

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("in-range", in_range, &d32f),
	KB_SUBTEST("in-range-24", in_range, &d24),
	KB_SUBTEST("in-range-16", in_range, &d16),
	KB_SUBTEST("early-tests", early_tests, &d32f),
	KB_SUBTEST("early-tests-16", early_tests, &d16),
	KB_SUBTEST("nan", nan_depth, &d32f),
	KB_SUBTEST("nan-16", nan_depth, &d16),
	KB_SUBTEST("clamped", clamped, &d32f),
	KB_SUBTEST("clamped-24", clamped, &d24),
	KB_SUBTEST("clamped-16", clamped, &d16),
	KB_SUBTEST("clamped-to-range", clamped_to_range, NULL),
	KB_SUBTEST("written-by-some", written_by_some, NULL),
	KB_SUBTEST("reversed", reversed, &d32f),
	KB_SUBTEST_END
};

PEEL_TEST(32)
