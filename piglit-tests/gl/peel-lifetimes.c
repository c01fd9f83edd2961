/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-lifetimes.c
 * What depth peeling keeps belongs to a framebuffer object and lives as long
 * as that, whatever happens to its textures; draws that the driver has not
 * run yet are done with what was there when they were issued.
 */

#include "peel-common.h"

#define LAYERS 3

/** Fragments of two depths only, more than fit. */
static void
draw_scene(struct peel *p)
{
	glUseProgram(p->program);
	for (int i = 0; i < 3 * LAYERS; i++) {
		const struct peel_quad q =
			peel_full(p, i % 2 ? .25f : .5f, i + 1);

		peel_draw(p, &q, 1);
	}
}

static enum piglit_result
framebuffer_deleted(void *data)
{
	const bool draw_later = data;
	struct peel p = peel_simple(LAYERS);
	bool pass;

	draw_scene(&p);
	peel_next(&p);
	draw_scene(&p);
	/* The textures stay, and what was drawn to them. */
	if (draw_later) {
		glBindFramebuffer(GL_FRAMEBUFFER, piglit_winsys_fbo);
		glFlush();
	}
	glDeleteFramebuffers(1, &p.fbo);
	pass = peel_check_layers(&p);

	/* The next framebuffer knows nothing of it. */
	struct peel q = peel_simple(LAYERS);

	draw_scene(&q);
	pass = peel_check(&q) && pass;
	peel_end(&p, pass);
	return peel_end(&q, pass);
}

/** Bounds are not in the textures that they were taken from. */
static enum piglit_result
textures_deleted(void *data)
{
	struct peel p = peel_simple(LAYERS), q = peel_simple(LAYERS);
	bool pass;

	glBindFramebuffer(GL_FRAMEBUFFER, p.fbo);
	draw_scene(&p);
	peel_next(&p);
	glDeleteTextures(1, &p.depth_tex);
	glDeleteTextures(1, &p.color_tex[0]);
	glUseProgram(q.program);
	peel_draw_gl(&q, &(struct peel_quad) { 0, 0, 16, 16, .1f, 1 }, 1);
	pass = piglit_check_gl_error(GL_INVALID_FRAMEBUFFER_OPERATION);

	p.depth_tex = q.depth_tex;
	p.color_tex[0] = q.color_tex[0];
	glFramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, p.depth_tex,
			     0);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
			     p.color_tex[0], 0);
	peel_clear(&p);
	draw_scene(&p);
	pass = peel_check(&p) && pass;
	p.color_tex[0] = q.color_tex[0];
	peel_end(&q, pass);
	return peel_end(&p, pass);
}

/** The passes of several framebuffers alternate, draw by draw. */
static enum piglit_result
interleaved(void *data)
{
	struct peel p[3];
	bool pass = true;

	for (int i = 0; i < ARRAY_SIZE(p); i++)
		p[i] = peel_simple(LAYERS + i);
	for (int round = 0; round < 4; round++) {
		for (int n = 0; n < 12; n++) {
			for (int i = 0; i < ARRAY_SIZE(p); i++) {
				const struct peel_quad q = peel_full(&p[i],
					1 - (n / 5 + i + 1) / 32.f, n);

				glBindFramebuffer(GL_FRAMEBUFFER, p[i].fbo);
				glUseProgram(p[i].program);
				peel_draw(&p[i], &q, 1);
			}
		}
		for (int i = 0; i < ARRAY_SIZE(p); i++) {
			glBindFramebuffer(GL_FRAMEBUFFER, p[i].fbo);
			pass = peel_check(&p[i]) && pass;
			/* They are at different ranks from now on. */
			if ((round + i) % 3)
				peel_next(&p[i]);
			else
				peel_restart(&p[i]);
		}
	}
	for (int i = 0; i < ARRAY_SIZE(p); i++)
		peel_end(&p[i], pass);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Framebuffers come and go, each with a bound. */
static enum piglit_result
many(void *data)
{
	struct peel p = peel_simple(LAYERS);
	GLuint fbos[100];
	bool pass = true;

	for (int round = 0; round < 3; round++) {
		glGenFramebuffers(ARRAY_SIZE(fbos), fbos);
		for (int i = 0; i < ARRAY_SIZE(fbos); i++) {
			glBindFramebuffer(GL_FRAMEBUFFER, fbos[i]);
			glFramebufferTexture(GL_FRAMEBUFFER,
					     GL_DEPTH_ATTACHMENT, p.depth_tex,
					     0);
			glFramebufferTexture(GL_FRAMEBUFFER,
					     GL_COLOR_ATTACHMENT0,
					     p.color_tex[0], 0);
			glReadBuffer(GL_NONE);
			p.model.overflow = false;
			peel_restart(&p);
			draw_scene(&p);
			peel_next(&p);
			draw_scene(&p);
			if (i % 20 == 0)
				pass = peel_check(&p) && pass;
		}
		/* Some while they are bound, some while others are. */
		for (int i = 0; i < ARRAY_SIZE(fbos); i++) {
			glBindFramebuffer(GL_FRAMEBUFFER, i % 3 ? fbos[i] :
					  p.fbo);
			glDeleteFramebuffers(1, &fbos[i]);
		}
	}
	glBindFramebuffer(GL_FRAMEBUFFER, p.fbo);
	peel_restart(&p);
	draw_scene(&p);
	pass = peel_check(&p) && pass;
	return peel_end(&p, pass);
}

/** More draws than a batch of the rasterizer holds, and bounds between. */
static enum piglit_result
many_passes(void *data)
{
	struct peel p = peel_simple(1);
	bool pass = true;

	for (int pass_number = 0; pass_number < 200; pass_number++) {
		for (int i = 0; i < 20; i++) {
			const struct peel_quad q =
				peel_full(&p, .5f - i / 4 / 16.f, i);

			peel_draw(&p, &q, 1);
		}
		if (pass_number % 10 == 0)
			pass = peel_check(&p) && pass;
		if (pass_number % 22 == 21)
			peel_restart(&p);
		else
			peel_next(&p);
	}
	return peel_end(&p, pass);
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("framebuffer-deleted", framebuffer_deleted, false),
	KB_SUBTEST("framebuffer-deleted-later", framebuffer_deleted, true),
	KB_SUBTEST("textures-deleted", textures_deleted, NULL),
	KB_SUBTEST("interleaved", interleaved, NULL),
	KB_SUBTEST("many", many, NULL),
	KB_SUBTEST("many-passes", many_passes, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
