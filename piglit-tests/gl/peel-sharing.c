/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-sharing.c
 * Contexts that share textures peel into them one after the other; contexts
 * in threads peel at the same time.  Framebuffer objects are not shared, but
 * Mesa gives all contexts of a share group the same names: what one context
 * peeled is never continued by another, and survives it.
 */

#include "kbuffer-contexts.h"
#include "peel-common.h"

#define W 16
#define LAYERS 3
#define FIRST GL_DEPTH_PEELING_FIRST_LAYER_MESA

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

/** The state of peel_create() in a context that shares its objects. */
static void
prepare(const struct peel *p)
{
	glViewport(0, 0, W, W);
	glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
	glBindFramebuffer(GL_FRAMEBUFFER, p->fbo);
}

/** Another framebuffer of another context goes on in the same textures. */
static enum piglit_result
textures(void *data)
{
	struct waffle_context *second = kb_new_context(true);
	struct peel p = peel_simple(LAYERS);
	GLuint fbo;
	bool pass;

	draw_scene(&p);
	glFinish();
	kb_make_current(second);
	glGenFramebuffers(1, &fbo);
	glBindFramebuffer(GL_FRAMEBUFFER, fbo);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, p.depth_tex,
			     0);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
			     p.color_tex[0], 0);
	glReadBuffer(GL_NONE);
	glViewport(0, 0, W, W);
	glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
	pass = !glIsEnabled(GL_DEPTH_PEELING_MESA);
	glEnable(GL_DEPTH_PEELING_MESA);
	pass = peel_get(FIRST) == 0 && pass;
	p.model.overflow = false;
	draw_scene(&p);
	pass = peel_check(&p) && pass;
	glDeleteFramebuffers(1, &fbo);
	glFinish();

	kb_make_current(NULL);
	waffle_context_destroy(second);
	glFramebufferParameteri(GL_FRAMEBUFFER, FIRST, 0);
	p.model.overflow = false;
	pass = peel_check(&p) && pass;
	return peel_end(&p, pass);
}

static enum piglit_result
same_framebuffer(void *data)
{
	const char *order = data;
	struct waffle_context *second = kb_new_context(true);
	struct peel p = peel_simple(LAYERS);
	const struct peel_quad q = peel_full(&p, .125f, 1);
	bool pass;

	draw_scene(&p);
	peel_next(&p);
	draw_scene(&p);
	glFinish();
	kb_make_current(second);
	prepare(&p);
	glEnable(GL_DEPTH_PEELING_MESA);
	glUseProgram(p.program);

	/* The other's: nothing is drawn, nothing is lost. */
	peel_draw_gl(&p, &q, 1);
	pass = piglit_check_gl_error(GL_INVALID_OPERATION);
	glFramebufferParameteri(GL_FRAMEBUFFER, FIRST, 2 * LAYERS);
	pass = piglit_check_gl_error(GL_INVALID_OPERATION) && pass;
	pass = peel_get(FIRST) == LAYERS && peel_check_layers(&p) && pass;
	glFinish();
	kb_make_current(NULL);
	pass = peel_check(&p) && pass;
	peel_next(&p);
	draw_scene(&p);
	pass = peel_check(&p) && pass;
	glFinish();

	/* Started over there, it is that context's from then on. */
	kb_make_current(second);
	if (strcmp(order, "delete") == 0) {
		glBindFramebuffer(GL_FRAMEBUFFER, 0);
		glDeleteFramebuffers(1, &p.fbo);
		kb_make_current(NULL);
		glUseProgram(p.program);
		glBindFramebuffer(GL_FRAMEBUFFER, piglit_winsys_fbo);
		waffle_context_destroy(second);
	} else {
		peel_restart(&p);
		draw_scene(&p);
		peel_next(&p);
		draw_scene(&p);
		pass = peel_check(&p) && pass;
		glFinish();
		kb_make_current(NULL);
		if (strcmp(order, "destroy") == 0) {
			/* Its part goes with it. */
			waffle_context_destroy(second);
			pass = peel_get(FIRST) == 0 && pass;
			peel_restart(&p);
		} else {
			glUseProgram(p.program);
			peel_draw_gl(&p, &q, 1);
			glGetError();
			peel_restart(&p);
			draw_scene(&p);
			pass = peel_check(&p) && pass;
			waffle_context_destroy(second);
		}
		draw_scene(&p);
		pass = peel_check(&p) && pass;
	}

	/* And the first context peels as before. */
	struct peel other = peel_simple(LAYERS);

	draw_scene(&other);
	peel_next(&other);
	draw_scene(&other);
	pass = peel_check(&other) && pass;
	peel_end(&other, pass);
	return peel_end(&p, pass);
}

static void
make_layers(int layers, GLenum format, GLenum base, GLenum attachment)
{
	GLuint tex;

	glGenTextures(1, &tex);
	glBindTexture(GL_TEXTURE_2D_ARRAY, tex);
	glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, format, W, W, layers, 0, base,
		     GL_FLOAT, NULL);
	glFramebufferTexture(GL_FRAMEBUFFER, attachment, tex, 0);
}

/**
 * Peels 60 fragments, three of each depth, by as many passes as it takes.
 */
static void
work(struct kb_worker *w)
{
	const int layers = 2 * w->number + 1;
	float *depths = malloc(layers * W * W * sizeof(float));
	GLint overflow = 1;
	int rank = 0;
	GLuint fbo;

	glGenFramebuffers(1, &fbo);
	glBindFramebuffer(GL_FRAMEBUFFER, fbo);
	make_layers(layers, GL_RGBA8, GL_RGBA, GL_COLOR_ATTACHMENT0);
	make_layers(layers, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT,
		    GL_DEPTH_ATTACHMENT);
	glViewport(0, 0, W, W);
	glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
	glEnable(GL_DEPTH_PEELING_MESA);
	while (overflow && rank < 120) {
		glFramebufferParameteri(GL_FRAMEBUFFER, FIRST, rank);
		glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
		glBegin(GL_TRIANGLES);
		for (int i = 0; i < 60; i++) {
			const float z = (1 + i * 7 % 20) / 32.f;

			glVertex3f(-1, -1, z);
			glVertex3f(3, -1, z);
			glVertex3f(-1, 3, z);
		}
		glEnd();
		glGetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_DEPTH_COMPONENT,
			      GL_FLOAT, depths);
		for (int i = 0; i < layers * W * W; i++) {
			const int at = rank + i / (W * W);
			const float want = at < 60 ? (1 + at / 3) / 32.f : 1;

			if (depths[i] != want) {
				printf("rank %d of %d layers: %g, expected "
				       "%g\n", at, layers, depths[i], want);
				w->pass = false;
				break;
			}
		}
		glGetFramebufferParameteriv(GL_FRAMEBUFFER,
					    GL_DEPTH_PEELING_OVERFLOW_MESA,
					    &overflow);
		rank += layers;
	}
	if (rank < 60 || rank > 60 + 2 * layers) {
		printf("%d layers end at rank %d\n", layers, rank);
		w->pass = false;
	}
	free(depths);
}

static enum piglit_result
threads(void *data)
{
	return kb_run_in_threads(work);
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("textures", textures, NULL),
	KB_SUBTEST("framebuffer-taken-back", same_framebuffer, "back"),
	KB_SUBTEST("framebuffer-of-destroyed", same_framebuffer, "destroy"),
	KB_SUBTEST("framebuffer-deleted-elsewhere", same_framebuffer,
		   "delete"),
	KB_SUBTEST("threads", threads, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
