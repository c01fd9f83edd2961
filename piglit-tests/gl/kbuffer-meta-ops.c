/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-meta-ops.c
 * Clears, blits, ReadPixels, texture uploads, downloads and copies and mipmap
 * generation do the same with the stage enabled as without: a program that
 * would put 7 everywhere is enabled all the time.
 */

#include "kbuffer-common.h"

#define W 64

static struct kb
make(GLenum format, int attachments, int layers)
{
	struct kb kb = kb_create(format, attachments, layers, W, W);

	kb_program("MOV result.kbuffer[0], 7;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	return kb;
}

static enum piglit_result
clear(void *data)
{
	const int layers = (int)(intptr_t)data;
	struct kb kb = make(GL_RGBA32F, 2, layers);
	bool pass = true;

	glClearColor(1, 2, 3, 4);
	glClear(GL_COLOR_BUFFER_BIT);
	for (int e = 0; e < kb_entries(&kb); e++)
		pass = kb_expect(&kb, e, 0, 1, 2, 3, 4) && pass;
	glClearBufferfv(GL_COLOR, 1, (float[4]) { 5, 6, 7, 8 });
	for (int e = 0; e < kb_entries(&kb); e++)
		pass = kb_expect(&kb, e, 0, e % 2 ? 5 : 1, e % 2 ? 6 : 2,
				 e % 2 ? 7 : 3, e % 2 ? 8 : 4) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** With a scissor and a mask a clear may be drawn as a quad. */
static enum piglit_result
partial_clear(void *data)
{
	static const float inside[4] = { 0, 2, 3, 0 }, outside[4];
	struct kb kb = make(GL_RGBA32F, 1, 0);
	bool pass;

	kb_attach_depth(&kb, GL_DEPTH_COMPONENT24);
	glClearDepth(1);
	glClear(GL_DEPTH_BUFFER_BIT);
	glScissor(10, 11, 20, 30);
	glEnable(GL_SCISSOR_TEST);
	glColorMask(GL_FALSE, GL_TRUE, GL_TRUE, GL_FALSE);
	glClearColor(1, 2, 3, 4);
	glClearDepth(.5);
	glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
	pass = kb_expect_only_rect(&kb, 0, 10, 11, 20, 30, inside, outside);
	pass = piglit_probe_rect_depth(10, 11, 20, 30, .5) && pass;
	pass = piglit_probe_rect_depth(0, 0, 10, W, 1) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
clear_texture(void *data)
{
	static const float inside[4] = { 1, 2, 3, 4 }, outside[4];
	struct kb kb = make(GL_RGBA32F, 1, 0);

	if (!piglit_is_extension_supported("GL_ARB_clear_texture"))
		return PIGLIT_SKIP;
	glClearTexSubImage(kb.tex[0], 0, 3, 4, 0, 10, 20, 1, GL_RGBA, GL_FLOAT,
			   inside);
	return kb_expect_only_rect(&kb, 0, 3, 4, 10, 20, inside, outside) ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

struct blit { GLenum from, to, filter; int size; };

/** Plain, converting and scaling blits. */
static enum piglit_result
blit(void *data)
{
	const struct blit *t = data;
	struct kb from = kb_create(t->from, 1, 0, W, W);
	struct kb to = make(t->to, 1, 0);
	const float outside[4] = { 0 };
	float value[4] = { .2, .4, .6, .8 };
	float *got;
	bool pass = true;

	kb_fill(&from, 0, value[0], value[1], value[2], value[3]);
	glBindFramebuffer(GL_READ_FRAMEBUFFER, from.fbo);
	glBlitFramebuffer(0, 0, W, W, 8, 8, 8 + t->size, 8 + t->size,
			  GL_COLOR_BUFFER_BIT, t->filter);
	got = kb_read(&to, 0);
	for (int i = 0; i < W * W * 4 && pass; i++) {
		const int x = i / 4 % W, y = i / 4 / W;
		const bool in = x >= 8 && x < 8 + t->size && y >= 8 &&
			y < 8 + t->size;

		pass = fabsf(got[i] - (in ? value : outside)[i % 4]) <=
			1e-6f;
		if (!pass)
			printf("(%d, %d): %g\n", x, y, got[i]);
	}
	free(got);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static const struct blit
plain = { GL_RGBA32F, GL_RGBA32F, GL_NEAREST, 64 - 16 },
scaling = { GL_RGBA32F, GL_RGBA32F, GL_LINEAR, 21 },
/* 51, 102, 153, 204 of 255 */
converting = { GL_RGBA32F, GL_RGBA8, GL_NEAREST, 40 },
converting_back = { GL_RGBA8, GL_RGBA32F, GL_NEAREST, 40 };

static enum piglit_result
blit_depth(void *data)
{
	struct kb from = kb_create(GL_RGBA32F, 1, 0, W, W), to;
	bool pass;

	kb_attach_depth(&from, GL_DEPTH_COMPONENT24);
	glClearDepth(.25);
	glClear(GL_DEPTH_BUFFER_BIT);
	to = make(GL_RGBA32F, 1, 0);
	kb_attach_depth(&to, GL_DEPTH_COMPONENT24);
	glClearDepth(1);
	glClear(GL_DEPTH_BUFFER_BIT);
	glBindFramebuffer(GL_READ_FRAMEBUFFER, from.fbo);
	glBlitFramebuffer(0, 0, W, W, 0, 0, W, W, GL_DEPTH_BUFFER_BIT,
			  GL_NEAREST);
	glBindFramebuffer(GL_READ_FRAMEBUFFER, to.fbo);
	pass = piglit_probe_rect_depth(0, 0, W, W, .25);
	pass = kb_expect(&to, 0, 0, 0, 0, 0, 0) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Conversions that drivers do by drawing. */
static enum piglit_result
read_pixels(void *data)
{
	struct kb kb = make(GL_RGBA32F, 1, 0);
	GLubyte *bytes = malloc(W * W * 4);
	float *floats = malloc(W * W * 16);
	GLuint pbo;
	bool pass = true;

	kb_fill(&kb, 0, .2, .4, .6, .8);
	glReadPixels(0, 0, W, W, GL_BGRA, GL_UNSIGNED_BYTE, bytes);
	for (int i = 0; i < W * W; i++)
		pass = bytes[4 * i] == 153 && bytes[4 * i + 1] == 102 &&
			bytes[4 * i + 2] == 51 && bytes[4 * i + 3] == 204 &&
			pass;
	glGenBuffers(1, &pbo);
	glBindBuffer(GL_PIXEL_PACK_BUFFER, pbo);
	glBufferData(GL_PIXEL_PACK_BUFFER, W * W * 16, NULL, GL_STREAM_READ);
	glReadPixels(0, 0, W, W, GL_RGBA, GL_FLOAT, NULL);
	glGetBufferSubData(GL_PIXEL_PACK_BUFFER, 0, W * W * 16, floats);
	glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
	for (int i = 0; i < W * W; i++)
		pass = floats[4 * i] == .2f && floats[4 * i + 3] == .8f && pass;
	pass = kb_expect(&kb, 0, 0, .2, .4, .6, .8) && pass;
	free(bytes);
	free(floats);
	glDeleteBuffers(1, &pbo);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** From a buffer object uploads are draws in the state tracker. */
static enum piglit_result
upload_from_buffer(void *data)
{
	struct kb kb = make(GL_RGBA32F, 1, 0);
	float *floats = malloc(W * W * 16);
	GLuint pbo, tex;
	struct kb target;

	for (int i = 0; i < W * W * 4; i++)
		floats[i] = i % 4 + 1;
	glGenBuffers(1, &pbo);
	glBindBuffer(GL_PIXEL_UNPACK_BUFFER, pbo);
	glBufferData(GL_PIXEL_UNPACK_BUFFER, W * W * 16, floats,
		     GL_STREAM_DRAW);
	target = kb;
	target.format = GL_RGBA16F;
	glGenTextures(1, &tex);
	target.tex[0] = tex;
	glBindTexture(GL_TEXTURE_2D, tex);
	glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, W, W, 0, GL_RGBA, GL_FLOAT,
		     NULL);
	glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, W, W, GL_RGBA, GL_FLOAT, NULL);
	glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
	bool pass = kb_expect(&target, 0, 0, 1, 2, 3, 4) &&
		kb_expect(&kb, 0, 0, 0, 0, 0, 0);
	glDeleteTextures(1, &tex);
	glDeleteBuffers(1, &pbo);
	free(floats);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
copy_tex_image(void *data)
{
	struct kb kb = make(GL_RGBA32F, 1, 0), copy = kb;
	GLuint tex;
	bool pass;

	kb_fill(&kb, 0, .2, .4, .6, .8);
	glGenTextures(1, &tex);
	copy.tex[0] = tex;
	glBindTexture(GL_TEXTURE_2D, tex);
	glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 0, 0, W, W, 0);
	pass = kb_expect(&copy, 0, 1e-6, .2, .4, .6, .8);
	kb_fill(&kb, 0, .8, .6, .4, .2);
	glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 0, 0, W, W / 2);
	pass = kb_expect_rect(&copy, 0, 0, 0, W, W / 2, 1e-6, .8, .6, .4, .2)
		&& pass;
	pass = kb_expect_rect(&copy, 0, 0, W / 2, W, W / 2, 1e-6, .2, .4, .6,
			      .8) && pass;
	glDeleteTextures(1, &tex);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
generate_mipmap(void *data)
{
	struct kb kb = make(GL_RGBA32F, 1, 0);
	float *got = malloc(W * W * 4);
	bool pass = true;

	kb_fill(&kb, 0, 1, 2, 3, 4);
	glBindTexture(GL_TEXTURE_2D, kb.tex[0]);
	glGenerateMipmap(GL_TEXTURE_2D);
	for (int level = 1; level <= 6; level++) {
		glGetTexImage(GL_TEXTURE_2D, level, GL_RGBA, GL_FLOAT, got);
		for (int i = 0; i < (W >> level) * (W >> level) * 4; i++)
			pass = got[i] == i % 4 + 1 && pass;
	}
	pass = kb_expect(&kb, 0, 0, 1, 2, 3, 4) && pass;
	free(got);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("Clear", clear, 0),
	KB_SUBTEST("Clear-layers", clear, 3),
	KB_SUBTEST("Clear-partial", partial_clear, NULL),
	KB_SUBTEST("ClearTexSubImage", clear_texture, NULL),
	KB_SUBTEST("BlitFramebuffer", blit, &plain),
	KB_SUBTEST("BlitFramebuffer-scaling", blit, &scaling),
	KB_SUBTEST("BlitFramebuffer-to-rgba8", blit, &converting),
	KB_SUBTEST("BlitFramebuffer-from-rgba8", blit, &converting_back),
	KB_SUBTEST("BlitFramebuffer-depth", blit_depth, NULL),
	KB_SUBTEST("ReadPixels", read_pixels, NULL),
	KB_SUBTEST("TexSubImage-from-buffer", upload_from_buffer, NULL),
	KB_SUBTEST("CopyTexImage", copy_tex_image, NULL),
	KB_SUBTEST("GenerateMipmap", generate_mipmap, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
