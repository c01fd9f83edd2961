/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-attachments.c
 * Entries live in whatever can be attached: renderbuffers, levels, cube map
 * faces, slices of 3D textures, rectangle textures, and whole 3D textures and
 * cube maps as layers.
 */

#include "kbuffer-common.h"

#define W 16

/** Read the bound framebuffer's read buffer: all pixels x, y, z, w. */
static bool
check_read(float r, float g, float b, float a)
{
	float got[W * W][4];
	const float wanted[4] = { r, g, b, a };

	glReadPixels(0, 0, W, W, GL_RGBA, GL_FLOAT, got);
	for (int i = 0; i < W * W; i++) {
		if (memcmp(got[i], wanted, sizeof(wanted)) == 0)
			continue;
		printf("pixel %d: %g %g %g %g, expected %g %g %g %g\n", i,
		       got[i][0], got[i][1], got[i][2], got[i][3], r, g, b, a);
		return false;
	}
	return true;
}

static struct kb
make(void)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);

	kb_program("MAD result.kbuffer[0], kbuffer[0], 2, fragment.color;");
	kb_fragment_value(1, 2, 3, 4);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	return kb;
}

/** Clear the new attachment, draw twice: 3 times the color. */
static enum piglit_result
check(const struct kb *kb)
{
	if (glCheckFramebufferStatus(GL_FRAMEBUFFER) !=
	    GL_FRAMEBUFFER_COMPLETE) {
		printf("incomplete\n");
		return PIGLIT_FAIL;
	}
	glClearColor(0, 0, 0, 0);
	glClear(GL_COLOR_BUFFER_BIT);
	kb_draw(kb);
	kb_draw(kb);
	return check_read(3, 6, 9, 12) ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
renderbuffer(void *data)
{
	struct kb kb = make();
	enum piglit_result result;
	GLuint rb;

	glGenRenderbuffers(1, &rb);
	glBindRenderbuffer(GL_RENDERBUFFER, rb);
	glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA32F, W, W);
	glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
				  GL_RENDERBUFFER, rb);
	result = check(&kb);
	glDeleteRenderbuffers(1, &rb);
	return result;
}

/** Level 1 of a texture: its other levels stay. */
static enum piglit_result
level(void *data)
{
	struct kb kb = make(), base = kb;
	enum piglit_result result;
	GLuint tex;

	glGenTextures(1, &tex);
	glBindTexture(GL_TEXTURE_2D, tex);
	for (int l = 0; l < 6; l++)
		glTexImage2D(GL_TEXTURE_2D, l, GL_RGBA32F, 2 * W >> l,
			     2 * W >> l, 0, GL_RGBA, GL_FLOAT, NULL);
	base.tex[0] = tex;
	base.width = base.height = 2 * W;
	kb_fill(&base, 0, 7, 7, 7, 7);
	glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
			       GL_TEXTURE_2D, tex, 1);
	result = check(&kb);
	if (!kb_expect(&base, 0, 0, 7, 7, 7, 7))
		result = PIGLIT_FAIL;
	glDeleteTextures(1, &tex);
	return result;
}

static enum piglit_result
rectangle(void *data)
{
	struct kb kb = make();
	enum piglit_result result;
	GLuint tex;

	glGenTextures(1, &tex);
	glBindTexture(GL_TEXTURE_RECTANGLE, tex);
	glTexImage2D(GL_TEXTURE_RECTANGLE, 0, GL_RGBA32F, W, W, 0, GL_RGBA,
		     GL_FLOAT, NULL);
	glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
			       GL_TEXTURE_RECTANGLE, tex, 0);
	result = check(&kb);
	glDeleteTextures(1, &tex);
	return result;
}

static GLuint
cube_map(void)
{
	GLuint tex;

	glGenTextures(1, &tex);
	glBindTexture(GL_TEXTURE_CUBE_MAP, tex);
	for (int f = 0; f < 6; f++)
		glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + f, 0, GL_RGBA32F,
			     W, W, 0, GL_RGBA, GL_FLOAT, NULL);
	glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	return tex;
}

static GLuint
texture_3d(int depth)
{
	GLuint tex;

	glGenTextures(1, &tex);
	glBindTexture(GL_TEXTURE_3D, tex);
	glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA32F, W, W, depth, 0, GL_RGBA,
		     GL_FLOAT, NULL);
	glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	return tex;
}

