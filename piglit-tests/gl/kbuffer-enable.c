/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-enable.c
 * GL_KBUFFER_PROGRAM_MESA is a capability: initially disabled, enabled and
 * disabled, queried, saved by PushAttrib(ENABLE_BIT) and compiled into display
 * lists like any other.
 */

#include "kbuffer-common.h"

static bool
check_enabled(bool wanted)
{
	GLboolean b = !wanted;
	GLint i = -1;
	GLfloat f = -1;
	GLdouble d = -1;
	GLboolean is = glIsEnabled(GL_KBUFFER_PROGRAM_MESA);

	glGetBooleanv(GL_KBUFFER_PROGRAM_MESA, &b);
	glGetIntegerv(GL_KBUFFER_PROGRAM_MESA, &i);
	glGetFloatv(GL_KBUFFER_PROGRAM_MESA, &f);
	glGetDoublev(GL_KBUFFER_PROGRAM_MESA, &d);
	if (is == wanted && b == wanted && i == wanted && f == wanted &&
	    d == wanted)
		return piglit_check_gl_error(GL_NO_ERROR);
	printf("expected %d, IsEnabled %d, GetBoolean %d, GetInteger %d, "
	       "GetFloat %g, GetDouble %g\n", wanted, is, b, i, f, d);
	return false;
}

static enum piglit_result
initial(void *data)
{
	return check_enabled(false) ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
toggle(void *data)
{
	bool pass;

	glEnable(GL_KBUFFER_PROGRAM_MESA);
	pass = check_enabled(true);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	pass = check_enabled(true) && pass;
	glDisable(GL_KBUFFER_PROGRAM_MESA);
	pass = check_enabled(false) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
apart_from_fragment_program(void *data)
{
	bool pass;

	glEnable(GL_FRAGMENT_PROGRAM_ARB);
	pass = check_enabled(false);
	glDisable(GL_FRAGMENT_PROGRAM_ARB);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	pass = !glIsEnabled(GL_FRAGMENT_PROGRAM_ARB) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** The group is that of ENABLE_BIT and no other. */
static enum piglit_result
push_pop(void *data)
{
	const GLbitfield mask = (GLbitfield)(intptr_t)data;
	const bool saved = mask & GL_ENABLE_BIT;
	bool pass = true;

	for (int initially = 0; initially < 2; initially++) {
		if (initially)
			glEnable(GL_KBUFFER_PROGRAM_MESA);
		else
			glDisable(GL_KBUFFER_PROGRAM_MESA);
		glPushAttrib(mask);
		if (initially)
			glDisable(GL_KBUFFER_PROGRAM_MESA);
		else
			glEnable(GL_KBUFFER_PROGRAM_MESA);
		glPopAttrib();
		pass = check_enabled(saved ? initially : !initially) && pass;
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
display_list(void *data)
{
	GLuint list = glGenLists(2);
	bool pass;

	glNewList(list, GL_COMPILE);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	glEndList();
	glNewList(list + 1, GL_COMPILE);
	glDisable(GL_KBUFFER_PROGRAM_MESA);
	glEndList();

	pass = check_enabled(false);
	glCallList(list);
	pass = check_enabled(true) && pass;
	glCallList(list + 1);
	pass = check_enabled(false) && pass;

	glNewList(list, GL_COMPILE_AND_EXECUTE);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	glEndList();
	pass = check_enabled(true) && pass;
	glDeleteLists(list, 2);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** What a popped enable says is what the next draw does. */
static enum piglit_result
pop_takes_effect(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, 8, 8);
	bool pass;

	kb_program("MOV result.kbuffer[0], 3;");
	kb_fragment_value(1, 1, 1, 1);
	glPushAttrib(GL_ENABLE_BIT);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 3, 3, 3, 3);
	glPopAttrib();
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 1, 1, 1, 1) && pass;

	glEnable(GL_KBUFFER_PROGRAM_MESA);
	glPushAttrib(GL_ALL_ATTRIB_BITS);
	glDisable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	glPopAttrib();
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 3, 3, 3, 3) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
between_begin_and_end(void *data)
{
	bool pass;

	glBegin(GL_TRIANGLES);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	glEnd();
	pass = piglit_check_gl_error(GL_INVALID_OPERATION);
	return check_enabled(false) && pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("initial", initial, NULL),
	KB_SUBTEST("toggle", toggle, NULL),
	KB_SUBTEST("apart-from-fragment-program", apart_from_fragment_program,
		   NULL),
	KB_SUBTEST("push-enable-bit", push_pop, GL_ENABLE_BIT),
	KB_SUBTEST("push-all-bits", push_pop, GL_ALL_ATTRIB_BITS),
	KB_SUBTEST("push-color-buffer-bit", push_pop, GL_COLOR_BUFFER_BIT),
	KB_SUBTEST("display-list", display_list, NULL),
	KB_SUBTEST("pop-takes-effect", pop_takes_effect, NULL),
	KB_SUBTEST("between-begin-and-end", between_begin_and_end, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(30)
