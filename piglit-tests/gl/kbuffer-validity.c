/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-validity.c
 * Whether drawing is an error follows every change of what it depends on,
 * from one draw to the next: the program and its string, the framebuffer, its
 * attachments, their formats and layers, the draw buffers.
 */

#include "kbuffer-common.h"

#define W 8
#define K GL_KBUFFER_PROGRAM_MESA

static bool
draws(const struct kb *kb, bool valid)
{
	kb_draw(kb);
	return piglit_check_gl_error(valid ? GL_NO_ERROR :
				     GL_INVALID_OPERATION);
}

static enum piglit_result
program_string(void *data)
{
	static const char one[] = "!!ARBfp1.0\nOPTION MESA_kbuffer_program;\n"
		"MOV result.kbuffer[0], 1;\nEND\n";
	static const char two[] = "!!ARBfp1.0\nOPTION MESA_kbuffer_program;\n"
		"MOV result.kbuffer[1], 1;\nEND\n";
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	bool pass = true;

	kb_program("");
	glEnable(K);
	for (int i = 0; i < 6; i++) {
		const char *string = i % 2 ? two : one;

		pass = kb_load(K, string, strlen(string)) == GL_NO_ERROR &&
			draws(&kb, i % 2 == 0) && pass;
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
program_binding(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	GLuint good = kb_program("MOV result.kbuffer[0], kbuffer[0];");
	GLuint bad = kb_program("MOV result.kbuffer[0], kbuffer[9];");
	bool pass = true;

	glEnable(K);
	for (int i = 0; i < 3; i++) {
		pass = draws(&kb, false) && pass;
		glBindProgramARB(K, good);
		pass = draws(&kb, true) && pass;
		glBindProgramARB(K, bad);
	}
	glDisable(K);
	pass = draws(&kb, true) && pass;
	glEnable(K);
	pass = draws(&kb, false) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
framebuffer_binding(void *data)
{
	struct kb one = kb_create(GL_RGBA32F, 1, 0, W, W);
	struct kb layers = kb_create(GL_RGBA32F, 1, 3, W, W);
	bool pass = true;

	kb_program("MOV result.kbuffer[0], kbuffer[2];");
	glEnable(K);
	for (int i = 0; i < 3; i++) {
		pass = draws(&layers, true) && pass;
		glBindFramebuffer(GL_FRAMEBUFFER, one.fbo);
		pass = draws(&one, false) && pass;
		glBindFramebuffer(GL_FRAMEBUFFER, piglit_winsys_fbo);
		pass = draws(&one, false) && pass;
		glBindFramebuffer(GL_FRAMEBUFFER, layers.fbo);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
attachments(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 2, 0, W, W);
	bool pass = true;

	kb_program("MOV result.kbuffer[0], kbuffer[1];");
	glEnable(K);
	for (int i = 0; i < 3; i++) {
		pass = draws(&kb, true) && pass;
		glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, 0,
				     0);
		pass = draws(&kb, false) && pass;
		glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1,
				     kb.tex[1], 0);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
draw_buffers(void *data)
{
	static const GLenum both[2] = { GL_COLOR_ATTACHMENT0,
					GL_COLOR_ATTACHMENT1 };
	struct kb kb = kb_create(GL_RGBA32F, 2, 0, W, W);
	bool pass = true;

	kb_program("MOV result.kbuffer[0], kbuffer[1];");
	glEnable(K);
	for (int i = 0; i < 3; i++) {
		pass = draws(&kb, true) && pass;
		glDrawBuffer(GL_COLOR_ATTACHMENT0);
		pass = draws(&kb, false) && pass;
		glDrawBuffers(2, both);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** The attached texture gets another format, or fewer layers. */
static enum piglit_result
texture_format(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	bool pass = true;

	kb_program("MOV result.kbuffer[0], kbuffer[0];");
	/* Only a shader may draw to integers, without the program. */
	kb_use_glsl("void main() { gl_Position = gl_Vertex; }\n", NULL,
		    "void main() { gl_FragColor = vec4(1.); }\n");
	glEnable(K);
	glBindTexture(GL_TEXTURE_2D, kb.tex[0]);
	for (int i = 0; i < 3; i++) {
		pass = draws(&kb, true) && pass;
		glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32I, W, W, 0,
			     GL_RGBA_INTEGER, GL_INT, NULL);
		pass = draws(&kb, false) && pass;
		glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, W, W, 0, GL_RGBA,
			     GL_FLOAT, NULL);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
texture_layers(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 4, W, W);
	bool pass = true;

	kb_program("MOV result.kbuffer[0], kbuffer[3];");
	glEnable(K);
	glBindTexture(GL_TEXTURE_2D_ARRAY, kb.tex[0]);
	for (int i = 0; i < 3; i++) {
		pass = draws(&kb, true) && pass;
		glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA32F, W, W, 2, 0,
			     GL_RGBA, GL_FLOAT, NULL);
		pass = draws(&kb, false) && pass;
		glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA32F, W, W, 4, 0,
			     GL_RGBA, GL_FLOAT, NULL);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("program-string", program_string, NULL),
	KB_SUBTEST("program-binding", program_binding, NULL),
	KB_SUBTEST("framebuffer-binding", framebuffer_binding, NULL),
	KB_SUBTEST("attachments", attachments, NULL),
	KB_SUBTEST("draw-buffers", draw_buffers, NULL),
	KB_SUBTEST("texture-format", texture_format, NULL),
	KB_SUBTEST("texture-layers", texture_layers, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