static enum piglit_result
cube_face(void *data)
{
	struct kb kb = make();
	GLuint tex = cube_map();
	bool pass = true;

	for (int f = 0; f < 6; f++) {
		glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
				       GL_TEXTURE_CUBE_MAP_POSITIVE_X + f, tex,
				       0);
		pass = check(&kb) == PIGLIT_PASS && pass;
	}
	glDeleteTextures(1, &tex);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
slice(void *data)
{
	struct kb kb = make();
	GLuint tex = texture_3d(5);
	bool pass = true;

	for (int z = 0; z < 5; z += 2) {
		glFramebufferTexture3D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
				       GL_TEXTURE_3D, tex, 0, z);
		pass = check(&kb) == PIGLIT_PASS && pass;
	}
	glDeleteTextures(1, &tex);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Arrays of six images of W x W, or of six rows of W. */
static GLuint
array(GLenum target)
{
	GLuint tex;

	glGenTextures(1, &tex);
	glBindTexture(target, tex);
	if (target == GL_TEXTURE_1D_ARRAY)
		glTexImage2D(target, 0, GL_RGBA32F, W, 6, 0, GL_RGBA, GL_FLOAT,
			     NULL);
	else
		glTexImage3D(target, 0, GL_RGBA32F, W, W, 6, 0, GL_RGBA,
			     GL_FLOAT, NULL);
	glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	return tex;
}

/** A whole texture: each layer is an entry, each face or slice one. */
static enum piglit_result
layered(void *data)
{
	const GLenum target = (GLenum)(intptr_t)data;
	const int height = target == GL_TEXTURE_1D_ARRAY ? 1 : W;
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	float *got = calloc(6 * W * W * 4, sizeof(float));
	char program[512] = "", *end = program;
	bool pass = true;
	GLuint tex;

	if (target == GL_TEXTURE_CUBE_MAP_ARRAY &&
	    !piglit_is_extension_supported("GL_ARB_texture_cube_map_array")) {
		printf("no cube map arrays here\n");
		free(got);
		return PIGLIT_SKIP;
	}
	tex = target == GL_TEXTURE_CUBE_MAP ? cube_map() :
		target == GL_TEXTURE_3D ? texture_3d(6) : array(target);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, tex, 0);
	glClearColor(1, 1, 1, 1);
	glClear(GL_COLOR_BUFFER_BIT);
	for (int e = 0; e < 6; e++)
		end += sprintf(end, "MUL result.kbuffer[%d], kbuffer[%d], "
			       "%d;\n", e, e, e + 2);
	kb_program(program);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	kb_draw(&kb);
	if (target == GL_TEXTURE_CUBE_MAP) {
		for (int f = 0; f < 6; f++)
			glGetTexImage(GL_TEXTURE_CUBE_MAP_POSITIVE_X + f, 0,
				      GL_RGBA, GL_FLOAT,
				      got + f * W * W * 4);
	} else {
		glGetTexImage(target, 0, GL_RGBA, GL_FLOAT, got);
	}
	for (int i = 0; i < 6 * W * height * 4 && pass; i++) {
		const int e = i / (W * height * 4);

		pass = got[i] == (e + 2) * (e + 2);
		if (!pass)
			printf("layer %d: %g\n", e, got[i]);
	}
	/* There is no seventh. */
	kb_program("MOV result.kbuffer[6], 1;");
	kb_draw(&kb);
	pass = piglit_check_gl_error(GL_INVALID_OPERATION) && pass;
	free(got);
	glDeleteTextures(1, &tex);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** A texture of a k-buffer is sampled once it is no longer drawn to. */
