/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-coverage.c
 * With multisampling, what changes the coverage of a fragment comes before it
 * is inserted: the sample mask, sample coverage, alpha to coverage, and the
 * mask that the shader writes.
 */

#include "peel-common.h"

#define NUM 10

static struct peel
make(void)
{
	return peel_create(&(struct peel_shape) {
		4, 40, 36, 4, GL_DEPTH_COMPONENT32F, { GL_RGBA8 } });
}

static enum piglit_result
draw_and_check(struct peel *p)
{
	struct peel_vertex vertices[3 * NUM];

	peel_seed(8);
	peel_random_triangles(vertices, NUM, 1);
	peel_draw_captured(p, GL_TRIANGLES, vertices, 3 * NUM);
	/* A refused sample may be taken for one that falls behind. */
	if (peel_get(GL_DEPTH_PEELING_OVERFLOW_MESA))
		p->model.overflow = true;
	return peel_end(p, peel_check(p));
}

static bool
in_sample_mask(int x, int y, int sample, uint32_t id)
{
	return 0x6 >> sample & 1;
}

static enum piglit_result
sample_mask(void *data)
{
	struct peel p = make();

	glEnable(GL_SAMPLE_MASK);
	glSampleMaski(0, 0x6);
	p.stays = in_sample_mask;
	for (int i = 0; i < NUM; i++) {
		const struct peel_quad q = {
			i, 2, 40 - i, 35 - 2 * i, (1 + i * 7 % NUM) / 16., i
		};

		peel_draw(&p, &q, 1);
	}
	return peel_end(&p, peel_check(&p));
}

static enum piglit_result
sample_coverage(void *data)
{
	struct peel p = make();

	glEnable(GL_SAMPLE_COVERAGE);
	glSampleCoverage(.5, data != NULL);
	return draw_and_check(&p);
}

static enum piglit_result
alpha_to_coverage(void *data)
{
	struct peel p = make();

	glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
	return draw_and_check(&p);
}

/** This one changes the color. */
static enum piglit_result
alpha_to_one(void *data)
{
	struct peel p = make();

	glEnable(GL_SAMPLE_ALPHA_TO_ONE);
	return draw_and_check(&p);
}

/** The sample mask that a shader writes. */
static enum piglit_result
shader_sample_mask(void *data)
{
	struct peel p;

	if (!piglit_is_extension_supported("GL_ARB_sample_shading")) {
		printf("no gl_SampleMask here\n");
		return PIGLIT_SKIP;
	}
	p = make();
	peel_use_program(&p, "#extension GL_ARB_sample_shading: require\n",
			 "gl_SampleMask[0] = int(id);");
	return draw_and_check(&p);
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("sample-mask", sample_mask, NULL),
	KB_SUBTEST("sample-coverage", sample_coverage, NULL),
	KB_SUBTEST("sample-coverage-inverted", sample_coverage, ""),
	KB_SUBTEST("alpha-to-coverage", alpha_to_coverage, NULL),
	KB_SUBTEST("alpha-to-one", alpha_to_one, NULL),
	KB_SUBTEST("shader-sample-mask", shader_sample_mask, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
