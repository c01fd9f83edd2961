/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-enable.c
 * GL_DEPTH_PEELING_MESA is a capability: initially disabled, enabled and
 * disabled, queried, saved by PushAttrib(ENABLE_BIT) and compiled into display
 * lists like any other; and the limit is one that framebuffers can use.
 */

#include "peel-common.h"

static bool
check_enabled(bool wanted)
{
	GLboolean b = !wanted;
	GLint i = -1;
	GLfloat f = -1;
	GLdouble d = -1;
	GLboolean is = glIsEnabled(GL_DEPTH_PEELING_MESA);

	glGetBooleanv(GL_DEPTH_PEELING_MESA, &b);
	glGetIntegerv(GL_DEPTH_PEELING_MESA, &i);
	glGetFloatv(GL_DEPTH_PEELING_MESA, &f);
	glGetDoublev(GL_DEPTH_PEELING_MESA, &d);
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

	glEnable(GL_DEPTH_PEELING_MESA);
	pass = check_enabled(true);
	glEnable(GL_DEPTH_PEELING);
	pass = check_enabled(true) && pass;
	glDisable(GL_DEPTH_PEELING);
	pass = check_enabled(false) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** No other capability changes with it, nor it with another. */
static enum piglit_result
apart_from_others(void *data)
{
	static const GLenum others[] = {
		GL_DEPTH_TEST, GL_STENCIL_TEST, GL_BLEND, GL_KBUFFER_PROGRAM_MESA
	};
	bool pass = true;

	for (int i = 0; i < ARRAY_SIZE(others); i++) {
		glEnable(others[i]);
		pass = check_enabled(false) && pass;
		glDisable(others[i]);
		glEnable(GL_DEPTH_PEELING_MESA);
		pass = !glIsEnabled(others[i]) && pass;
		glDisable(GL_DEPTH_PEELING_MESA);
	}
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
			glEnable(GL_DEPTH_PEELING_MESA);
		else
			glDisable(GL_DEPTH_PEELING_MESA);
		glPushAttrib(mask);
		if (initially)
			glDisable(GL_DEPTH_PEELING_MESA);
		else
			glEnable(GL_DEPTH_PEELING_MESA);
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
	glEnable(GL_DEPTH_PEELING_MESA);
	glEndList();
	glNewList(list + 1, GL_COMPILE);
	glDisable(GL_DEPTH_PEELING_MESA);
	glEndList();

	pass = check_enabled(false);
	glCallList(list);
	pass = check_enabled(true) && pass;
	glCallList(list + 1);
	pass = check_enabled(false) && pass;

	glNewList(list, GL_COMPILE_AND_EXECUTE);
	glEnable(GL_DEPTH_PEELING_MESA);
	glEndList();
	pass = check_enabled(true) && pass;
	glDeleteLists(list, 2);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/**
 * The next draw does what the capability says at that time: popped state of
 * peeling, and of the depth buffer, on which it depends.
 */
static enum piglit_result
pop_takes_effect(void *data)
{
	struct peel p = peel_simple(2);
	const struct peel_quad near = peel_full(&p, .25f, 1);
	const struct peel_quad far = peel_full(&p, .75f, 2);
	bool pass;

	glDisable(GL_DEPTH_PEELING_MESA);
	glPushAttrib(GL_ENABLE_BIT);
	glEnable(GL_DEPTH_PEELING_MESA);
	peel_draw(&p, &far, 1);
	pass = peel_check(&p);
	glPopAttrib();

	/* Without it or a depth test this only writes the color of layer 0. */
	peel_draw_gl(&p, &near, 1);
	pass = !peel_check_layers(&p) && pass;

	glEnable(GL_DEPTH_PEELING_MESA);
	peel_clear(&p);
	glPushAttrib(GL_DEPTH_BUFFER_BIT);
	glDepthFunc(GL_GREATER);
	glDepthMask(GL_FALSE);
	glClearDepth(0);
	glPopAttrib();
	peel_draw(&p, &far, 1);
	peel_draw(&p, &near, 1);
	pass = peel_check(&p) && pass;
	return peel_end(&p, pass);
}

static void
draw_arrays(struct peel *p, const struct peel_quad *q)
{
	peel_draw(p, q, 1);
}

/** Vertices that Mesa collects until something needs them to be drawn. */
static void
draw_immediately(struct peel *p, const struct peel_quad *q)
{
	static const float corners[4][2] = {
		{ -1, -1 }, { 1, -1 }, { 1, 1 }, { -1, 1 }
	};

	glBegin(GL_QUADS);
	for (int i = 0; i < 4; i++) {
		glVertexAttribI1ui(1, q->id);
		glVertexAttrib4f(0, corners[i][0], corners[i][1], q->z, 1);
	}
	glEnd();
	peel_draw_model(p, q, 1);
}

/**
 * Each change of a state that draws with peeling look at reaches the next
 * draw, alone and with nothing else changed.
 */
static enum piglit_result
changes_take_effect(void *data)
{
	void (*const draw)(struct peel *, const struct peel_quad *) = data;
	struct peel p = peel_simple(3);
	const struct peel_quad quads[] = {
		peel_full(&p, .5f, 1), peel_full(&p, .25f, 2),
		peel_full(&p, .75f, 3), peel_full(&p, .125f, 4),
		peel_full(&p, .125f, 5), peel_full(&p, .0625f, 6),
		peel_full(&p, .03125f, 7),
	};
	bool pass;

	draw(&p, &quads[0]);
	glDepthMask(GL_FALSE);
	draw(&p, &quads[1]);
	pass = peel_check(&p);
	glDepthMask(GL_TRUE);
	draw(&p, &quads[1]);
	pass = peel_check(&p) && pass;

	/* Of the clear value, too: the second is no longer nearer. */
	draw(&p, &quads[2]);
	glClearDepth(.125f);
	draw(&p, &quads[3]);
	pass = peel_check(&p) && pass;
	glClearDepth(1);
	draw(&p, &quads[3]);
	pass = peel_check(&p) && pass;

	glDepthFunc(GL_LEQUAL);
	draw(&p, &quads[4]);
	pass = peel_check(&p) && pass;
	glDepthFunc(GL_LESS);
	draw(&p, &quads[4]);
	pass = peel_check(&p) && pass;

	glDisable(GL_DEPTH_PEELING_MESA);
	glEnable(GL_DEPTH_PEELING_MESA);
	draw(&p, &quads[5]);
	glColorMask(0, 0, 0, 0);
	draw(&p, &quads[6]);
	pass = peel_check(&p) && pass;

	/* The parameters are those after all that was drawn before. */
	glColorMask(1, 1, 1, 1);
	peel_restart(&p);
	for (int i = 3; i >= 0; i--)
		draw(&p, &quads[i]);
	pass = peel_check_overflow(&p) && pass;
	glFramebufferParameteri(GL_FRAMEBUFFER,
				GL_DEPTH_PEELING_FIRST_LAYER_MESA, 0);
	p.model.overflow = false;
	pass = peel_check(&p) && pass;
	for (int i = 0; i < 3; i++)
		draw(&p, &quads[0]);
	peel_next(&p);
	for (int i = 0; i < 3; i++)
		draw(&p, &quads[0]);
	draw(&p, &quads[2]);
	pass = peel_check(&p) && pass;
	return peel_end(&p, pass);
}

static enum piglit_result
between_begin_and_end(void *data)
{
	bool pass;

	glBegin(GL_TRIANGLES);
	glEnable(GL_DEPTH_PEELING_MESA);
	glEnd();
	pass = piglit_check_gl_error(GL_INVALID_OPERATION);
	return check_enabled(false) && pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
limit(void *data)
{
	GLboolean b = 0;
	GLint i = -1;
	GLfloat f = -1;
	GLdouble d = -1;
	struct peel p;
	bool pass;

	glGetBooleanv(GL_MAX_DEPTH_PEELING_LAYERS_MESA, &b);
	glGetIntegerv(GL_MAX_DEPTH_PEELING_LAYERS_MESA, &i);
	glGetFloatv(GL_MAX_DEPTH_PEELING_LAYERS_MESA, &f);
	glGetDoublev(GL_MAX_DEPTH_PEELING_LAYERS_MESA, &d);
	pass = b && i >= 64 && f == i && d == i;
	if (!pass)
		printf("GetBoolean %d, GetInteger %d, GetFloat %g, "
		       "GetDouble %g\n", b, i, f, d);

	/* So many layers can be made, and are peeled into. */
	p = peel_create(&(struct peel_shape) {
		i, 4, 4, 0, GL_DEPTH_COMPONENT32F, { GL_R32UI } });
	for (int n = 0; n < i + 2; n++) {
		const struct peel_quad q =
			peel_full(&p, 1 - (n + 1) / 1024.f, n);

		peel_draw(&p, &q, 1);
		if (n == i - 1)
			pass = peel_check(&p) && pass;
	}
	pass = peel_check(&p) && pass;
	return peel_end(&p, pass);
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("initial", initial, NULL),
	KB_SUBTEST("toggle", toggle, NULL),
	KB_SUBTEST("apart-from-others", apart_from_others, NULL),
	KB_SUBTEST("push-enable-bit", push_pop, GL_ENABLE_BIT),
	KB_SUBTEST("push-all-bits", push_pop, GL_ALL_ATTRIB_BITS),
	KB_SUBTEST("push-depth-buffer-bit", push_pop, GL_DEPTH_BUFFER_BIT),
	KB_SUBTEST("display-list", display_list, NULL),
	KB_SUBTEST("pop-takes-effect", pop_takes_effect, NULL),
	KB_SUBTEST("changes-take-effect", changes_take_effect, draw_arrays),
	KB_SUBTEST("changes-between-vertices", changes_take_effect,
		   draw_immediately),
	KB_SUBTEST("between-begin-and-end", between_begin_and_end, NULL),
	KB_SUBTEST("limit", limit, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
