/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-ignored-state.c
 * The program runs in the place of blending, dithering and logic op, whose
 * state is ignored while it is enabled and in force again afterwards.
 */

#include "kbuffer-common.h"

#define W 16

static void
blend_add(void)
{
	glEnable(GL_BLEND);
	glBlendFunc(GL_ONE, GL_ONE);
}

static void
blend_zero(void)
{
	glEnable(GL_BLEND);
	glBlendFunc(GL_ZERO, GL_ZERO);
}

static void
blend_min(void)
{
	glEnable(GL_BLEND);
	glBlendEquation(GL_MIN);
}

static void
blend_second_buffer(void)
{
	glEnablei(GL_BLEND, 1);
	glBlendFunc(GL_ONE, GL_ONE);
}

static void
blend_constant(void)
{
	glEnable(GL_BLEND);
	glBlendFunc(GL_CONSTANT_COLOR, GL_ONE_MINUS_SRC_ALPHA);
	glBlendColor(1, 1, 1, 1);
}

/** Of two draw buffers, which dual-source blending itself cannot have. */
static void
blend_dual_source(void)
{
	glEnable(GL_BLEND);
	glBlendFunc(GL_SRC1_COLOR, GL_ONE_MINUS_SRC1_COLOR);
}

static void
blend_advanced(void)
{
	glEnable(GL_BLEND);
	glBlendEquation(GL_MULTIPLY_KHR);
}

static void
logic_op(void)
{
	glEnable(GL_COLOR_LOGIC_OP);
	glLogicOp(GL_XOR);
}

static void
logic_op_clear(void)
{
	glEnable(GL_COLOR_LOGIC_OP);
	glLogicOp(GL_CLEAR);
}

static void
dither(void)
{
	glEnable(GL_DITHER);
}

