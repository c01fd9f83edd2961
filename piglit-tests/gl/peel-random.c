/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-random.c
 * Random framebuffers, and random sequences of state and draws, against the
 * model.  A failure names the seed.
 */

#include "peel-common.h"

static const GLenum depths[] = {
	GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT16,
	GL_DEPTH24_STENCIL8, GL_DEPTH32F_STENCIL8,
};

static const GLenum colors[] = {
	GL_RGBA8, GL_R32UI, GL_RGBA16F, GL_RGBA32F, GL_R8, GL_RG16I, GL_RGB565,
	GL_RGB10_A2, GL_RGBA32I, GL_RG8, GL_R16F, GL_RGBA8UI, GL_R11F_G11F_B10F,
};

static struct peel
random_framebuffer(int samples)
{
	struct peel_shape shape = {
		.layers = 1 + peel_random(peel_random(4) ? 9 : 40),
		.width = 1 + peel_random(90), .height = 1 + peel_random(50),
		.samples = samples,
		.depth = depths[peel_random(ARRAY_SIZE(depths))],
	};
	const int n = peel_random(4) ? 1 : peel_random(9);
	struct peel p;
	int order[PEEL_MAX_COLORS];

	for (int a = 0; a < n; a++)
		shape.colors[a] = colors[peel_random(ARRAY_SIZE(colors))];
	p = peel_create(&shape);
	if (n > 1 && peel_random(3) == 0) {
		for (int o = 0; o < n; o++)
			order[o] = peel_random(4) ? o : -1;
		peel_draw_buffers(&p, n, order);
		peel_use_program(&p, "", "");
	}
	return p;
}

/** One mask for each scene, which comes and goes: a driver compiles each. */
static void
random_masks(uint32_t components)
{
	const bool masked = peel_random(4) == 0;

	for (int i = 0; i < PEEL_MAX_COLORS; i++) {
		const int m = masked ? components >> 4 * i : 0xf;

		glColorMaski(i, m & 1, m >> 1 & 1, m >> 2 & 1, m >> 3 & 1);
	}
	glDepthMask(peel_random(8) > 0);
}

static void
random_scissor(const struct peel *p)
{
	/*
	 * Stock llvmpipe lets single samples of the pixels beside the scissor
	 * box pass.
	 */
	if (peel_random(3) || p->samples) {
		glDisable(GL_SCISSOR_TEST);
		return;
	}
	glEnable(GL_SCISSOR_TEST);
	glScissor(peel_random(p->width), peel_random(p->height),
		  peel_random(p->width), peel_random(p->height));
}

static void
random_draw(struct peel *p, int depths, uint32_t *id)
{
	struct peel_quad quads[30];
	const int n = 1 + peel_random(peel_random(3) ? 4 : 30);

	for (int i = 0; i < n; i++) {
		const int x = peel_random(p->width), y = peel_random(p->height);
		/* With many samples, edges between them, too. */
		const float part = p->samples ? peel_random(8) / 8. + 1 / 32. :
			0;

		quads[i] = (struct peel_quad) {
			x - part, y - part, x + 1 + peel_random(p->width) +
			part, y + 1 + peel_random(p->height) + part,
			(1 + peel_random(depths)) / (depths + 1.), (*id)++
		};
	}
	peel_draw(p, quads, n);
}

/** Changes of the state, of the function, and clears between draws. */
static bool
random_sequence(struct peel *p, const GLenum funcs[2], uint32_t components,
		int depths)
{
	uint32_t id = 1;

	for (int i = 0; i < 25; i++) {
		random_masks(components);
		random_scissor(p);
		glDepthFunc(funcs[peel_random(2)]);
		switch (peel_random(16)) {
		case 0:
			if (peel_random(3) == 0)
				peel_clear(p);
			break;
		case 1:
			if (peel_random(4) == 0 && !peel_check(p))
				return false;
			break;
		default:
			random_draw(p, depths, &id);
		}
	}
	return peel_check(p);
}

/** The same draws in passes, until nothing is behind the last layer. */
static bool
random_passes(struct peel *p, int seed, uint32_t components, int depths)
{
	for (int pass = 0; pass < 8; pass++) {
		uint32_t id = 1;

		if (pass > 0)
			peel_next(p);
		peel_seed(seed);
		for (int i = 0; i < 12; i++) {
			random_masks(components);
			random_scissor(p);
			random_draw(p, depths, &id);
		}
		if (!peel_check(p)) {
			printf("in pass %d\n", pass);
			return false;
		}
		if (!p->model.overflow)
			break;
	}
	return true;
}

static bool
scene(int seed, int samples)
{
	static const GLenum less[] = { GL_LESS, GL_LEQUAL };
	static const GLenum greater[] = { GL_GREATER, GL_GEQUAL };
	struct peel p;
	const GLenum *funcs;
	uint32_t components;
	int depths;
	bool pass;

	peel_seed(seed);
	funcs = peel_random(3) ? less : greater;
	depths = peel_random(2) ? 6 : 300;
	glDepthFunc(funcs[0]);
	glClearDepth(funcs == greater ? 0 : peel_random(2) ? 1 : .75);
	p = random_framebuffer(samples);
	components = peel_random(0x10000) | peel_random(0x10000) << 16;
	pass = peel_random(2) ? random_sequence(&p, funcs, components, depths) :
		random_passes(&p, seed, components, depths);
	glDisable(GL_SCISSOR_TEST);
	glDepthMask(GL_TRUE);
	glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
	if (!pass) {
		printf("seed %d, %d samples: %d layers, %d x %d, %s", seed,
		       samples, p.layers, p.width, p.height,
		       piglit_get_gl_enum_name(p.depth->internal));
		for (int a = 0; a < p.colors; a++)
			printf(", %s", piglit_get_gl_enum_name(
				       p.color[a]->internal));
		printf("\n");
	}
	glBindFramebuffer(GL_FRAMEBUFFER, piglit_winsys_fbo);
	glDeleteFramebuffers(1, &p.fbo);
	glDeleteTextures(1, &p.depth_tex);
	glDeleteTextures(p.colors, p.color_tex);
	return peel_end(&p, pass) == PIGLIT_PASS;
}

struct range { int first, last, samples; };

static enum piglit_result
scenes(void *data)
{
	const struct range *range = data;
	GLint max = 0;

	glGetIntegerv(GL_MAX_SAMPLES, &max);
	if (max < range->samples) {
		printf("there are no %d samples here\n", range->samples);
		return PIGLIT_SKIP;
	}
	for (int seed = range->first; seed <= range->last; seed++) {
		if (!scene(seed, range->samples))
			return PIGLIT_FAIL;
	}
	return PIGLIT_PASS;
}

#define RANGE(first, last, samples) \
	&(const struct range) { first, last, samples }

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("1-25", scenes, RANGE(1, 25, 0)),
	KB_SUBTEST("26-45", scenes, RANGE(26, 45, 0)),
	KB_SUBTEST("4-samples", scenes, RANGE(1, 16, 4)),
	KB_SUBTEST_END
};

PEEL_TEST(32)
