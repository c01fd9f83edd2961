/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-lifetimes.c
 * A draw is done with what was bound when it was issued, though the driver
 * may run it later: programs, parameters and textures that are changed or
 * deleted afterwards do not count, and too many of them for one batch of the
 * rasterizer are no problem.
 */

#include "kbuffer-common.h"

#define W 16
#define K GL_KBUFFER_PROGRAM_MESA

static const char add_texture[] =
	"TEMP t;\nMUL t, fragment.position, 0.0625;\n"
	"TEX t, t, texture[0], 2D;\nADD result.kbuffer[0], kbuffer[0], t;";

static void
fill_texture(int size, float value)
{
	float *texels = malloc(size * size * 16);

	for (int i = 0; i < size * size * 4; i++)
		texels[i] = value;
	glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size, size, GL_RGBA, GL_FLOAT,
			texels);
	free(texels);
}

static GLuint
make_texture(int size, float value)
{
	GLuint tex;

	glGenTextures(1, &tex);
	glBindTexture(GL_TEXTURE_2D, tex);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
	glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, size, size, 0, GL_RGBA,
		     GL_FLOAT, NULL);
	fill_texture(size, value);
	return tex;
}

static enum piglit_result
check(const struct kb *kb, float value)
{
	return kb_expect(kb, 0, 0, value, value, value, value) ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
texture_deleted(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);

	kb_program(add_texture);
	glEnable(K);
	for (int i = 1; i <= 10; i++) {
		GLuint tex = make_texture(8, i);

		kb_draw(&kb);
		glDeleteTextures(1, &tex);
	}
	return check(&kb, 55);
}

static enum piglit_result
texture_updated(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	GLuint tex = make_texture(8, 0);
	enum piglit_result result;

	kb_program(add_texture);
	glEnable(K);
	for (int i = 1; i <= 10; i++) {
		fill_texture(8, i);
		kb_draw(&kb);
	}
	result = check(&kb, 55);
	glDeleteTextures(1, &tex);
	return result;
}

/** Rendered to, by the program itself, and sampled by it, in turn. */
static enum piglit_result
texture_rendered_to(void *data)
{
	struct kb kb[2] = {
		kb_create(GL_RGBA32F, 1, 0, W, W),
		kb_create(GL_RGBA32F, 1, 0, W, W),
	};

	kb_fill(&kb[0], 0, 1, 1, 1, 1);
	kb_program(add_texture);
	glEnable(K);
	/* Fibonacci: 1, 0 -> 1, 1 -> 2, 1 -> 2, 3 -> 5, 3 ... */
	for (int i = 0; i < 10; i++) {
		glBindFramebuffer(GL_FRAMEBUFFER, kb[(i + 1) % 2].fbo);
		glBindTexture(GL_TEXTURE_2D, kb[i % 2].tex[0]);
		kb_draw(&kb[0]);
	}
	glBindTexture(GL_TEXTURE_2D, 0);
	return kb_expect(&kb[0], 0, 0, 89, 89, 89, 89) &&
		kb_expect(&kb[1], 0, 0, 55, 55, 55, 55) ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

/** 200 textures of 1 MB in one frame: more than a batch holds. */
static enum piglit_result
many_textures(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	GLuint tex[200];
	enum piglit_result result;

	for (int i = 0; i < 200; i++)
		tex[i] = make_texture(256, i);
	kb_program(add_texture);
	glEnable(K);
	for (int i = 0; i < 200; i++) {
		glBindTexture(GL_TEXTURE_2D, tex[i]);
		kb_draw(&kb);
	}
	result = check(&kb, 199 * 100);
	glDeleteTextures(200, tex);
	return result;
}

static enum piglit_result
program_deleted(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	char string[128];

	glEnable(K);
	for (int i = 1; i <= 20; i++) {
		GLuint name;

		snprintf(string, sizeof(string),
			 "!!ARBfp1.0\nOPTION MESA_kbuffer_program;\n"
			 "ADD result.kbuffer[0], kbuffer[0], %d;\nEND\n", i);
		glGenProgramsARB(1, &name);
		glBindProgramARB(K, name);
		if (kb_load(K, string, strlen(string)))
			return PIGLIT_FAIL;
		kb_draw(&kb);
		glDeleteProgramsARB(1, &name);
	}
	return check(&kb, 210);
}

/** One object, a new string for every draw. */
static enum piglit_result
program_replaced(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	char string[160];

	kb_program("");
	glEnable(K);
	for (int i = 1; i <= 20; i++) {
		/* Even ones are longer and read another input. */
		snprintf(string, sizeof(string),
			 "!!ARBfp1.0\nOPTION MESA_kbuffer_program;\nTEMP t;\n"
			 "ADD t, kbuffer[0], %d;\n%s"
			 "MOV result.kbuffer[0], t;\nEND\n", i, i % 2 ? "" :
			 "MAD t, fragment.color, 0, t;\n");
		if (kb_load(K, string, strlen(string)))
			return PIGLIT_FAIL;
		kb_draw(&kb);
	}
	return check(&kb, 210);
}

/** More constants in one frame than a batch holds. */
static enum piglit_result
many_parameters(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	GLint n;
	char body[256];

	glGetProgramivARB(K, GL_MAX_PROGRAM_ENV_PARAMETERS_ARB, &n);
	snprintf(body, sizeof(body),
		 "PARAM e[%d] = { program.env[0..%d] };\n"
		 "ADD result.kbuffer[0], kbuffer[0], e[%d];", n, n - 1, n - 1);
	kb_program(body);
	glEnable(K);
	for (int i = 0; i < 5000; i++) {
		glProgramEnvParameter4fARB(K, n - 1, i % 7, i % 7, i % 7,
					   i % 7);
		kb_draw(&kb);
	}
	glProgramEnvParameter4fARB(K, n - 1, 0, 0, 0, 0);
	/* 714 times 0 to 6, then 0 and 1. */
	return check(&kb, 714 * 21 + 1);
}

/** The framebuffer is deleted before the driver has drawn into it. */
static enum piglit_result
framebuffer_deleted(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 2, 3, W, W);
	bool pass;

	kb_program("MOV result.kbuffer[0], 1;\nMOV result.kbuffer[5], 5;");
	glEnable(K);
	kb_draw(&kb);
	glBindFramebuffer(GL_FRAMEBUFFER, piglit_winsys_fbo);
	glDeleteFramebuffers(1, &kb.fbo);
	pass = kb_expect(&kb, 0, 0, 1, 1, 1, 1);
	pass = kb_expect(&kb, 5, 0, 5, 5, 5, 5) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("texture-deleted", texture_deleted, NULL),
	KB_SUBTEST("texture-updated", texture_updated, NULL),
	KB_SUBTEST("texture-rendered-to", texture_rendered_to, NULL),
	KB_SUBTEST("many-textures", many_textures, NULL),
	KB_SUBTEST("program-deleted", program_deleted, NULL),
	KB_SUBTEST("program-replaced", program_replaced, NULL),
	KB_SUBTEST("many-parameters", many_parameters, NULL),
	KB_SUBTEST("framebuffer-deleted", framebuffer_deleted, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(30)
