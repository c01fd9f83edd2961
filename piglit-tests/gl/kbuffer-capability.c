/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-capability.c
 * What is the same for every capability of Enable.
 */

#include "kbuffer-capability.h"

/** All queries agree. */
static bool
check_enabled(GLenum cap, bool wanted)
{
	GLboolean b = !wanted;
	GLint i = -1;
	GLfloat f = -1;
	GLdouble d = -1;
	GLboolean is = glIsEnabled(cap);

	glGetBooleanv(cap, &b);
	glGetIntegerv(cap, &i);
	glGetFloatv(cap, &f);
	glGetDoublev(cap, &d);
	if (is == wanted && b == wanted && i == wanted && f == wanted &&
	    d == wanted)
		return piglit_check_gl_error(GL_NO_ERROR);
	printf("expected %d, IsEnabled %d, GetBoolean %d, GetInteger %d, "
	       "GetFloat %g, GetDouble %g\n", wanted, is, b, i, f, d);
	return false;
}

static void
set(GLenum cap, bool enabled)
{
	if (enabled)
		glEnable(cap);
	else
		glDisable(cap);
}

enum piglit_result
kb_cap_initial(void *data)
{
	const struct kb_capability *c = data;

	return check_enabled(c->cap, false) ? PIGLIT_PASS : PIGLIT_FAIL;
}

enum piglit_result
kb_cap_toggle(void *data)
{
	static const bool values[] = { true, true, false, false, true };
	const struct kb_capability *c = data;
	bool pass = true;

	for (int i = 0; i < ARRAY_SIZE(values); i++) {
		set(c->cap, values[i]);
		pass = check_enabled(c->cap, values[i]) && pass;
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** No other capability changes with it, nor it with another. */
enum piglit_result
kb_cap_apart(void *data)
{
	static const GLenum others[] = {
		GL_DEPTH_TEST, GL_STENCIL_TEST, GL_BLEND, GL_ALPHA_TEST,
		GL_FRAGMENT_PROGRAM_ARB, GL_VERTEX_PROGRAM_ARB,
		GL_KBUFFER_PROGRAM_MESA, GL_DEPTH_PEELING_MESA
	};
	const struct kb_capability *c = data;
	bool pass = true;

	for (int i = 0; i < ARRAY_SIZE(others); i++) {
		if (others[i] == c->cap)
			continue;
		glEnable(others[i]);
		pass = check_enabled(c->cap, false) && pass;
		glDisable(others[i]);
		glEnable(c->cap);
		pass = !glIsEnabled(others[i]) && pass;
		glDisable(c->cap);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** The group is that of ENABLE_BIT and no other. */
enum piglit_result
kb_cap_push_pop(void *data)
{
	const struct kb_capability *c = data;
	const bool saved = c->group & GL_ENABLE_BIT;
	bool pass = true;

	for (int initially = 0; initially < 2; initially++) {
		set(c->cap, initially);
		glPushAttrib(c->group);
		set(c->cap, !initially);
		glPopAttrib();
		pass = check_enabled(c->cap, saved ? initially : !initially) &&
			pass;
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

enum piglit_result
kb_cap_display_list(void *data)
{
	const struct kb_capability *c = data;
	GLuint list = glGenLists(2);
	bool pass;

	for (int enabled = 0; enabled < 2; enabled++) {
		glNewList(list + enabled, GL_COMPILE);
		set(c->cap, enabled);
		glEndList();
	}
	pass = check_enabled(c->cap, false);
	glCallList(list + 1);
	pass = check_enabled(c->cap, true) && pass;
	glCallList(list);
	pass = check_enabled(c->cap, false) && pass;

	glNewList(list, GL_COMPILE_AND_EXECUTE);
	set(c->cap, true);
	glEndList();
	pass = check_enabled(c->cap, true) && pass;
	glDeleteLists(list, 2);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

enum piglit_result
kb_cap_begin_end(void *data)
{
	const struct kb_capability *c = data;
	bool pass;

	glBegin(GL_TRIANGLES);
	glEnable(c->cap);
	glEnd();
	pass = piglit_check_gl_error(GL_INVALID_OPERATION);
	return check_enabled(c->cap, false) && pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

bool
kb_check_limit(GLenum pname, int at_least)
{
	GLboolean b = 0;
	GLint i = -1;
	GLfloat f = -1;
	GLdouble d = -1;

	glGetBooleanv(pname, &b);
	glGetIntegerv(pname, &i);
	glGetFloatv(pname, &f);
	glGetDoublev(pname, &d);
	if (b && i >= at_least && f == i && d == i)
		return piglit_check_gl_error(GL_NO_ERROR);
	printf("GetBoolean %d, GetInteger %d, GetFloat %g, GetDouble %g, "
	       "expected at least %d\n", b, i, f, d, at_least);
	return false;
}
