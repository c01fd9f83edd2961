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

#include "peel-common.h"
#include "piglit-framework-gl/piglit_wfl_framework.h"

#include <pthread.h>

#define W 16
#define LAYERS 3
#define FIRST GL_DEPTH_PEELING_FIRST_LAYER_MESA

static struct piglit_wfl_framework *
framework(void)
{
	return piglit_wfl_framework(gl_fw);
}

static void
make_current_on(struct waffle_window *window, struct waffle_context *context)
{
	if (!waffle_make_current(framework()->display, window, context)) {
		printf("a context cannot be made current: %s\n",
		       waffle_error_get_info()->message);
		piglit_report_result(PIGLIT_FAIL);
	}
}

static void
make_current(struct waffle_context *context)
{
	make_current_on(framework()->window, context);
}

static struct waffle_context *
new_context(bool share)
{
	struct piglit_wfl_framework *wfl = framework();
	struct waffle_context *context = waffle_context_create(
		wfl->config, share ? wfl->context : NULL);

	if (!context) {
		printf("no second context\n");
		piglit_report_result(PIGLIT_FAIL);
	}
	return context;
}

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
	struct waffle_context *second = new_context(true);
	struct peel p = peel_simple(LAYERS);
	GLuint fbo;
	bool pass;

	draw_scene(&p);
	glFinish();
	make_current(second);
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

	make_current(framework()->context);
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
	struct waffle_context *second = new_context(true);
	struct peel p = peel_simple(LAYERS);
	const struct peel_quad q = peel_full(&p, .125f, 1);
	bool pass;

	draw_scene(&p);
	peel_next(&p);
	draw_scene(&p);
	glFinish();
	make_current(second);
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
	make_current(framework()->context);
	pass = peel_check(&p) && pass;
	peel_next(&p);
	draw_scene(&p);
	pass = peel_check(&p) && pass;
	glFinish();

	/* Started over there, it is that context's from then on. */
	make_current(second);
	if (strcmp(order, "delete") == 0) {
		glBindFramebuffer(GL_FRAMEBUFFER, 0);
		glDeleteFramebuffers(1, &p.fbo);
		make_current(framework()->context);
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
		make_current(framework()->context);
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

struct worker {
	struct waffle_context *context;
	struct waffle_window *window;   /**< current in one thread only */
	int layers;
	bool pass;
};

static void
layers(const struct worker *w, GLenum format, GLenum base, GLenum attachment)
{
	GLuint tex;

	glGenTextures(1, &tex);
	glBindTexture(GL_TEXTURE_2D_ARRAY, tex);
	glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, format, W, W, w->layers, 0, base,
		     GL_FLOAT, NULL);
	glFramebufferTexture(GL_FRAMEBUFFER, attachment, tex, 0);
}

/**
 * Peels 60 fragments, three of each depth, by as many passes as it takes, in
 * a context of its own.
 */
static void *
work(void *data)
{
	struct worker *w = data;
	float *depths = malloc(w->layers * W * W * sizeof(float));
	GLint overflow = 1;
	int rank = 0;

	make_current_on(w->window, w->context);
	GLuint fbo;

	glGenFramebuffers(1, &fbo);
	glBindFramebuffer(GL_FRAMEBUFFER, fbo);
	layers(w, GL_RGBA8, GL_RGBA, GL_COLOR_ATTACHMENT0);
	layers(w, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT,
	       GL_DEPTH_ATTACHMENT);
	glViewport(0, 0, W, W);
	glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
	glEnable(GL_DEPTH_PEELING_MESA);
	w->pass = true;
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
		for (int i = 0; i < w->layers * W * W; i++) {
			const int at = rank + i / (W * W);
			const float want = at < 60 ? (1 + at / 3) / 32.f : 1;

			if (depths[i] != want) {
				printf("rank %d of %d layers: %g, expected "
				       "%g\n", at, w->layers, depths[i], want);
				w->pass = false;
				break;
			}
		}
		glGetFramebufferParameteriv(GL_FRAMEBUFFER,
					    GL_DEPTH_PEELING_OVERFLOW_MESA,
					    &overflow);
		rank += w->layers;
	}
	if (rank < 60 || rank > 60 + 2 * w->layers) {
		printf("%d layers end at rank %d\n", w->layers, rank);
		w->pass = false;
	}
	w->pass = piglit_check_gl_error(GL_NO_ERROR) && w->pass;
	waffle_make_current(framework()->display, NULL, NULL);
	free(depths);
	return NULL;
}

static enum piglit_result
threads(void *data)
{
	struct worker workers[4];
	pthread_t handles[4];
	bool pass = true;

	for (int i = 0; i < 4; i++) {
		workers[i].context = new_context(false);
		workers[i].window = waffle_window_create(framework()->config,
							 W, W);
		workers[i].layers = 2 * i + 1;
	}
	/* The first alone: piglit's function pointers are resolved then. */
	waffle_make_current(framework()->display, NULL, NULL);
	work(&workers[0]);
	for (int i = 1; i < 4; i++)
		pthread_create(&handles[i], NULL, work, &workers[i]);
	for (int i = 1; i < 4; i++)
		pthread_join(handles[i], NULL);
	make_current(framework()->context);
	for (int i = 0; i < 4; i++) {
		pass = workers[i].pass && pass;
		waffle_context_destroy(workers[i].context);
		waffle_window_destroy(workers[i].window);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
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
