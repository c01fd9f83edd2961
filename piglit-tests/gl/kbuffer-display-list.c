/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-display-list.c
 * Binds, program strings, parameters, enables and draws with k-buffer programs
 * in display lists: compiled as for other targets, in force when called.
 */

#include "kbuffer-common.h"

#define W 16
#define K GL_KBUFFER_PROGRAM_MESA

static enum piglit_result
draws(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	GLuint list = glGenLists(1);
	bool pass;

	kb_program("ADD result.kbuffer[0], kbuffer[0], 1;");
	kb_fragment_value(100, 100, 100, 100);
	glNewList(list, GL_COMPILE);
	kb_draw(&kb);
	glEnable(K);
	kb_draw(&kb);
	kb_draw(&kb);
	glDisable(K);
	glEndList();
	pass = kb_expect(&kb, 0, 0, 0, 0, 0, 0);
	glCallList(list);
	pass = kb_expect(&kb, 0, 0, 102, 102, 102, 102) && pass;
	glEnable(K);
	glCallList(list);
	pass = kb_expect(&kb, 0, 0, 105, 105, 105, 105) && pass;
	glDeleteLists(list, 1);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
binds(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	GLuint one = kb_program("ADD result.kbuffer[0].x, kbuffer[0], 1;");
	GLuint two = kb_program("ADD result.kbuffer[0].y, kbuffer[0], 1;");
	GLuint list = glGenLists(1);
	GLint bound;
	bool pass;

	glNewList(list, GL_COMPILE);
	glBindProgramARB(K, one);
	kb_draw(&kb);
	glEndList();
	glGetProgramivARB(K, GL_PROGRAM_BINDING_ARB, &bound);
	pass = bound == two;
	glEnable(K);
	kb_draw(&kb);
	glCallList(list);
	glGetProgramivARB(K, GL_PROGRAM_BINDING_ARB, &bound);
	pass = bound == one && pass;
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 2, 1, 0, 0) && pass;
	glDeleteLists(list, 1);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** The string is copied when it is compiled; an error comes when called. */
static enum piglit_result
strings(void *data)
{
	char good[] = "!!ARBfp1.0\nOPTION MESA_kbuffer_program;\n"
		"MOV result.kbuffer[0], 5;\nEND\n";
	static const char bad[] = "!!ARBfp1.0\nMOV result.kbuffer[0], 5;\nEND\n";
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	GLuint list = glGenLists(2);
	GLint length;
	bool pass;

	kb_program("MOV result.kbuffer[0], 1;");
	glNewList(list, GL_COMPILE);
	glProgramStringARB(K, GL_PROGRAM_FORMAT_ASCII_ARB, strlen(good), good);
	glEndList();
	glNewList(list + 1, GL_COMPILE);
	glProgramStringARB(K, GL_PROGRAM_FORMAT_ASCII_ARB, strlen(bad), bad);
	glEndList();
	pass = piglit_check_gl_error(GL_NO_ERROR);
	memset(good, '#', sizeof(good));

	glEnable(K);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 1, 1, 1, 1) && pass;
	glCallList(list);
	pass = piglit_check_gl_error(GL_NO_ERROR) && pass;
	glGetProgramivARB(K, GL_PROGRAM_LENGTH_ARB, &length);
	pass = length == sizeof(good) - 1 && pass;
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 5, 5, 5, 5) && pass;
	glCallList(list + 1);
	pass = piglit_check_gl_error(GL_INVALID_OPERATION) && pass;
	glDeleteLists(list, 2);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
parameters(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	GLuint list = glGenLists(1);
	float value[4] = { 10, 20, 30, 40 };
	bool pass;

	kb_program("ADD result.kbuffer[0], program.env[0], "
		   "program.local[0];");
	glEnable(K);
	glNewList(list, GL_COMPILE);
	glProgramEnvParameter4fARB(K, 0, 1, 2, 3, 4);
	glProgramLocalParameter4fvARB(K, 0, value);
	kb_draw(&kb);
	glProgramEnvParameter4dARB(K, 0, 5, 6, 7, 8);
	glEndList();
	value[0] = 0;
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 0, 0, 0, 0);
	glCallList(list);
	pass = kb_expect(&kb, 0, 0, 11, 22, 33, 44) && pass;
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 15, 26, 37, 48) && pass;
	glProgramEnvParameter4fARB(K, 0, 0, 0, 0, 0);
	glDeleteLists(list, 1);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Compiled while the stage is invalid, called when it is valid. */
static enum piglit_result
errors_when_called(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	GLuint list = glGenLists(1);
	bool pass;

	glEnable(K);
	glNewList(list, GL_COMPILE);
	kb_draw(&kb);
	glEndList();
	pass = piglit_check_gl_error(GL_NO_ERROR);
	kb_fill(&kb, 0, 1, 2, 3, 4);
	glCallList(list);
	pass = piglit_check_gl_error(GL_INVALID_OPERATION) && pass;
	pass = kb_expect(&kb, 0, 0, 1, 2, 3, 4) && pass;
	kb_program("MOV result.kbuffer[0], 9;");
	glCallList(list);
	pass = kb_expect(&kb, 0, 0, 9, 9, 9, 9) && pass;
	glDeleteLists(list, 1);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("draws", draws, NULL),
	KB_SUBTEST("binds", binds, NULL),
	KB_SUBTEST("strings", strings, NULL),
	KB_SUBTEST("parameters", parameters, NULL),
	KB_SUBTEST("errors-when-called", errors_when_called, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
