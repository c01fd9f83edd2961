/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-core-profile.c
 * The extension is in the core profile, too: queries and errors are the same,
 * and the fragments of three overlapping rectangles are peeled in two passes.
 */

#include "piglit-util-gl.h"
#include <GL/mesa_kbuffer.h>

PIGLIT_GL_TEST_CONFIG_BEGIN
	config.supports_gl_core_version = 33;
	config.window_visual = PIGLIT_GL_VISUAL_RGBA | PIGLIT_GL_VISUAL_DOUBLE;
	config.khr_no_error_support = PIGLIT_HAS_ERRORS;
PIGLIT_GL_TEST_CONFIG_END

#define W 16
#define LAYERS 2

/** Window z of three draws, in their order. */
static const float depths[3] = { .5f, .25f, .75f };

static const char vs[] =
	"#version 330\n"
	"uniform float z;\n"
	"void main() {\n"
	"  gl_Position = vec4(4 * (gl_VertexID & 1) - 1,\n"
	"                     2 * (gl_VertexID & 2) - 1, 2 * z - 1, 1);\n"
	"}\n";
static const char fs[] =
	"#version 330\n"
	"uniform float z;\n"
	"out vec4 color;\n"
	"void main() { color = vec4(z, 1, 0, 1); }\n";

static GLuint
layers(GLenum format, GLenum base, GLenum attachment)
{
	GLuint tex;

	glGenTextures(1, &tex);
	glBindTexture(GL_TEXTURE_2D_ARRAY, tex);
	glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, format, W, W, LAYERS, 0, base,
		     GL_FLOAT, NULL);
	glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER,
			GL_NEAREST);
	glFramebufferTexture(GL_FRAMEBUFFER, attachment, tex, 0);
	return tex;
}

static void
draw(GLuint program)
{
	for (int i = 0; i < ARRAY_SIZE(depths); i++) {
		glUniform1f(glGetUniformLocation(program, "z"), depths[i]);
		glDrawArrays(GL_TRIANGLES, 0, 3);
	}
}

static bool
check(const float expected[LAYERS], bool overflows)
{
	GLint overflow = -1;
	bool pass;
	float z[LAYERS * W * W], rgba[LAYERS * W * W][4];
	GLint depth, color;

	glGetFramebufferAttachmentParameteriv(
		GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT,
		GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME, &depth);
	glGetFramebufferAttachmentParameteriv(
		GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
		GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME, &color);
	glBindTexture(GL_TEXTURE_2D_ARRAY, depth);
	glGetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_DEPTH_COMPONENT, GL_FLOAT, z);
	glBindTexture(GL_TEXTURE_2D_ARRAY, color);
	glGetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA, GL_FLOAT, rgba);
	glGetFramebufferParameteriv(GL_FRAMEBUFFER,
				    GL_DEPTH_PEELING_OVERFLOW_MESA, &overflow);
	pass = overflow == overflows;
	for (int i = 0; i < LAYERS * W * W; i++) {
		const float want = expected[i / W / W];
		const float red = want == 1 ? 0 : want;

		if (z[i] == want && rgba[i][0] == red)
			continue;
		printf("layer %d: depth %g, red %g, expected %g, %g\n",
		       i / W / W, z[i], rgba[i][0], want, red);
		return false;
	}
	if (!pass)
		printf("overflow is %d\n", overflow);
	return pass;
}

enum piglit_result
piglit_display(void)
{
	static const float first[2] = { .25f, .5f }, second[2] = { .75f, 1 };
	GLuint fbo, vao, program;
	GLint max = 0, enabled = -1;
	bool pass;

	piglit_require_extension("GL_MESA_depth_peeling");
	glGetIntegerv(GL_MAX_DEPTH_PEELING_LAYERS_MESA, &max);
	glGetIntegerv(GL_DEPTH_PEELING_MESA, &enabled);
	pass = max >= 64 && enabled == 0 &&
		!glIsEnabled(GL_DEPTH_PEELING_MESA);

	glGenVertexArrays(1, &vao);
	glBindVertexArray(vao);
	program = piglit_build_simple_program(vs, fs);
	glUseProgram(program);
	glEnable(GL_DEPTH_PEELING_MESA);
	pass = glIsEnabled(GL_DEPTH_PEELING_MESA) && pass;
	glDrawArrays(GL_TRIANGLES, 0, 3);
	pass = piglit_check_gl_error(GL_INVALID_OPERATION) && pass;

	glGenFramebuffers(1, &fbo);
	glBindFramebuffer(GL_FRAMEBUFFER, fbo);
	layers(GL_RGBA32F, GL_RGBA, GL_COLOR_ATTACHMENT0);
	layers(GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_DEPTH_ATTACHMENT);
	glViewport(0, 0, W, W);

	glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
	draw(program);
	pass = check(first, true) && pass;
	glFramebufferParameteri(GL_FRAMEBUFFER,
				GL_DEPTH_PEELING_FIRST_LAYER_MESA, LAYERS);
	glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
	draw(program);
	pass = check(second, false) && pass;
	pass = piglit_check_gl_error(GL_NO_ERROR) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

void
piglit_init(int argc, char **argv)
{
}