/** By state set before and after the program was enabled. */
static enum piglit_result
ignored(void *data)
{
	void (*set)(void) = data;
	static const GLenum formats[] = { GL_RGBA8, GL_RGBA32F };
	bool pass = true;

	for (int i = 0; i < 4; i++) {
		struct kb kb = kb_create(formats[i % 2], 2, 0, W, W);
		const float t = i % 2 ? 0 : 1e-6f;

		kb_fill(&kb, 0, .2, .4, .6, .8);
		kb_fill(&kb, 1, .8, .6, .4, .2);
		/* Fifths are bytes: multiples of 51. */
		kb_program("MOV result.kbuffer[0], { 0.6, 0.2, 1, 0.4 };\n"
			   "MOV result.kbuffer[1], kbuffer[0];");
		glPushAttrib(GL_COLOR_BUFFER_BIT | GL_ENABLE_BIT);
		if (i < 2)
			set();
		glEnable(GL_KBUFFER_PROGRAM_MESA);
		if (i >= 2)
			set();
		kb_draw(&kb);
		glPopAttrib();
		if (!kb_expect(&kb, 0, t, .6, .2, 1, .4) ||
		    !kb_expect(&kb, 1, t, .2, .4, .6, .8)) {
			printf("%s, state set %s the program was enabled\n",
			       piglit_get_gl_enum_name(kb.format),
			       i < 2 ? "before" : "after");
			pass = false;
		}
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
dual_source(void *data)
{
	piglit_require_extension("GL_ARB_blend_func_extended");
	return ignored(blend_dual_source);
}

static bool
has_advanced_blending(void)
{
	if (piglit_is_extension_supported("GL_KHR_blend_equation_advanced"))
		return true;
	printf("no advanced blending here\n");
	return false;
}

/** Two draw buffers, and a fragment stage that was not made for it. */
static enum piglit_result
advanced(void *data)
{
	return has_advanced_blending() ? ignored(blend_advanced) : PIGLIT_SKIP;
}

/** A shader that could blend so hands its own color to the program. */
static enum piglit_result
advanced_shader(void *data)
{
	struct kb kb;
	bool pass = true;

	if (!has_advanced_blending())
		return PIGLIT_SKIP;
	kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	kb_use_glsl("#version 150 compatibility\n"
		    "void main() { gl_Position = gl_Vertex; }\n", NULL,
		    "#version 150 compatibility\n"
		    "#extension GL_KHR_blend_equation_advanced: require\n"
		    "layout(blend_support_multiply) out;\n"
		    "out vec4 o;\nvoid main() { o = vec4(.5, .25, 1, 1); }\n");
	kb_program("ADD result.kbuffer[0], fragment.color, 1;");
	for (int i = 0; i < 4; i++) {
		kb_fill(&kb, 0, .5, .5, .5, 1);
		/* By the equation, by the program, and both in turn. */
		if (i == 0)
			blend_advanced();
		else if (i == 3)
			glDisable(GL_BLEND);
		if (i % 2)
			glEnable(GL_KBUFFER_PROGRAM_MESA);
		else
			glDisable(GL_KBUFFER_PROGRAM_MESA);
		kb_draw(&kb);
		pass = (i % 2 ? kb_expect(&kb, 0, 0, 1.5, 1.25, 2, 2) :
			kb_expect(&kb, 0, 1e-6, .25, .125, .5, 1)) && pass;
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
in_force_again(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	bool pass;

	kb_fill(&kb, 0, 1, 2, 3, 4);
	kb_program("MUL result.kbuffer[0], kbuffer[0], 10;");
	kb_fragment_value(1, 1, 1, 1);
	blend_add();
	kb_draw(&kb);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 20, 30, 40, 50);
	glDisable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 21, 31, 41, 51) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Enabled and disabled draws in turn, within one scene of the rasterizer. */
static enum piglit_result
in_turn(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	float x = 0;

	kb_program("MUL result.kbuffer[0], kbuffer[0], 2;");
	kb_fragment_value(1, 1, 1, 1);
	blend_add();
	for (int i = 0; i < 20; i++) {
		if (i % 2)
			glEnable(GL_KBUFFER_PROGRAM_MESA);
		else
			glDisable(GL_KBUFFER_PROGRAM_MESA);
		kb_draw(&kb);
		x = i % 2 ? 2 * x : x + 1;
	}
	return kb_expect(&kb, 0, 0, x, x, x, x) ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Another program, format and number of buffers with each draw. */
static enum piglit_result
changing_framebuffers(void *data)
{
	static const GLenum formats[4] = {
		GL_RGBA32F, GL_RGBA16F, GL_RGBA32F, GL_R32F
	};
	struct kb kb[4];
	bool pass = true;

	for (int i = 0; i < 4; i++)
		kb[i] = kb_create(formats[i], i + 1, i == 2 ? 3 : 0, W, W);
	kb_program("ADD result.kbuffer[0].x, kbuffer[0], 1;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	for (int i = 0; i < 40; i++) {
		glBindFramebuffer(GL_FRAMEBUFFER, kb[i % 4].fbo);
		kb_draw(&kb[i % 4]);
	}
	for (int i = 0; i < 4; i++)
		pass = kb_expect(&kb[i], 0, 0, 10, 0, 0, i == 3) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("blend-add", ignored, blend_add),
	KB_SUBTEST("blend-zero", ignored, blend_zero),
	KB_SUBTEST("blend-min", ignored, blend_min),
	KB_SUBTEST("blend-second-buffer", ignored, blend_second_buffer),
	KB_SUBTEST("blend-constant", ignored, blend_constant),
	KB_SUBTEST("blend-dual-source", dual_source, NULL),
	KB_SUBTEST("blend-advanced", advanced, NULL),
	KB_SUBTEST("blend-advanced-shader", advanced_shader, NULL),
	KB_SUBTEST("logic-op", ignored, logic_op),
	KB_SUBTEST("logic-op-clear", ignored, logic_op_clear),
	KB_SUBTEST("dither", ignored, dither),
	KB_SUBTEST("in-force-again", in_force_again, NULL),
	KB_SUBTEST("in-turn", in_turn, NULL),
	KB_SUBTEST("changing-framebuffers", changing_framebuffers, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
