/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-pixels.c
 * DrawPixels, Bitmap and CopyPixels of colors make fragments and so run the
 * program; of depth and stencil they do as ever.
 */

#include "kbuffer-common.h"

#define W 32

static const float zero[4];

static struct kb
make(void)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);

	/* Accumulates, so that a second run would show. */
	kb_program("MAD result.kbuffer[0], fragment.color, 10, kbuffer[0];");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	return kb;
}

static enum piglit_result
draw_pixels(void *data)
{
	static const float inside[4] = { 10, 5, 2.5, 10 };
	struct kb kb = make();
	float pixels[8 * 8][4];

	for (int i = 0; i < 64; i++)
		memcpy(pixels[i], (float[4]) { 1, .5, .25, 1 }, 16);
	glWindowPos2i(4, 6);
	glDrawPixels(8, 8, GL_RGBA, GL_FLOAT, pixels);
	return kb_expect_only_rect(&kb, 0, 4, 6, 8, 8, inside, zero) ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
draw_pixels_zoomed(void *data)
{
	static const float inside[4] = { 10, 10, 10, 10 };
	struct kb kb = make();
	float pixels[4 * 4 * 4];

	for (int i = 0; i < 64; i++)
		pixels[i] = 1;
	glWindowPos2i(4, 6);
	glPixelZoom(3, 2);
	glDrawPixels(4, 4, GL_RGBA, GL_FLOAT, pixels);
	glPixelZoom(1, 1);
	return kb_expect_only_rect(&kb, 0, 4, 6, 12, 8, inside, zero) ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
bitmap(void *data)
{
	static const float inside[4] = { 10, 5, 2.5, 10 };
	struct kb kb = make();
	GLubyte bits[8];

	memset(bits, 255, sizeof(bits));
	glColor4f(1, .5, .25, 1);
	glWindowPos2i(4, 6);
	glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
	glBitmap(8, 8, 0, 0, 0, 0, bits);
	glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
	return kb_expect_only_rect(&kb, 0, 4, 6, 8, 8, inside, zero) ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

/**
 * Bitmaps are gathered before they are drawn: those before a change of the
 * stage or its program are drawn with the old state.
 */
static enum piglit_result
bitmap_and_state_change(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	GLubyte bits[8];
	bool pass;

	memset(bits, 255, sizeof(bits));
	glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
	glColor4f(1, 1, 1, 1);
	glWindowPos2i(0, 0);
	glBitmap(8, 8, 0, 0, 8, 0, bits);
	kb_program("MOV result.kbuffer[0], 2;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	glBitmap(8, 8, 0, 0, 8, 0, bits);
	kb_program("MOV result.kbuffer[0], 3;");
	glBitmap(8, 8, 0, 0, 8, 0, bits);
	kb_program("MOV result.kbuffer[0], program.env[0];");
	glProgramEnvParameter4fARB(GL_KBUFFER_PROGRAM_MESA, 0, 4, 4, 4, 4);
	glBitmap(8, 8, 0, 0, -24, 8, bits);
	glProgramEnvParameter4fARB(GL_KBUFFER_PROGRAM_MESA, 0, 5, 5, 5, 5);
	glBitmap(8, 8, 0, 0, 8, 0, bits);
	glDisable(GL_KBUFFER_PROGRAM_MESA);
	glBitmap(8, 8, 0, 0, 8, 0, bits);
	glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
	pass = kb_expect_rect(&kb, 0, 0, 0, 8, 8, 0, 1, 1, 1, 1);
	pass = kb_expect_rect(&kb, 0, 8, 0, 8, 8, 0, 2, 2, 2, 2) && pass;
	pass = kb_expect_rect(&kb, 0, 16, 0, 8, 8, 0, 3, 3, 3, 3) && pass;
	pass = kb_expect_rect(&kb, 0, 24, 0, 8, 8, 0, 4, 4, 4, 4) && pass;
	pass = kb_expect_rect(&kb, 0, 0, 8, 8, 8, 0, 5, 5, 5, 5) && pass;
	pass = kb_expect_rect(&kb, 0, 8, 8, 8, 8, 0, 1, 1, 1, 1) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
copy_pixels(void *data)
{
	struct kb kb = make();
	bool pass;

	kb_fill(&kb, 0, .5, .25, 1, 0);
	glWindowPos2i(16, 0);
	glCopyPixels(0, 0, 8, 8, GL_COLOR);
	pass = kb_expect_rect(&kb, 0, 16, 0, 8, 8, 0, 5.5, 2.75, 11, 0);
	pass = kb_expect_rect(&kb, 0, 0, 0, 16, W, 0, .5, .25, 1, 0) && pass;
	pass = kb_expect_rect(&kb, 0, 16, 8, 16, 8, 0, .5, .25, 1, 0) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
draw_depth(void *data)
{
	struct kb kb = make();
	float depth[64];
	bool pass;

	for (int i = 0; i < 64; i++)
		depth[i] = .25;
	kb_attach_depth(&kb, GL_DEPTH_COMPONENT32F);
	glClearDepth(1);
	glClear(GL_DEPTH_BUFFER_BIT);
	kb_fill(&kb, 0, 1, 2, 3, 4);
	/* Fragments of the current color and these depths. */
	glColor4f(0, 0, 0, 0);
	glEnable(GL_DEPTH_TEST);
	glWindowPos2i(4, 6);
	glDrawPixels(8, 8, GL_DEPTH_COMPONENT, GL_FLOAT, depth);
	pass = piglit_probe_rect_depth(4, 6, 8, 8, .25);
	pass = piglit_probe_rect_depth(0, 0, 4, W, 1) && pass;
	/* 10 times black was added. */
	pass = kb_expect(&kb, 0, 0, 1, 2, 3, 4) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
draw_stencil(void *data)
{
	struct kb kb = make();
	GLubyte stencil[64];
	GLuint rb;
	bool pass;

	memset(stencil, 9, sizeof(stencil));
	glGenRenderbuffers(1, &rb);
	glBindRenderbuffer(GL_RENDERBUFFER, rb);
	glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, W, W);
	glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT,
				  GL_RENDERBUFFER, rb);
	glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
	kb_fill(&kb, 0, 1, 2, 3, 4);
	glWindowPos2i(4, 6);
	glDrawPixels(8, 8, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, stencil);
	pass = piglit_probe_rect_stencil(4, 6, 8, 8, 9);
	pass = piglit_probe_rect_stencil(0, 0, 4, W, 0) && pass;
	pass = kb_expect(&kb, 0, 0, 1, 2, 3, 4) && pass;
	glDeleteRenderbuffers(1, &rb);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("DrawPixels", draw_pixels, NULL),
	KB_SUBTEST("DrawPixels-zoomed", draw_pixels_zoomed, NULL),
	KB_SUBTEST("DrawPixels-depth", draw_depth, NULL),
	KB_SUBTEST("DrawPixels-stencil", draw_stencil, NULL),
	KB_SUBTEST("Bitmap", bitmap, NULL),
	KB_SUBTEST("Bitmap-and-state-change", bitmap_and_state_change, NULL),
	KB_SUBTEST("CopyPixels", copy_pixels, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
