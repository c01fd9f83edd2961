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

#include "kbuffer-capability.h"
#include "peel-common.h"

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

/** Another name of the same value. */
static enum piglit_result
short_name(void *data)
{
	bool pass;

	glEnable(GL_DEPTH_PEELING);
	pass = glIsEnabled(GL_DEPTH_PEELING_MESA);
	glDisable(GL_DEPTH_PEELING);
	return pass && !glIsEnabled(GL_DEPTH_PEELING_MESA) ? PIGLIT_PASS :
		PIGLIT_FAIL;
}

static enum piglit_result
limit(void *data)
{
	bool pass = kb_check_limit(GL_MAX_DEPTH_PEELING_LAYERS_MESA, 64);
	struct peel p;
	GLint max;

	glGetIntegerv(GL_MAX_DEPTH_PEELING_LAYERS_MESA, &max);

	/* So many layers can be made, and are peeled into. */
	p = peel_create(&(struct peel_shape) {
		max, 4, 4, 0, GL_DEPTH_COMPONENT32F, { GL_R32UI } });
	for (int n = 0; n < max + 2; n++) {
		const struct peel_quad q =
			peel_full(&p, 1 - (n + 1) / 1024.f, n);

		peel_draw(&p, &q, 1);
		if (n == max - 1)
			pass = peel_check(&p) && pass;
	}
	pass = peel_check(&p) && pass;
	return peel_end(&p, pass);
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_CAPABILITY_SUBTESTS(GL_DEPTH_PEELING_MESA, "depth-buffer-bit",
			       GL_DEPTH_BUFFER_BIT),
	KB_SUBTEST("short-name", short_name, NULL),
	KB_SUBTEST("pop-takes-effect", pop_takes_effect, NULL),
	KB_SUBTEST("changes-take-effect", changes_take_effect, draw_arrays),
	KB_SUBTEST("changes-between-vertices", changes_take_effect,
		   draw_immediately),
	KB_SUBTEST("limit", limit, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
