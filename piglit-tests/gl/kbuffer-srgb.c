/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-srgb.c
 * Entries of an sRGB format are decoded when read and encoded when written
 * while GL_FRAMEBUFFER_SRGB is enabled, as blending does, and taken as they
 * are otherwise.  Alpha is always linear.
 */

#include "kbuffer-common.h"

#define W 16            /* 16 * 16: every byte once */

/** Pixel i holds the bytes i, 255 - i, i / 2, i. */
static void
upload_bytes(const struct kb *kb)
{
	GLubyte bytes[W * W][4];

	for (int i = 0; i < W * W; i++) {
		bytes[i][0] = i;
		bytes[i][1] = 255 - i;
		bytes[i][2] = i / 2;
		bytes[i][3] = i;
	}
	glBindTexture(GL_TEXTURE_2D, kb->tex[0]);
	glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, W, W, GL_RGBA,
			GL_UNSIGNED_BYTE, bytes);
	glBindTexture(GL_TEXTURE_2D, 0);
}

static void
download_bytes(const struct kb *kb, GLubyte bytes[][4])
{
	glBindTexture(GL_TEXTURE_2D, kb->tex[0]);
	glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, bytes);
	glBindTexture(GL_TEXTURE_2D, 0);
}

/** The sRGB texture is entry 1 of a framebuffer whose entry 0 is RGBA32F. */
static struct kb
make(struct kb *srgb, bool enabled)
{
	struct kb raw;

	*srgb = kb_create(GL_SRGB8_ALPHA8, 1, 0, W, W);
	upload_bytes(srgb);
	raw = kb_create(GL_RGBA32F, 1, 0, W, W);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1,
			     srgb->tex[0], 0);
	glDrawBuffers(2, (GLenum[]) { GL_COLOR_ATTACHMENT0,
				      GL_COLOR_ATTACHMENT1 });
	if (enabled)
		glEnable(GL_FRAMEBUFFER_SRGB);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	return raw;
}

