/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-layers.c
 * In a layered framebuffer the layer that a primitive selects is ignored while
 * the k-buffer program is enabled: layers are entries.  Depth and stencil
 * are tested in layer 0.  The number of layers is the smallest of the attachments.
 */

#include "kbuffer-common.h"

#define W 16

static const char vs[] =
	"#version 150 compatibility\n"
	"void main() { gl_Position = gl_Vertex; }\n";
static const char gs[] =
	"#version 150\n"
	"layout(triangles) in;\n"
	"layout(triangle_strip, max_vertices = 3) out;\n"
	"uniform int layer;\n"
	"void main() {\n"
	"	for (int i = 0; i < 3; i++) {\n"
	"		gl_Layer = layer;\n"
	"		gl_Position = gl_in[i].gl_Position;\n"
	"		EmitVertex();\n"
	"	}\n"
	"}\n";
static const char fs[] =
	"#version 150\n"
	"uniform vec4 value;\n"
	"out vec4 color;\n"
	"void main() { color = value; }\n";

/** Quads are split before a geometry shader of triangles. */
static void
draw(const struct kb *kb, int layer, float z)
{
	GLint program;

	glGetIntegerv(GL_CURRENT_PROGRAM, &program);
	glUniform1i(glGetUniformLocation(program, "layer"), layer);
	z = 2 * z - 1;
	glBegin(GL_TRIANGLE_STRIP);
	glVertex3f(-1, -1, z);
	glVertex3f(1, -1, z);
	glVertex3f(-1, 1, z);
	glVertex3f(1, 1, z);
	glEnd();
}

static void
use_shaders(float r, float g, float b, float a)
{
	GLuint program = kb_use_glsl(vs, gs, fs);

	glUniform4f(glGetUniformLocation(program, "value"), r, g, b, a);
}

static enum piglit_result
layer_ignored(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 4, W, W);
	bool pass = true;

	kb_program("ADD result.kbuffer[0], kbuffer[0], fragment.color;\n"
		   "ADD result.kbuffer[2], kbuffer[2], 10;");
	use_shaders(1, 2, 3, 4);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	for (int layer = 0; layer < 4; layer++)
		draw(&kb, layer, 0.5);
	pass = kb_expect(&kb, 0, 0, 4, 8, 12, 16) && pass;
	pass = kb_expect(&kb, 1, 0, 0, 0, 0, 0) && pass;
	pass = kb_expect(&kb, 2, 0, 40, 40, 40, 40) && pass;
	pass = kb_expect(&kb, 3, 0, 0, 0, 0, 0) && pass;

	/* It is honoured again when the stage is disabled. */
	glDisable(GL_KBUFFER_PROGRAM_MESA);
	draw(&kb, 3, 0.5);
	pass = kb_expect(&kb, 0, 0, 4, 8, 12, 16) && pass;
	pass = kb_expect(&kb, 3, 0, 1, 2, 3, 4) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Depth is read and written in layer 0, whatever gl_Layer says. */
static enum piglit_result
depth_in_layer_zero(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 3, W, W);
	GLint depth;
	float *z = malloc(W * W * 3 * sizeof(float));
	bool pass = true;

	kb_attach_depth(&kb, GL_DEPTH_COMPONENT32F);
	glClearDepth(1);
	glClear(GL_DEPTH_BUFFER_BIT);
	glEnable(GL_DEPTH_TEST);
	glDepthFunc(GL_LESS);
	kb_program("ADD result.kbuffer[1], kbuffer[1], 1;");
	use_shaders(1, 2, 3, 4);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	draw(&kb, 1, 0.5);      /* passes */
	draw(&kb, 2, 0.75);     /* fails */
	draw(&kb, 0, 0.25);     /* passes */
	draw(&kb, 1, 0.375);    /* fails */
	pass = piglit_check_gl_error(GL_NO_ERROR) && pass;
	pass = kb_expect(&kb, 1, 0, 2, 2, 2, 2) && pass;

	glGetFramebufferAttachmentParameteriv(
		GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT,
		GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME, &depth);
	glBindTexture(GL_TEXTURE_2D_ARRAY, depth);
	glGetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_DEPTH_COMPONENT, GL_FLOAT, z);
	for (int i = 0; i < W * W * 3 && pass; i++) {
		pass = z[i] == (i < W * W ? 0.25f : 1.0f);
		if (!pass)
			printf("depth of texel %d is %g\n", i, z[i]);
	}
	free(z);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** And so is stencil: each draw counts up what passes only twice. */
