/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-formats.c
 * Every floating-point and normalized color format that can be rendered to:
 * what the program reads is the texel, what it computes is rounded into the
 * format, what it copies does not change, and a component that the format
 * lacks reads as 0, alpha as 1.
 */

#include "kbuffer-common.h"

#define W 64
#define N (W * W)

enum kind { UNORM, SNORM, FLOAT };

struct format {
	const char *name;
	GLenum format;
	enum kind kind;
	/* Of red, green, blue, alpha; mantissa bits of floats; 0: missing. */
	int bits[4];
	bool optional;
};

static const struct format formats[] = {
	{ "r8", GL_R8, UNORM, { 8 } },
	{ "rg8", GL_RG8, UNORM, { 8, 8 } },
	{ "rgb8", GL_RGB8, UNORM, { 8, 8, 8 } },
	{ "rgba8", GL_RGBA8, UNORM, { 8, 8, 8, 8 } },
	{ "rgba4", GL_RGBA4, UNORM, { 4, 4, 4, 4 } },
	{ "rgb5-a1", GL_RGB5_A1, UNORM, { 5, 5, 5, 1 } },
	{ "rgb565", GL_RGB565, UNORM, { 5, 6, 5 } },
	{ "rgb10-a2", GL_RGB10_A2, UNORM, { 10, 10, 10, 2 } },
	{ "r16", GL_R16, UNORM, { 16 } },
	{ "rg16", GL_RG16, UNORM, { 16, 16 } },
	{ "rgb16", GL_RGB16, UNORM, { 16, 16, 16 }, true },
	{ "rgba16", GL_RGBA16, UNORM, { 16, 16, 16, 16 } },
	{ "r8-snorm", GL_R8_SNORM, SNORM, { 8 }, true },
	{ "rg8-snorm", GL_RG8_SNORM, SNORM, { 8, 8 }, true },
	{ "rgba8-snorm", GL_RGBA8_SNORM, SNORM, { 8, 8, 8, 8 }, true },
	{ "r16-snorm", GL_R16_SNORM, SNORM, { 16 }, true },
	{ "rg16-snorm", GL_RG16_SNORM, SNORM, { 16, 16 }, true },
	{ "rgba16-snorm", GL_RGBA16_SNORM, SNORM, { 16, 16, 16, 16 }, true },
	{ "r16f", GL_R16F, FLOAT, { 10 } },
	{ "rg16f", GL_RG16F, FLOAT, { 10, 10 } },
	{ "rgb16f", GL_RGB16F, FLOAT, { 10, 10, 10 }, true },
	{ "rgba16f", GL_RGBA16F, FLOAT, { 10, 10, 10, 10 } },
	{ "r32f", GL_R32F, FLOAT, { 23 } },
	{ "rg32f", GL_RG32F, FLOAT, { 23, 23 } },
	{ "rgb32f", GL_RGB32F, FLOAT, { 23, 23, 23 }, true },
	{ "rgba32f", GL_RGBA32F, FLOAT, { 23, 23, 23, 23 } },
	{ "r11f-g11f-b10f", GL_R11F_G11F_B10F, FLOAT, { 6, 6, 5 } },
};

/** What the format holds of a value, and how far off rounding may be. */
static double
nearest(const struct format *f, int c, double value, double *tolerance)
{
	if (!f->bits[c]) {
		*tolerance = 0;
		return c == 3;
	}
	if (f->kind == FLOAT) {
		/* To nearest is half a unit in the last place; Mesa's
		 * conversions to 16 bits and fewer may truncate, so a whole
		 * one is allowed there. */
		const double ulp = ldexp(fabs(value), -f->bits[c]);

		/* The packed floats have no sign. */
		if (f->format == GL_R11F_G11F_B10F && value < 0)
			value = 0;
		*tolerance = f->bits[c] < 23 ? ulp : ulp / 2;
		return value;
	} else {
		const double max = (1 << (f->bits[c] - (f->kind == SNORM))) - 1;
		const double low = f->kind == SNORM ? -1 : 0;

		/* Half a step, but a whole one where components are packed:
		 * GL prefers the nearest value but allows its neighbor, which
		 * llvmpipe may store there.  It is the one that is stored
		 * without the program, see kbuffer-conversion.c.  2^-22 is for
		 * a product and two conversions in single precision. */
		*tolerance = (f->bits[c] % 8 ? 1 : .5) / max + ldexp(1, -22);
		return MAX2(low, MIN2(1, value));
	}
}

/** A value in the format's range, of all magnitudes for floats. */
static float
some_value(const struct format *f, int i)
{
	const double t = (i * 2654435761u >> 8) / 16777216.0;

	if (f->kind == UNORM)
		return t;
	if (f->kind == SNORM)
		return 2 * t - 1;
	return ldexp(1 + t, i % 20 - 10) *
		(i % 2 && f->format != GL_R11F_G11F_B10F ? -1 : 1);
}