static enum piglit_result
sampled_afterwards(void *data)
{
	struct kb kb = make(), out;

	kb_draw(&kb);
	out = kb_create(GL_RGBA32F, 1, 0, W, W);
	glBindTexture(GL_TEXTURE_2D, kb.tex[0]);
	kb_program("TEMP t;\nMUL t, fragment.position, 0.0625;\n"
		   "TEX t, t, texture[0], 2D;\n"
		   "MAD result.kbuffer[0], t, 10, kbuffer[0];");
	kb_draw(&out);
	glBindFramebuffer(GL_FRAMEBUFFER, kb.fbo);
	kb_program("MAD result.kbuffer[0], kbuffer[0], 2, fragment.color;");
	glBindTexture(GL_TEXTURE_2D, 0);
	kb_draw(&kb);
	glBindFramebuffer(GL_FRAMEBUFFER, out.fbo);
	glBindTexture(GL_TEXTURE_2D, kb.tex[0]);
	kb_program("TEMP t;\nMUL t, fragment.position, 0.0625;\n"
		   "TEX t, t, texture[0], 2D;\n"
		   "MAD result.kbuffer[0], t, 10, kbuffer[0];");
	kb_draw(&out);
	return check_read(40, 80, 120, 160) ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** 1 x 1 and odd sizes, wider than a tile. */
static enum piglit_result
sizes(void *data)
{
	static const int size[][2] = {
		{ 1, 1 }, { 3, 1 }, { 1, 5 }, { 65, 1 }, { 129, 67 }, { 7, 200 }
	};
	bool pass = true;

	for (int i = 0; i < ARRAY_SIZE(size); i++) {
		struct kb kb = kb_create(GL_RGBA32F, 2, 2, size[i][0],
					 size[i][1]);

		kb_program("ADD result.kbuffer[0], kbuffer[0], 1;\n"
			   "ADD result.kbuffer[3], kbuffer[3], 2;");
		glEnable(GL_KBUFFER_PROGRAM_MESA);
		kb_draw(&kb);
		kb_draw(&kb);
		pass = kb_expect(&kb, 0, 0, 2, 2, 2, 2) &&
			kb_expect(&kb, 1, 0, 0, 0, 0, 0) &&
			kb_expect(&kb, 2, 0, 0, 0, 0, 0) &&
			kb_expect(&kb, 3, 0, 4, 4, 4, 4) && pass;
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Clears and programs stay in what all attachments have. */
static enum piglit_result
larger_than_framebuffer(void *data)
{
	static const GLenum buffers[2] = {
		GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1
	};
	/* Parts of a tile of 64x64 and of a block of 4x4. */
	const int small = 30, large = 70;
	struct kb other = kb_create(GL_RGBA32F, 1, 0, small, small);
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, large, large);
	bool pass;

	if (kb_is_softpipe()) {
		printf("softpipe clears all of an attachment, stock or not\n");
		return PIGLIT_SKIP;
	}
	kb_fill(&kb, 0, 5, 5, 5, 5);
	glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1,
			       GL_TEXTURE_2D, other.tex[0], 0);
	glDrawBuffers(2, buffers);
	glClearColor(2, 2, 2, 2);
	glClear(GL_COLOR_BUFFER_BIT);
	kb_program("ADD result.kbuffer[0], kbuffer[0], 1;\n"
		   "ADD result.kbuffer[1], kbuffer[1], 2;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw_rect(&kb, 3, 0, 8, large, 0.5);
	pass = kb_expect_rect(&kb, 0, 3, 0, 8, small, 0, 3, 3, 3, 3);
	pass = kb_expect_rect(&kb, 0, 11, 0, small - 11, small, 0, 2, 2, 2,
			      2) && pass;
	pass = kb_expect_rect(&kb, 0, small, 0, large - small, large, 0, 5, 5,
			      5, 5) && pass;
	pass = kb_expect_rect(&kb, 0, 0, small, large, large - small, 0, 5, 5,
			      5, 5) && pass;
	pass = kb_expect_only_rect(&other, 0, 3, 0, 8, small,
				   (const float[4]) { 4, 4, 4, 4 },
				   (const float[4]) { 2, 2, 2, 2 }) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("renderbuffer", renderbuffer, NULL),
	KB_SUBTEST("level", level, NULL),
	KB_SUBTEST("rectangle", rectangle, NULL),
	KB_SUBTEST("cube-face", cube_face, NULL),
	KB_SUBTEST("3d-slice", slice, NULL),
	KB_SUBTEST("layered-3d", layered, GL_TEXTURE_3D),
	KB_SUBTEST("layered-cube", layered, GL_TEXTURE_CUBE_MAP),
	KB_SUBTEST("layered-cube-array", layered, GL_TEXTURE_CUBE_MAP_ARRAY),
	KB_SUBTEST("layered-1d-array", layered, GL_TEXTURE_1D_ARRAY),
	KB_SUBTEST("sampled-afterwards", sampled_afterwards, NULL),
	KB_SUBTEST("sizes", sizes, NULL),
	KB_SUBTEST("larger-than-framebuffer", larger_than_framebuffer, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