static enum piglit_result
stencil_in_layer_zero(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 3, W, W);
	GLuint tex = kb_new_texture(), packed[3 * W * W];
	bool pass;

	glBindTexture(GL_TEXTURE_2D_ARRAY, tex);
	glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_DEPTH24_STENCIL8, W, W, 3, 0,
		     GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, NULL);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, tex,
			     0);
	glClearStencil(5);
	glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
	glEnable(GL_STENCIL_TEST);
	glStencilFunc(GL_GREATER, 7, ~0u);
	glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
	kb_program("ADD result.kbuffer[1], kbuffer[1], 1;");
	use_shaders(1, 2, 3, 4);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	for (int layer = 2; layer >= 0; layer--)
		draw(&kb, layer, 0.5);
	pass = kb_expect(&kb, 1, 0, 2, 2, 2, 2);

	glGetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_DEPTH_STENCIL,
		      GL_UNSIGNED_INT_24_8, packed);
	for (int i = 0; i < W * W * 3 && pass; i++) {
		pass = (packed[i] & 0xff) == (i < W * W ? 7 : 5);
		if (!pass)
			printf("stencil of texel %d is %d\n", i,
			       packed[i] & 0xff);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Attachments of 4 and 2 layers: 2 x 2 entries, no more. */
static enum piglit_result
smallest_number_of_layers(void *data)
{
	struct kb big = kb_create(GL_RGBA32F, 1, 4, W, W);
	struct kb kb = kb_create(GL_RGBA32F, 1, 2, W, W);
	bool pass;

	glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, big.tex[0],
			     0);
	glDrawBuffers(2, (GLenum[]) { GL_COLOR_ATTACHMENT0,
				      GL_COLOR_ATTACHMENT1 });
	if (glCheckFramebufferStatus(GL_FRAMEBUFFER) !=
	    GL_FRAMEBUFFER_COMPLETE)
		return PIGLIT_SKIP;
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_program("MOV result.kbuffer[2], 2;\nMOV result.kbuffer[3], 3;");
	kb_draw(&kb);
	pass = piglit_check_gl_error(GL_NO_ERROR);
	pass = kb_expect(&kb, 0, 0, 0, 0, 0, 0) && pass;
	pass = kb_expect(&kb, 1, 0, 2, 2, 2, 2) && pass;
	pass = kb_expect(&big, 1, 0, 3, 3, 3, 3) && pass;
	pass = kb_expect(&big, 2, 0, 0, 0, 0, 0) && pass;
	kb_program("MOV result.kbuffer[4], 4;");
	kb_draw(&kb);
	pass = piglit_check_gl_error(GL_INVALID_OPERATION) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** One layer attached by FramebufferTextureLayer: not layered, 1 entry. */
static enum piglit_result
single_layer(void *data)
{
	struct kb layers = kb_create(GL_RGBA32F, 1, 4, W, W);
	bool pass;

	glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
				  layers.tex[0], 0, 2);
	kb_program("ADD result.kbuffer[0], kbuffer[0], 3;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&layers);
	pass = kb_expect(&layers, 2, 0, 3, 3, 3, 3);
	for (int e = 0; e < 4; e++)
		pass = (e == 2 || kb_expect(&layers, e, 0, 0, 0, 0, 0)) && pass;
	kb_program("MOV result.kbuffer[1], 4;");
	kb_draw(&layers);
	pass = piglit_check_gl_error(GL_INVALID_OPERATION) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** A mipmap level other than zero of an array texture. */
static enum piglit_result
level(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 2, W, W);
	GLuint tex;
	float *got = calloc(2 * W * W * 4, sizeof(float));
	bool pass = true;

	glGenTextures(1, &tex);
	glBindTexture(GL_TEXTURE_2D_ARRAY, tex);
	for (int l = 0; l < 3; l++)
		glTexImage3D(GL_TEXTURE_2D_ARRAY, l, GL_RGBA32F, 4 * W >> l,
			     4 * W >> l, 2, 0, GL_RGBA, GL_FLOAT, NULL);
	glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, 2);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, tex, 2);
	glClear(GL_COLOR_BUFFER_BIT);
	kb_program("ADD result.kbuffer[0], kbuffer[0], 3;\n"
		   "ADD result.kbuffer[1], kbuffer[1], 5;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	glGetTexImage(GL_TEXTURE_2D_ARRAY, 2, GL_RGBA, GL_FLOAT, got);
	for (int i = 0; i < 2 * W * W * 4 && pass; i++)
		pass = got[i] == (i < W * W * 4 ? 3 : 5);
	if (!pass)
		printf("wrong texels in level 2\n");
	free(got);
	glDeleteTextures(1, &tex);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("layer-ignored", layer_ignored, NULL),
	KB_SUBTEST("depth-in-layer-zero", depth_in_layer_zero, NULL),
	KB_SUBTEST("stencil-in-layer-zero", stencil_in_layer_zero, NULL),
	KB_SUBTEST("smallest-number-of-layers", smallest_number_of_layers,
		   NULL),
	KB_SUBTEST("single-layer", single_layer, NULL),
	KB_SUBTEST("level", level, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