static struct kb
make(const struct format *f)
{
	struct kb kb = { .format = GL_NONE };
	GLuint tex, fbo;
	GLenum status;

	/* Optional formats need not be renderable. */
	glGenFramebuffers(1, &fbo);
	glGenTextures(1, &tex);
	glBindTexture(GL_TEXTURE_2D, tex);
	glTexImage2D(GL_TEXTURE_2D, 0, f->format, W, W, 0, GL_RGBA, GL_FLOAT,
		     NULL);
	glBindFramebuffer(GL_FRAMEBUFFER, fbo);
	glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
			       GL_TEXTURE_2D, tex, 0);
	status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
	glDeleteFramebuffers(1, &fbo);
	glDeleteTextures(1, &tex);
	if (f->optional && status != GL_FRAMEBUFFER_COMPLETE) {
		printf("%s cannot be rendered to, and need not\n", f->name);
		return kb;
	}
	return kb_create(f->format, 1, 0, W, W);
}

static enum piglit_result
test_format(void *data)
{
	const struct format *f = data;
	struct kb kb = make(f), raw;
	float *values = malloc(N * 16), *before, *read, *after;
	bool pass = true;

	if (!kb.format)
		return PIGLIT_PASS;
	for (int i = 0; i < N * 4; i++)
		values[i] = some_value(f, i);
	kb_upload(&kb, 0, values);
	before = kb_read(&kb, 0);

	/* What the program reads, into RGBA32F. */
	raw = kb_create(GL_RGBA32F, 1, 0, W, W);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, kb.tex[0],
			     0);
	glDrawBuffers(2, (GLenum[]) { GL_COLOR_ATTACHMENT0,
				      GL_COLOR_ATTACHMENT1 });
	kb_program("MOV result.kbuffer[0], kbuffer[1];");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&raw);
	read = kb_read(&raw, 0);
	for (int i = 0; i < N * 4 && pass; i++) {
		/* One rounding of n / max. */
		const double t = f->kind == FLOAT ? 0 : ldexp(1, -23);

		pass = fabs(read[i] - before[i]) <= t;
		if (!pass)
			printf("component %d reads as %.9g, is %.9g\n", i % 4,
			       read[i], before[i]);
	}

	/* A copy onto itself changes nothing. */
	kb_program("MOV result.kbuffer[1], kbuffer[1];");
	for (int i = 0; i < 5; i++)
		kb_draw(&raw);
	after = kb_read(&kb, 0);
	if (memcmp(after, before, N * 16)) {
		for (int i = 0; i < N * 4; i++) {
			if (after[i] == before[i])
				continue;
			printf("component %d was %.9g, copied %.9g\n", i % 4,
			       before[i], after[i]);
			break;
		}
		pass = false;
	}
	free(after);

	/* Arithmetic is rounded once, when it is stored. */
	kb_program("MAD result.kbuffer[1], kbuffer[1], fragment.color.x, "
		   "fragment.color;");
	kb_fragment_value(.75, .2, .1, .05);
	kb_draw(&raw);
	after = kb_read(&kb, 0);
	for (int i = 0; i < N * 4 && pass; i++) {
		const double add[4] = { .75f, .2f, .1f, .05f };
		double tolerance;
		const double wanted = nearest(f, i % 4, (double)before[i] * .75 +
					      add[i % 4], &tolerance);

		/* MAD in single precision: cancellation leaves an absolute
		 * error of 2^-24 of the greater operand, twice. */
		tolerance += ldexp(fabs(before[i]) + 1, -23) *
			(f->bits[i % 4] != 0);
		pass = fabs(after[i] - wanted) <= tolerance;
		if (!pass)
			printf("component %d: %.9g * .75 + %g gives %.9g, "
			       "expected %.9g +- %.3g\n", i % 4, before[i],
			       add[i % 4], after[i], wanted, tolerance);
	}
	free(values);
	free(before);
	free(read);
	free(after);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Out of range: normalized formats clamp, floats overflow to infinity. */
static enum piglit_result
range(void *data)
{
	const struct format *f = data;
	struct kb kb = make(f);
	const bool packed = f->format == GL_R11F_G11F_B10F;
	double low = f->kind == UNORM || packed ? 0 : f->kind == SNORM ? -1 : -100;
	double high = f->kind == FLOAT ? 100 : 1;
	float *got;
	bool pass = true;

	if (!kb.format)
		return PIGLIT_PASS;
	kb_program("MOV result.kbuffer[0].xz, -100;\n"
		   "MOV result.kbuffer[0].yw, 100;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	got = kb_read(&kb, 0);
	for (int c = 0; c < 4; c++) {
		const double wanted = c % 2 ? high : low;

		if (f->bits[c] && got[c] != wanted) {
			printf("component %d: %g, expected %g\n", c, got[c],
			       wanted);
			pass = false;
		}
	}
	free(got);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
all(void *data)
{
	bool pass = true;

	for (int i = 0; i < ARRAY_SIZE(formats); i++) {
		const bool one = test_format((void *)&formats[i]) ==
			PIGLIT_PASS && range((void *)&formats[i]) ==
			PIGLIT_PASS;

		piglit_report_subtest_result(one ? PIGLIT_PASS : PIGLIT_FAIL,
					     "%s", formats[i].name);
		pass = one && pass;
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("all", all, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