/** What the program reads of each byte. */
static enum piglit_result
reads(void *data)
{
	const bool enabled = data != NULL;
	struct kb srgb, raw = make(&srgb, enabled);
	GLubyte bytes[W * W][4];
	float *got;
	bool pass = true;

	download_bytes(&srgb, bytes);
	kb_program("MOV result.kbuffer[0], kbuffer[1];");
	kb_draw(&raw);
	got = kb_read(&raw, 0);
	for (int i = 0; i < W * W * 4 && pass; i++) {
		const float byte = bytes[i / 4][i % 4] / 255.0;
		const float wanted = enabled && i % 4 < 3 ?
			piglit_srgb_to_linear(byte) : byte;
		/* Where decoded, llvmpipe computes a polynomial whose error
		 * must not show in a byte: half a step in encoded space,
		 * whose slope is at most 2.2 (d/dx x^2.2 at 1). */
		const float tolerance = enabled && i % 4 < 3 ?
			2.2f * 0.5f / 255 : 1e-7f;

		pass = fabsf(got[i] - wanted) <= tolerance;
		if (!pass)
			printf("component %d of byte %d reads as %.9g, "
			       "expected %.9g\n", i % 4, bytes[i / 4][i % 4],
			       got[i], wanted);
	}
	free(got);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** A copy onto itself changes no byte. */
static enum piglit_result
copies(void *data)
{
	struct kb srgb, raw = make(&srgb, data != NULL);
	GLubyte before[W * W][4], after[W * W][4];

	download_bytes(&srgb, before);
	kb_program("MOV result.kbuffer[1], kbuffer[1];");
	for (int i = 0; i < 5; i++)
		kb_draw(&raw);
	download_bytes(&srgb, after);
	for (int i = 0; i < W * W * 4; i++) {
		if (before[i / 4][i % 4] == after[i / 4][i % 4])
			continue;
		printf("component %d: byte %d became %d\n", i % 4,
		       before[i / 4][i % 4], after[i / 4][i % 4]);
		return PIGLIT_FAIL;
	}
	return PIGLIT_PASS;
}

/** Linear values 0, 1/255, ... 1 by position are stored encoded or not. */
static enum piglit_result
writes(void *data)
{
	const bool enabled = data != NULL;
	struct kb srgb, raw = make(&srgb, enabled);
	GLubyte got[W * W][4];
	bool pass = true;

	/* i / 255 with i = 16 (y - .5) + (x - .5). */
	kb_program("PARAM p = { 16, 1, -8.5, 0.003921568627450980 };\nTEMP t;\n"
		   "MAD t.x, fragment.position.y, p.x, fragment.position.x;\n"
		   "ADD t.x, t.x, p.z;\nMUL result.kbuffer[1], t.x, p.w;");
	kb_draw(&raw);
	download_bytes(&srgb, got);
	for (int i = 0; i < W * W * 4 && pass; i++) {
		const float linear = (i / 4) / 255.0;
		const float wanted = 255 * (enabled && i % 4 < 3 ?
			piglit_linear_to_srgb(linear) : linear);

		/* The nearest byte is .5 of a step off at most.  D3D10
		 * allows .6, which llvmpipe means to keep, but with and
		 * without the program it is .621 for 6/255. */
		pass = fabsf(got[i / 4][i % 4] - wanted) <= 0.63f;
		if (!pass)
			printf("component %d of %d/255 is stored as %d, "
			       "expected %g\n", i % 4, i / 4,
			       got[i / 4][i % 4], wanted);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/**
 * The same bytes as a plain draw of the same values gives.  By the program they
 * come from the other color, which a draw without it would leave in entry 0.
 */
static enum piglit_result
as_plain_draw(void *data)
{
	static const char plain_fp[] = "!!ARBfp1.0\n"
		"OPTION ARB_draw_buffers;\n"
		"PARAM p = { 16, 1, -8.5, 0.003921568627450980 };\nTEMP t;\n"
		"MAD t.x, fragment.position.y, p.x, fragment.position.x;\n"
		"ADD t.x, t.x, p.z;\nMUL t, t.x, p.w;\n"
		"MOV result.color[0], 0;\nMOV result.color[1], t;\nEND\n";
	static const char fp[] = "!!ARBfp1.0\nOPTION ARB_draw_buffers;\n"
		"PARAM p = { 16, 1, -8.5, 0.003921568627450980 };\nTEMP t;\n"
		"MAD t.x, fragment.position.y, p.x, fragment.position.x;\n"
		"ADD t.x, t.x, p.z;\nMUL t, t.x, p.w;\n"
		"MOV result.color[0], t;\nMOV result.color[1], 0;\nEND\n";
	struct kb srgb, raw = make(&srgb, data != NULL);
	GLubyte plain[W * W][4], got[W * W][4];

	kb_fragment_value(0, 0, 0, 0);
	if (kb_load(GL_FRAGMENT_PROGRAM_ARB, plain_fp, strlen(plain_fp)))
		return PIGLIT_FAIL;
	glDisable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&raw);
	download_bytes(&srgb, plain);

	upload_bytes(&srgb);
	if (kb_load(GL_FRAGMENT_PROGRAM_ARB, fp, strlen(fp)))
		return PIGLIT_FAIL;
	kb_program("MOV result.kbuffer[1], fragment.color[0];");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&raw);
	download_bytes(&srgb, got);
	for (int i = 0; i < W * W * 4; i++) {
		if (plain[i / 4][i % 4] == got[i / 4][i % 4])
			continue;
		printf("%d/255, component %d: drawn %d, by the program %d\n",
		       i / 4, i % 4, plain[i / 4][i % 4], got[i / 4][i % 4]);
		return PIGLIT_FAIL;
	}
	return PIGLIT_PASS;
}

/** The program's mean with a color equals that of blending. */
static enum piglit_result
as_blending(void *data)
{
	struct kb srgb, raw = make(&srgb, data != NULL);
	GLubyte blended[W * W][4], got[W * W][4];

	kb_fragment_value(.2, .4, .6, .5);
	glDrawBuffers(2, (GLenum[]) { GL_NONE, GL_COLOR_ATTACHMENT1 });
	kb_fragment_values((const float[2][4]) { { 0 }, { .2, .4, .6, .5 } },
			   2);
	glDisable(GL_KBUFFER_PROGRAM_MESA);
	glEnable(GL_BLEND);
	glBlendColor(.5, .5, .5, .5);
	glBlendFunc(GL_CONSTANT_COLOR, GL_CONSTANT_COLOR);
	kb_draw(&raw);
	download_bytes(&srgb, blended);
	glDisable(GL_BLEND);

	upload_bytes(&srgb);
	kb_program("TEMP t;\nADD t, kbuffer[1], fragment.color[1];\n"
		   "MUL result.kbuffer[1], t, 0.5;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&raw);
	download_bytes(&srgb, got);
	for (int i = 0; i < W * W * 4; i++) {
		if (abs(blended[i / 4][i % 4] - got[i / 4][i % 4]) <= 1)
			continue;
		printf("pixel %d, component %d: blending gives %d, the "
		       "program %d\n", i / 4, i % 4, blended[i / 4][i % 4],
		       got[i / 4][i % 4]);
		return PIGLIT_FAIL;
	}
	return PIGLIT_PASS;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("enabled-reads", reads, "on"),
	KB_SUBTEST("enabled-copies", copies, "on"),
	KB_SUBTEST("enabled-writes", writes, "on"),
	KB_SUBTEST("enabled-as-plain-draw", as_plain_draw, "on"),
	KB_SUBTEST("enabled-as-blending", as_blending, "on"),
	KB_SUBTEST("disabled-reads", reads, NULL),
	KB_SUBTEST("disabled-copies", copies, NULL),
	KB_SUBTEST("disabled-writes", writes, NULL),
	KB_SUBTEST("disabled-as-plain-draw", as_plain_draw, NULL),
	KB_SUBTEST("disabled-as-blending", as_blending, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
