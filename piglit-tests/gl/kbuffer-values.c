/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-values.c
 * See kbuffer-values.h.
 */

#include "kbuffer-values.h"

#include <float.h>

static bool
is_integer(const struct kb_format *f)
{
	return f->kind == KB_INT || f->kind == KB_UINT;
}

bool
kb_is_renderable(const struct kb_format *f)
{
	GLuint tex, fbo;
	GLenum status;

	if (f->required)
		return true;
	tex = kb_new_texture();
	fbo = kb_new_framebuffer();
	glBindTexture(GL_TEXTURE_2D, tex);
	glTexImage2D(GL_TEXTURE_2D, 0, f->format, 4, 4, 0, GL_RGBA, GL_FLOAT,
		     NULL);
	glBindTexture(GL_TEXTURE_2D, 0);
	glBindFramebuffer(GL_FRAMEBUFFER, fbo);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, tex, 0);
	status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
	if (status != GL_FRAMEBUFFER_COMPLETE)
		printf("%s cannot be rendered to, and need not\n", f->name);
	return status == GL_FRAMEBUFFER_COMPLETE;
}

struct list { uint32_t bits[KB_NUM_VALUES]; int n; };

static void
add_bits(struct list *list, uint32_t bits)
{
	if (list->n == KB_NUM_VALUES) {
		printf("more than %d values\n", KB_NUM_VALUES);
		piglit_report_result(PIGLIT_FAIL);
	}
	list->bits[list->n++] = bits;
}

static void
add(struct list *list, float value)
{
	uint32_t bits;

	memcpy(&bits, &value, 4);
	add_bits(list, bits);
}

/** A value and its neighbors, and all of that negated. */
static void
add_around(struct list *list, float value)
{
	for (int sign = -1; sign <= 1; sign += 2) {
		add(list, sign * nextafterf(value, -INFINITY));
		add(list, sign * value);
		add(list, sign * nextafterf(value, INFINITY));
	}
}

/** Halves between the values of so many bits above the sign. */
static void
add_halves(struct list *list, int bits)
{
	const uint32_t max = (1u << bits) - 1;
	const uint32_t some[] = { 0, 1, 2, 6, max / 2, max / 2 + 1, max - 1 };

	for (int i = 0; i < ARRAY_SIZE(some); i++) {
		if (some[i] < max && (i < 2 || some[i] > some[i - 1]))
			add_around(list, (some[i] + .5) / max);
	}
}

/** Where floats of so many bits of mantissa and 5 of exponent are rounded. */
static void
add_small_floats(struct list *list, int mantissa)
{
	const float ulp = ldexpf(1, -mantissa);
	const float max = ldexpf(2 - ulp, 15);

	add_around(list, 1 + ulp / 2);
	add_around(list, 1 + 1.5f * ulp);
	add_around(list, 2 - ulp / 2);
	add_around(list, max);
	add_around(list, max + ldexpf(ulp, 14));
	add_around(list, 65536);
	/* The least normal, denormal, half of that. */
	add_around(list, ldexpf(1, -14));
	add_around(list, ldexpf(ulp, -14));
	add_around(list, ldexpf(ulp, -15));
}

static void
add_floats(struct list *list, const struct kb_format *f)
{
	static const uint32_t nans[] = {
		0x7fc00000, 0xffc00000, 0x7f800001, 0xff812345, 0x7fffffff
	};
	static const uint32_t denormals[] = {
		0x00000001, 0x80000001, 0x007fffff, 0x807fffff, 0x00400000
	};

	for (int i = 0; i < ARRAY_SIZE(nans); i++)
		add_bits(list, nans[i]);
	for (int i = 0; i < ARRAY_SIZE(denormals); i++)
		add_bits(list, denormals[i]);
	for (int sign = -1; sign <= 1; sign += 2) {
		add(list, sign * INFINITY);
		add(list, sign * FLT_MAX);
		add(list, sign * 1e10f);
		add(list, sign * 2.5f);
		add(list, sign * 0.f);
		add(list, sign * FLT_MIN);
	}
	add_around(list, 1);
	for (int c = 0; c < 4; c++) {
		if (!f->bits[c] || (c > 0 && f->bits[c] == f->bits[c - 1]))
			continue;
		if (f->kind != KB_FLOAT)
			add_halves(list, f->bits[c] - (f->kind == KB_SNORM));
		else if (f->bits[c] < 23)
			add_small_floats(list, f->bits[c]);
	}
}

static void
add_integers(struct list *list, const struct kb_format *f)
{
	add_bits(list, 0);
	for (int c = 0; c < 4; c++) {
		for (int bits = f->bits[c] - 1; bits <= f->bits[c]; bits++) {
			if (bits <= 0 || bits > 31)
				continue;
			for (int i = -1; i <= 1; i++) {
				add_bits(list, (1u << bits) + i);
				add_bits(list, -(1u << bits) + i);
			}
		}
	}
	/* Denormals as floats; the ends of 32 bits. */
	add_bits(list, 8388607);
	add_bits(list, 0x80000000);
	add_bits(list, 0x7fffffff);
	add_bits(list, 0xffffffff);
}

void
kb_hard_values(const struct kb_format *f, kb_values values)
{
	struct list list = { .n = 0 };

	if (is_integer(f))
		add_integers(&list, f);
	else
		add_floats(&list, f);
	for (int i = 0; i < KB_NUM_VALUES; i++) {
		/* Neighbors differ, and so do components. */
		for (int c = 0; c < 4; c++)
			values[i][c] = list.bits[(i + 7 * c) % list.n];
	}
}

