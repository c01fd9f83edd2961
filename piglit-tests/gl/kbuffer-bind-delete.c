/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-bind-delete.c
 * Program objects of the k-buffer target: one name space with vertex and
 * fragment programs, a binding and a default program of their own, mismatched
 * targets refused, deletion of what is bound.
 */

#include "kbuffer-common.h"

#define PROGRAM "!!ARBfp1.0\nOPTION MESA_kbuffer_program;\n" \
		"MOV result.kbuffer[0], 5;\nEND\n"

static bool
check_binding(GLenum target, GLuint wanted)
{
	GLint bound = -1;

	glGetProgramivARB(target, GL_PROGRAM_BINDING_ARB, &bound);
	if (bound == wanted)
		return true;
	printf("%#x: bound is %d, expected %u\n", target, bound, wanted);
	return false;
}

static enum piglit_result
initial(void *data)
{
	GLint length = -1;

	glGetProgramivARB(GL_KBUFFER_PROGRAM_MESA, GL_PROGRAM_LENGTH_ARB,
			  &length);
	return check_binding(GL_KBUFFER_PROGRAM_MESA, 0) && length == 0 ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
bind_creates(void *data)
{
	GLuint name;
	bool pass;

	glGenProgramsARB(1, &name);
	pass = !glIsProgramARB(name);
	glBindProgramARB(GL_KBUFFER_PROGRAM_MESA, name);
	pass = glIsProgramARB(name) && pass;
	pass = check_binding(GL_KBUFFER_PROGRAM_MESA, name) && pass;
	pass = check_binding(GL_FRAGMENT_PROGRAM_ARB, 0) && pass;
	glBindProgramARB(GL_KBUFFER_PROGRAM_MESA, 0);
	pass = check_binding(GL_KBUFFER_PROGRAM_MESA, 0) && pass;
	glDeleteProgramsARB(1, &name);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

struct pair { GLenum own, other; };

/** A name that was made for one target cannot be bound to another. */
static enum piglit_result
mismatch(void *data)
{
	const struct pair *pair = data;
	GLuint names[2];
	bool pass = true;

	glGenProgramsARB(2, names);
	glBindProgramARB(pair->own, names[0]);
	glBindProgramARB(pair->other, names[1]);
	pass = piglit_check_gl_error(GL_NO_ERROR) && pass;

	glBindProgramARB(pair->other, names[0]);
	pass = piglit_check_gl_error(GL_INVALID_OPERATION) && pass;
	pass = check_binding(pair->own, names[0]) && pass;
	pass = check_binding(pair->other, names[1]) && pass;
	glDeleteProgramsARB(2, names);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
delete_bound(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, 8, 8);
	GLuint name;
	bool pass;

	glGenProgramsARB(1, &name);
	glBindProgramARB(GL_KBUFFER_PROGRAM_MESA, name);
	pass = kb_load(GL_KBUFFER_PROGRAM_MESA, PROGRAM, strlen(PROGRAM)) ==
		GL_NO_ERROR;
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 5, 5, 5, 5) && pass;

	/* Nothing is bound then, so that drawing is an error. */
	glDeleteProgramsARB(1, &name);
	pass = check_binding(GL_KBUFFER_PROGRAM_MESA, 0) && pass;
	pass = !glIsProgramARB(name) && pass;
	kb_fill(&kb, 0, 1, 2, 3, 4);
	kb_draw(&kb);
	pass = piglit_check_gl_error(GL_INVALID_OPERATION) && pass;
	pass = kb_expect(&kb, 0, 0, 1, 2, 3, 4) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
delete_other(void *data)
{
	GLuint names[3];
	bool pass;

	glGenProgramsARB(3, names);
	glBindProgramARB(GL_FRAGMENT_PROGRAM_ARB, names[2]);
	glBindProgramARB(GL_KBUFFER_PROGRAM_MESA, names[1]);
	glBindProgramARB(GL_KBUFFER_PROGRAM_MESA, names[0]);
	glDeleteProgramsARB(2, names + 1);
	pass = check_binding(GL_KBUFFER_PROGRAM_MESA, names[0]);
	pass = check_binding(GL_FRAGMENT_PROGRAM_ARB, 0) && pass;
	glDeleteProgramsARB(1, names);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** A deleted name is free for any target. */
static enum piglit_result
name_is_free(void *data)
{
	GLuint name;
	bool pass;

	glGenProgramsARB(1, &name);
	glBindProgramARB(GL_KBUFFER_PROGRAM_MESA, name);
	glDeleteProgramsARB(1, &name);
	glBindProgramARB(GL_FRAGMENT_PROGRAM_ARB, name);
	pass = check_binding(GL_FRAGMENT_PROGRAM_ARB, name);
	glDeleteProgramsARB(1, &name);
	glBindProgramARB(GL_KBUFFER_PROGRAM_MESA, name);
	pass = check_binding(GL_KBUFFER_PROGRAM_MESA, name) && pass;
	glDeleteProgramsARB(1, &name);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Program object zero of the target can be used, and is no one else's. */
static enum piglit_result
default_program(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, 8, 8);
	GLint fragment = -1, kbuffer = -1;
	bool pass;

	pass = kb_load(GL_KBUFFER_PROGRAM_MESA, PROGRAM, strlen(PROGRAM)) ==
		GL_NO_ERROR;
	glGetProgramivARB(GL_FRAGMENT_PROGRAM_ARB, GL_PROGRAM_LENGTH_ARB,
			  &fragment);
	glGetProgramivARB(GL_KBUFFER_PROGRAM_MESA, GL_PROGRAM_LENGTH_ARB,
			  &kbuffer);
	pass = fragment == 0 && kbuffer == strlen(PROGRAM) && pass;
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	return kb_expect(&kb, 0, 0, 5, 5, 5, 5) && pass ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

/** Each bind takes effect with the next draw. */
static enum piglit_result
switch_programs(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, 8, 8);
	GLuint one = kb_program("ADD result.kbuffer[0].x, kbuffer[0], 1;");
	GLuint two = kb_program("ADD result.kbuffer[0].y, kbuffer[0], 2;");

	glEnable(GL_KBUFFER_PROGRAM_MESA);
	for (int i = 0; i < 20; i++) {
		glBindProgramARB(GL_KBUFFER_PROGRAM_MESA, i % 3 ? one : two);
		kb_draw(&kb);
	}
	return kb_expect(&kb, 0, 0, 13, 14, 0, 0) ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** The string is kept as it was given, and a new one replaces it. */
static enum piglit_result
program_string(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, 8, 8);
	char got[sizeof(PROGRAM)] = "";
	GLint length = -1, format = -1;
	bool pass;

	kb_program("MOV result.kbuffer[0], 4;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 4, 4, 4, 4);

	pass = kb_load(GL_KBUFFER_PROGRAM_MESA, PROGRAM, strlen(PROGRAM)) ==
		GL_NO_ERROR && pass;
	glGetProgramivARB(GL_KBUFFER_PROGRAM_MESA, GL_PROGRAM_LENGTH_ARB,
			  &length);
	glGetProgramivARB(GL_KBUFFER_PROGRAM_MESA, GL_PROGRAM_FORMAT_ARB,
			  &format);
	glGetProgramStringARB(GL_KBUFFER_PROGRAM_MESA, GL_PROGRAM_STRING_ARB,
			      got);
	pass = length == strlen(PROGRAM) && strcmp(got, PROGRAM) == 0 &&
		format == GL_PROGRAM_FORMAT_ASCII_ARB && pass;
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 5, 5, 5, 5) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static struct pair kbuffer_fragment = {
	GL_KBUFFER_PROGRAM_MESA, GL_FRAGMENT_PROGRAM_ARB
};
static struct pair fragment_kbuffer = {
	GL_FRAGMENT_PROGRAM_ARB, GL_KBUFFER_PROGRAM_MESA
};
static struct pair kbuffer_vertex = {
	GL_KBUFFER_PROGRAM_MESA, GL_VERTEX_PROGRAM_ARB
};
static struct pair vertex_kbuffer = {
	GL_VERTEX_PROGRAM_ARB, GL_KBUFFER_PROGRAM_MESA
};

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("initial", initial, NULL),
	KB_SUBTEST("bind-creates", bind_creates, NULL),
	KB_SUBTEST("kbuffer-name-to-fragment", mismatch, &kbuffer_fragment),
	KB_SUBTEST("fragment-name-to-kbuffer", mismatch, &fragment_kbuffer),
	KB_SUBTEST("kbuffer-name-to-vertex", mismatch, &kbuffer_vertex),
	KB_SUBTEST("vertex-name-to-kbuffer", mismatch, &vertex_kbuffer),
	KB_SUBTEST("delete-bound", delete_bound, NULL),
	KB_SUBTEST("delete-other", delete_other, NULL),
	KB_SUBTEST("name-is-free", name_is_free, NULL),
	KB_SUBTEST("program-string", program_string, NULL),
	KB_SUBTEST("switch-programs", switch_programs, NULL),
	/* Last: object zero cannot be emptied again. */
	KB_SUBTEST("default-program", default_program, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(30)
