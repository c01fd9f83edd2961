/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-state-bindings.c
 * state.* parameters of a k-buffer program follow the context's state: also
 * when nothing else changes between two draws, and when only the k-buffer
 * program, not the fragment stage, uses them.
 */

#include "kbuffer-common.h"

#define W 8

typedef void (*setter)(float x);

static void
set_material(float x)
{
	glMaterialfv(GL_FRONT_AND_BACK, GL_DIFFUSE,
		     (float[4]) { x, 2 * x, 3 * x, 4 * x });
}

static void
set_light(float x)
{
	glLightfv(GL_LIGHT1, GL_AMBIENT,
		  (float[4]) { x, 2 * x, 3 * x, 4 * x });
}

static void
set_light_model(float x)
{
	glLightModelfv(GL_LIGHT_MODEL_AMBIENT,
		       (float[4]) { x, 2 * x, 3 * x, 4 * x });
}

static void
set_texture_environment(float x)
{
	const float color[4] = { x, 2 * x, 3 * x, 4 * x };

	glActiveTexture(GL_TEXTURE1);
	glTexEnvfv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_COLOR, color);
	glActiveTexture(GL_TEXTURE0);
}

static void
set_fog_color(float x)
{
	glFogfv(GL_FOG_COLOR, (float[4]) { x, 2 * x, 3 * x, 4 * x });
}

static void
set_matrix(float x)
{
	/* Column by column; row 0 is { x, 2 x, 3 x, 4 x }. */
	const float m[16] = { x, 0, 0, 0, 2 * x, 0, 0, 0, 3 * x, 0, 0, 0,
			      4 * x, 0, 0, 1 };

	glActiveTexture(GL_TEXTURE2);
	glMatrixMode(GL_TEXTURE);
	glLoadMatrixf(m);
	glMatrixMode(GL_MODELVIEW);
	glActiveTexture(GL_TEXTURE0);
}

struct binding { const char *name; setter set; };

static enum piglit_result
follows(void *data)
{
	const struct binding *b = data;
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	char body[256];
	bool pass = true;

	snprintf(body, sizeof(body), "MOV result.kbuffer[0], %s;", b->name);
	kb_program(body);
	kb_fragment_value(0, 0, 0, 0);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	for (int i = 1; i <= 4; i++) {
		const float x = i / 16.0f;

		b->set(x);
		kb_draw(&kb);
		if (!kb_expect(&kb, 0, 1e-6, x, 2 * x, 3 * x, 4 * x)) {
			printf("value %d\n", i);
			pass = false;
		}
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static const struct binding
material = { "state.material.diffuse", set_material },
light = { "state.light[1].ambient", set_light },
light_model = { "state.lightmodel.ambient", set_light_model },
texture_environment = { "state.texenv[1].color", set_texture_environment },
fog = { "state.fog.color", set_fog_color },
matrix = { "state.matrix.texture[2].row[0]", set_matrix };

/** Depth range: { near, far, far - near, 1 }. */
static enum piglit_result
depth_range(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	bool pass;

	kb_program("MOV result.kbuffer[0], state.depth.range;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 1e-6, 0, 1, 1, 1);
	glDepthRange(.25, .75);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 1e-6, .25, .75, .5, 1) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** A transformation by the matrix that the vertices use, too. */
static enum piglit_result
modelview_projection(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	bool pass;

	kb_program("PARAM m[4] = { state.matrix.mvp };\nTEMP t;\n"
		   "DP4 t.x, m[0], { 1, 2, 3, 1 };\n"
		   "DP4 t.y, m[1], { 1, 2, 3, 1 };\n"
		   "DP4 t.z, m[2], { 1, 2, 3, 1 };\n"
		   "DP4 t.w, m[3], { 1, 2, 3, 1 };\n"
		   "MOV result.kbuffer[0], t;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	glMatrixMode(GL_MODELVIEW);
	glPushMatrix();
	/* Still covers everything. */
	glScalef(8, 4, .5);
	glTranslatef(0, 0, .125);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 1e-5, 8, 8, 1.5625, 1);
	glPopMatrix();
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 1e-5, 1, 2, 3, 1) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Two programs that use different state, bound in turn. */
static enum piglit_result
programs_in_turn(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	GLuint one = kb_program("MOV result.kbuffer[0], state.fog.color;");
	GLuint two = kb_program("MOV result.kbuffer[0], "
				"state.material.diffuse;");
	bool pass = true;

	glEnable(GL_KBUFFER_PROGRAM_MESA);
	for (int i = 1; i <= 4; i++) {
		const float x = i / 16.0f;

		/* Each changes while the other program is bound. */
		glBindProgramARB(GL_KBUFFER_PROGRAM_MESA, i % 2 ? one : two);
		kb_draw(&kb);
		set_fog_color(x);
		set_material(x / 2);
		glBindProgramARB(GL_KBUFFER_PROGRAM_MESA, i % 2 ? two : one);
		kb_draw(&kb);
		if (i % 2)
			pass = kb_expect(&kb, 0, 1e-6, x / 2, x, 1.5f * x,
					 2 * x) && pass;
		else
			pass = kb_expect(&kb, 0, 1e-6, x, 2 * x, 3 * x,
					 4 * x) && pass;
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("material", follows, &material),
	KB_SUBTEST("light", follows, &light),
	KB_SUBTEST("light-model", follows, &light_model),
	KB_SUBTEST("texture-environment", follows, &texture_environment),
	KB_SUBTEST("fog", follows, &fog),
	KB_SUBTEST("matrix", follows, &matrix),
	KB_SUBTEST("depth-range", depth_range, NULL),
	KB_SUBTEST("modelview-projection", modelview_projection, NULL),
	KB_SUBTEST("programs-in-turn", programs_in_turn, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(30)
