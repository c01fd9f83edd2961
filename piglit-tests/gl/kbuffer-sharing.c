/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-sharing.c
 * Contexts that share objects share k-buffer programs, not bindings, enables
 * or environment parameters; contexts that do not share have separate names.
 * Contexts may draw in turn, and in threads at the same time.
 */

#include "kbuffer-contexts.h"

#define W 64
#define K GL_KBUFFER_PROGRAM_MESA

/** A framebuffer of the current context for a shared or own texture. */
static GLuint
framebuffer(GLuint tex)
{
	GLuint fbo;

	glGenFramebuffers(1, &fbo);
	glBindFramebuffer(GL_FRAMEBUFFER, fbo);
	glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
			       GL_TEXTURE_2D, tex, 0);
	glViewport(0, 0, W, W);
	return fbo;
}

static enum piglit_result
programs(void *data)
{
	struct waffle_context *second = kb_new_context(true);
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	GLuint name = kb_program("ADD result.kbuffer[0], program.env[0], "
				 "program.local[0];");
	GLint bound = -1;
	float env[4];
	bool pass = true;

	glProgramEnvParameter4fARB(K, 0, 1, 2, 3, 4);
	glProgramLocalParameter4fARB(K, 0, 10, 20, 30, 40);
	glEnable(K);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 11, 22, 33, 44) && pass;
	glFinish();

	kb_make_current(second);
	/* Nothing of the context's own state came along. */
	pass = !glIsEnabled(K) && glIsProgramARB(name) && pass;
	glGetProgramivARB(K, GL_PROGRAM_BINDING_ARB, &bound);
	glGetProgramEnvParameterfvARB(K, 0, env);
	pass = bound == 0 && env[0] == 0 && pass;
	framebuffer(kb.tex[0]);
	glBindProgramARB(K, name);
	glProgramEnvParameter4fARB(K, 0, 5, 5, 5, 5);
	glEnable(K);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 15, 25, 35, 45) && pass;
	/* A local parameter belongs to the program that both have. */
	glProgramLocalParameter4fARB(K, 0, 100, 0, 0, 0);
	pass = piglit_check_gl_error(GL_NO_ERROR) && pass;
	glFinish();

	kb_make_current(NULL);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 101, 2, 3, 4) && pass;
	glProgramEnvParameter4fARB(K, 0, 0, 0, 0, 0);
	waffle_context_destroy(second);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Deleted in one context, a program stays bound and alive in the other. */
static enum piglit_result
deleted_elsewhere(void *data)
{
	struct waffle_context *second = kb_new_context(true);
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	GLuint name;
	bool pass = true;

	name = kb_program("ADD result.kbuffer[0], kbuffer[0], 1;");
	glEnable(K);
	kb_draw(&kb);
	glFinish();
	kb_make_current(second);
	glDeleteProgramsARB(1, &name);
	glFinish();
	kb_make_current(NULL);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 2, 2, 2, 2) && pass;
	waffle_context_destroy(second);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 3, 3, 3, 3) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** A context is destroyed while its program, made there, is used here. */
static enum piglit_result
made_elsewhere(void *data)
{
	static const char string[] = "!!ARBfp1.0\n"
		"OPTION MESA_kbuffer_program;\n"
		"ADD result.kbuffer[0], kbuffer[0], 2;\nEND\n";
	struct waffle_context *second = kb_new_context(true);
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	GLuint name;
	bool pass = true;

	glFinish();
	kb_make_current(second);
	glGenProgramsARB(1, &name);
	glBindProgramARB(K, name);
	pass = kb_load(K, string, strlen(string)) == GL_NO_ERROR;
	framebuffer(kb.tex[0]);
	glEnable(K);
	kb_draw(&kb);
	glFinish();
	kb_make_current(NULL);
	waffle_context_destroy(second);
	glBindProgramARB(K, name);
	glEnable(K);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 4, 4, 4, 4) && pass;
	glDeleteProgramsARB(1, &name);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
not_shared(void *data)
{
	struct waffle_context *second = kb_new_context(false);
	GLuint name = kb_program("MOV result.kbuffer[0], 1;");
	bool pass;

	kb_make_current(second);
	pass = !glIsProgramARB(name);
	kb_make_current(NULL);
	pass = glIsProgramARB(name) && pass;
	waffle_context_destroy(second);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Counts to 200 in steps of the worker's own. */
static void
work(struct kb_worker *w)
{
	struct kb kb = {
		.target = GL_TEXTURE_2D, .format = GL_RGBA32F,
		.attachments = 1, .width = W, .height = W
	};
	const int step = w->number + 1;
	char string[256];
	GLuint name;

	glGenTextures(1, &kb.tex[0]);
	glBindTexture(GL_TEXTURE_2D, kb.tex[0]);
	glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, W, W, 0, GL_RGBA, GL_FLOAT,
		     NULL);
	framebuffer(kb.tex[0]);
	glClear(GL_COLOR_BUFFER_BIT);
	glGenProgramsARB(1, &name);
	glBindProgramARB(K, name);
	glEnable(K);
	for (int i = 0; i < 200; i++) {
		/* A program string now and then: compiling runs beside. */
		if (i % 20 == 0) {
			snprintf(string, sizeof(string), "!!ARBfp1.0\n"
				 "OPTION MESA_kbuffer_program;\nADD "
				 "result.kbuffer[0], kbuffer[0], %d;\nMOV "
				 "result.kbuffer[0].y, %d;\nEND\n",
				 step, i);
			w->pass = kb_load(K, string, strlen(string)) ==
				GL_NO_ERROR && w->pass;
		}
		kb_draw(&kb);
	}
	w->pass = kb_expect(&kb, 0, 0, 200 * step, 180, 200 * step,
			    200 * step) && w->pass;
}

static enum piglit_result
threads(void *data)
{
	return kb_run_in_threads(work);
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("programs", programs, NULL),
	KB_SUBTEST("deleted-elsewhere", deleted_elsewhere, NULL),
	KB_SUBTEST("made-elsewhere", made_elsewhere, NULL),
	KB_SUBTEST("not-shared", not_shared, NULL),
	KB_SUBTEST("threads", threads, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(30)