struct kb
kb_create_values(const struct kb_format *f, int layers)
{
	const int size = KB_VALUES_SIZE;
	struct kb kb = kb_create(is_integer(f) ? GL_RGBA8 : f->format, 1,
				 layers, size, size);

	if (!is_integer(f))
		return kb;
	kb.format = f->format;
	glBindTexture(kb.target, kb.tex[0]);
	if (layers)
		glTexImage3D(kb.target, 0, f->format, size, size, layers, 0,
			     GL_RGBA_INTEGER, GL_INT, NULL);
	else
		glTexImage2D(kb.target, 0, f->format, size, size, 0,
			     GL_RGBA_INTEGER, GL_INT, NULL);
	glBindTexture(kb.target, 0);
	return kb;
}

void
kb_use_values(const struct kb_format *f, kb_values values)
{
	static const char vs[] = "#version 150 compatibility\n"
		"void main() { gl_Position = gl_Vertex; }\n";
	const char *type = f->kind == KB_INT ? "ivec4" :
		f->kind == KB_UINT ? "uvec4" : "vec4";
	GLuint tex = kb_new_texture();
	char fs[512];

	sprintf(fs, "#version 150 compatibility\n"
		"#extension GL_ARB_shader_bit_encoding: require\n"
		"uniform usampler2D values;\nout %s o;\n"
		"void main() {\n"
		"  uvec4 v = texelFetch(values, ivec2(gl_FragCoord.xy), 0);\n"
		"  o = %s(v);\n}\n", type,
		is_integer(f) ? type : "uintBitsToFloat");
	kb_use_glsl(vs, NULL, fs);
	glBindTexture(GL_TEXTURE_2D, tex);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
	glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32UI, KB_VALUES_SIZE,
		     KB_VALUES_SIZE, 0, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
		     values);
	glClampColor(GL_CLAMP_FRAGMENT_COLOR, GL_FALSE);
	if (f->kind == KB_SRGB)
		glEnable(GL_FRAMEBUFFER_SRGB);
}

void
kb_read_values(const struct kb *kb, const struct kb_format *f, int entry,
	       kb_values got)
{
	const GLenum format = is_integer(f) ? GL_RGBA_INTEGER : GL_RGBA;
	const GLenum type = f->kind == KB_INT ? GL_INT :
		f->kind == KB_UINT ? GL_UNSIGNED_INT : GL_FLOAT;
	kb_values *layers = calloc(MAX2(kb->layers, 1), sizeof(kb_values));
	GLint bound;

	glGetIntegerv(kb->layers ? GL_TEXTURE_BINDING_2D_ARRAY :
		      GL_TEXTURE_BINDING_2D, &bound);
	glBindTexture(kb->target, kb->tex[entry % kb->attachments]);
	glGetTexImage(kb->target, 0, format, type, layers);
	glBindTexture(kb->target, bound);
	memcpy(got, layers[entry / kb->attachments], sizeof(kb_values));
	free(layers);
}

static float
as_float(uint32_t bits)
{
	float value;

	memcpy(&value, &bits, 4);
	return value;
}

/** Whether one of the two nearest values of the format was stored. */
static bool
is_near(const struct kb_format *f, int c, float value, float got)
{
	const int bits = f->bits[c] - (f->kind == KB_SNORM);
	const double max = (1 << bits) - 1;
	const double low = f->kind == KB_SNORM ? -1 : 0;
	double wanted;

	/* What the specifications of the extensions add to GL's. */
	if (isnan(value))
		return got == low;
	wanted = MAX2(low, MIN2(1, (double)value));
	if (wanted == low || wanted == 1)
		return got == wanted;
	if (f->kind == KB_SRGB && c < 3)
		wanted = piglit_linear_to_srgb(wanted);

	/* A product and two conversions in single precision. */
	return fabs(got - wanted) < 1 / max + ldexp(1, -22);
}

/** The same for floats, which GL lets become infinite where they are great. */
static bool
is_near_float(const struct kb_format *f, int c, float value, float got)
{
	const bool packed = f->format == GL_R11F_G11F_B10F;
	const float ulp = ldexpf(1, -f->bits[c]);
	const float max = ldexpf(2 - ulp, 15);

	if (isnan(value))
		return isnan(got);
	if (packed && value < 0)
		return got == 0;
	if (fabsf(value) > max)
		return fabsf(got) >= max && (got > 0) == (value > 0);
	return fabsf(got - value) <=
		MAX2(fabsf(value) * ulp, ldexpf(ulp, -14));
}

/** Whether GL, or one of the extensions, allows what was stored. */
static bool
is_allowed(const struct kb_format *f, int c, uint32_t value, uint32_t got)
{
	if (is_integer(f))
		return f->bits[c] < 32 || got == value;
	if (f->kind != KB_FLOAT)
		return is_near(f, c, as_float(value), as_float(got));
	if (f->bits[c] < 23)
		return is_near_float(f, c, as_float(value), as_float(got));
	return got == value;
}

bool
kb_check_values(const struct kb_format *f, kb_values values, kb_values plain,
		kb_values got)
{
	int bad = 0;

	for (int i = 0; i < 4 * KB_NUM_VALUES; i++) {
		const uint32_t value = values[i / 4][i % 4];
		const uint32_t p = plain[i / 4][i % 4], g = got[i / 4][i % 4];

		/* Where GL does not allow what is stored without the extension,
		 * that does not count: stock llvmpipe with vectors of 128 bits
		 * makes 0 of infinity. */
		if (!f->bits[i % 4] || (is_allowed(f, i % 4, value, g) &&
		    (p == g || !is_allowed(f, i % 4, value, p))))
			continue;
		if (++bad <= 20)
			printf("%s, component %d: %.9g (%08x) is stored as "
			       "%.9g (%08x), without the extension as %.9g "
			       "(%08x)\n", f->name, i % 4, as_float(value),
			       value, as_float(g), g, as_float(p), p);
	}
	return !bad;
}
