/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-framebuffer-fetch-formats.c
 * The formats of VK-GL-CTS's framebuffer_fetch.framebuffer_format group: a
 * color is added to the entry by the program.  Where the format is of integers
 * drawing is an error and the texture keeps its contents.
 */

#include "kbuffer-common.h"

#define W 16

enum kind { UNORM, SRGB, FLOAT, INT, UINT };

struct format {
	GLenum format;
	enum kind kind;
	/** Of red, green, blue, alpha; 0: missing. */
	int bits[4];
};

/** Between 0 and 1, as CTS's: what is there and what is added. */
static const double before[4] = { .5, .125, 0, .25 };
static const double color[4] = { .125, .25, .5, .25 };

static double
decode(double s)
{
	return s <= .04045 ? s / 12.92 : pow((s + .055) / 1.055, 2.4);
}

static double
encode(double l)
{
	return l <= .0031308 ? l * 12.92 : 1.055 * pow(l, 1 / 2.4) - .055;
}

/** A value that the format holds. */
static double
nearest(const struct format *f, int c, double value)
{
	const double max = (1u << f->bits[c]) - 1;

	/* The floats here are exact in six bits of mantissa, and in 5. */
	return f->kind == FLOAT ? value : rint(value * max) / max;
}

static enum piglit_result
sum(const struct format *f)
{
	struct kb kb = kb_create(f->format, 1, 0, W, W);
	float first[4], added[4], *got;
	double wanted[4], tolerance[4];
	bool pass = true;

	for (int c = 0; c < 4; c++) {
		first[c] = f->bits[c] ? nearest(f, c, before[c]) : 0;
		added[c] = f->bits[c] ? nearest(f, c, color[c]) : color[c];
		wanted[c] = first[c] + added[c];
		/* Codes are added to codes: half a code is never near.  What
		 * is read back is a code, rounded to single precision. */
		tolerance[c] = f->kind == FLOAT ? 0 : ldexp(1, -23);
		if (f->kind == SRGB && c < 3) {
			wanted[c] = encode(decode(first[c]) + added[c]);
			/* Rounding to a byte, and an encoding that may be
			 * half a byte off as GL 4.5, 17.3.9, allows. */
			tolerance[c] = 1 / 255.;
		}
		if (!f->bits[c])
			wanted[c] = c == 3;
	}
	kb_fill(&kb, 0, first[0], first[1], first[2], first[3]);
	kb_fragment_value(added[0], added[1], added[2], added[3]);
	kb_program("ADD result.kbuffer[0], kbuffer[0], fragment.color;");
	glEnable(GL_FRAMEBUFFER_SRGB);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	got = kb_read(&kb, 0);
	for (int i = 0; i < W * W * 4 && pass; i++) {
		const int c = i % 4;

		pass = fabs(got[i] - wanted[c]) <= tolerance[c];
		if (!pass)
			printf("component %d: %.8g, expected %.8g\n", c, got[i],
			       wanted[c]);
	}
	free(got);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** An integer of a shader can be drawn there, but not by a k-buffer program. */
static enum piglit_result
refused(const struct format *f)
{
	static const char vs[] = "#version 130\n"
		"void main() { gl_Position = gl_Vertex; }\n";
	const GLuint tex = kb_new_texture(), fbo = kb_new_framebuffer();
	const GLint fill[4] = { 1, 2, 3, 1 };
	GLint got[W * W][4];
	bool pass;

	glBindTexture(GL_TEXTURE_2D, tex);
	glTexImage2D(GL_TEXTURE_2D, 0, f->format, W, W, 0, GL_RGBA_INTEGER,
		     GL_INT, NULL);
	glBindFramebuffer(GL_FRAMEBUFFER, fbo);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, tex, 0);
	if (f->kind == INT)
		glClearBufferiv(GL_COLOR, 0, fill);
	else
		glClearBufferuiv(GL_COLOR, 0, (const GLuint *)fill);
	glViewport(0, 0, W, W);
	kb_program("ADD result.kbuffer[0], kbuffer[0], fragment.color;");
	kb_use_glsl(vs, NULL, f->kind == INT ?
		    "#version 130\nout ivec4 a;\nvoid main() { a = ivec4(0); }\n" :
		    "#version 130\nout uvec4 a;\nvoid main() { a = uvec4(0u); }\n");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	glRectf(-1, -1, 1, 1);
	pass = piglit_check_gl_error(GL_INVALID_OPERATION);
	glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA_INTEGER, GL_INT, got);
	for (int i = 0; i < W * W * 4; i++) {
		const int c = i % 4;
		const GLint wanted = f->bits[c] ? fill[c] : c == 3;

		if (got[i / 4][c] != wanted) {
			printf("component %d: %d, expected %d\n", c,
			       got[i / 4][c], wanted);
			return PIGLIT_FAIL;
		}
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
test_format(void *data)
{
	const struct format *f = data;

	return f->kind == INT || f->kind == UINT ? refused(f) : sum(f);
}

#define FORMAT(name, internal, kind, ...) \
	KB_SUBTEST(name, test_format, \
		   (&(struct format) { internal, kind, { __VA_ARGS__ } }))

const struct piglit_subtest kbuffer_subtests[] = {
	FORMAT("rgba32i", GL_RGBA32I, INT, 32, 32, 32, 32),
	FORMAT("rgba32ui", GL_RGBA32UI, UINT, 32, 32, 32, 32),
	FORMAT("rgba16i", GL_RGBA16I, INT, 16, 16, 16, 16),
	FORMAT("rgba16ui", GL_RGBA16UI, UINT, 16, 16, 16, 16),
	FORMAT("rgba8", GL_RGBA8, UNORM, 8, 8, 8, 8),
	FORMAT("rgba8i", GL_RGBA8I, INT, 8, 8, 8, 8),
	FORMAT("rgba8ui", GL_RGBA8UI, UINT, 8, 8, 8, 8),
	FORMAT("srgb8_alpha8", GL_SRGB8_ALPHA8, SRGB, 8, 8, 8, 8),
	FORMAT("rgb10_a2", GL_RGB10_A2, UNORM, 10, 10, 10, 2),
	FORMAT("rgb10_a2ui", GL_RGB10_A2UI, UINT, 10, 10, 10, 2),
	FORMAT("rgba4", GL_RGBA4, UNORM, 4, 4, 4, 4),
	FORMAT("rgb5_a1", GL_RGB5_A1, UNORM, 5, 5, 5, 1),
	FORMAT("rgb8", GL_RGB8, UNORM, 8, 8, 8),
	FORMAT("rgb565", GL_RGB565, UNORM, 5, 6, 5),
	FORMAT("rg32i", GL_RG32I, INT, 32, 32),
	FORMAT("rg32ui", GL_RG32UI, UINT, 32, 32),
	FORMAT("rg16i", GL_RG16I, INT, 16, 16),
	FORMAT("rg16ui", GL_RG16UI, UINT, 16, 16),
	FORMAT("rg8", GL_RG8, UNORM, 8, 8),
	FORMAT("rg8i", GL_RG8I, INT, 8, 8),
	FORMAT("rg8ui", GL_RG8UI, UINT, 8, 8),
	FORMAT("r32i", GL_R32I, INT, 32),
	FORMAT("r32ui", GL_R32UI, UINT, 32),
	FORMAT("r16i", GL_R16I, INT, 16),
	FORMAT("r16ui", GL_R16UI, UINT, 16),
	FORMAT("r8", GL_R8, UNORM, 8),
	FORMAT("r8i", GL_R8I, INT, 8),
	FORMAT("r8ui", GL_R8UI, UINT, 8),
	FORMAT("rgba32f", GL_RGBA32F, FLOAT, 32, 32, 32, 32),
	FORMAT("rgba16f", GL_RGBA16F, FLOAT, 16, 16, 16, 16),
	FORMAT("r11f_g11f_b10f", GL_R11F_G11F_B10F, FLOAT, 11, 11, 10),
	FORMAT("rg32f", GL_RG32F, FLOAT, 32, 32),
	FORMAT("rg16f", GL_RG16F, FLOAT, 16, 16),
	FORMAT("r32f", GL_R32F, FLOAT, 32),
	FORMAT("r16f", GL_R16F, FLOAT, 16),
	FORMAT("rgb16f", GL_RGB16F, FLOAT, 16, 16, 16),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
