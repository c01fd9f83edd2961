/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-formats.c
 * Formats: the codes of colors and depths.
 */

#include "peel-common.h"

#define UN PEEL_UNORM
#define SN PEEL_SNORM
#define FL PEEL_FLOAT
#define UI PEEL_UINT
#define IN PEEL_INT
#define BYTES GL_UNSIGNED_BYTE
#define SHORTS GL_UNSIGNED_SHORT
#define HALVES GL_HALF_FLOAT

static const struct peel_format formats[] = {
	{ GL_R8, GL_RED, BYTES, UN, { 8 } },
	{ GL_RG8, GL_RG, BYTES, UN, { 8, 8 } },
	{ GL_RGB8, GL_RGB, BYTES, UN, { 8, 8, 8 } },
	{ GL_RGBA8, GL_RGBA, BYTES, UN, { 8, 8, 8, 8 } },
	{ GL_SRGB8_ALPHA8, GL_RGBA, BYTES, UN, { 8, 8, 8, 8 } },
	{ GL_RGBA8_SNORM, GL_RGBA, GL_BYTE, SN, { 8, 8, 8, 8 } },
	{ GL_RGB565, GL_RGB, GL_UNSIGNED_SHORT_5_6_5_REV, UN, { 5, 6, 5 } },
	{ GL_RGBA4, GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4_REV, UN, { 4, 4, 4, 4 } },
	{ GL_RGB5_A1, GL_RGBA, GL_UNSIGNED_SHORT_1_5_5_5_REV, UN,
	  { 5, 5, 5, 1 } },
	{ GL_RGB10_A2, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV, UN,
	  { 10, 10, 10, 2 } },
	{ GL_RGB10_A2UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT_2_10_10_10_REV, UI,
	  { 10, 10, 10, 2 } },
	{ GL_R16, GL_RED, SHORTS, UN, { 16 } },
	{ GL_RGBA16, GL_RGBA, SHORTS, UN, { 16, 16, 16, 16 } },
	{ GL_RGBA16_SNORM, GL_RGBA, GL_SHORT, SN, { 16, 16, 16, 16 } },
	{ GL_R11F_G11F_B10F, GL_RGB, GL_UNSIGNED_INT_10F_11F_11F_REV, FL,
	  { 11, 11, 10 } },
	{ GL_R16F, GL_RED, HALVES, FL, { 16 } },
	{ GL_RG16F, GL_RG, HALVES, FL, { 16, 16 } },
	{ GL_RGBA16F, GL_RGBA, HALVES, FL, { 16, 16, 16, 16 } },
	{ GL_R32F, GL_RED, GL_FLOAT, FL, { 32 } },
	{ GL_RG32F, GL_RG, GL_FLOAT, FL, { 32, 32 } },
	{ GL_RGBA32F, GL_RGBA, GL_FLOAT, FL, { 32, 32, 32, 32 } },
	{ GL_R8UI, GL_RED_INTEGER, BYTES, UI, { 8 } },
	{ GL_RGBA8UI, GL_RGBA_INTEGER, BYTES, UI, { 8, 8, 8, 8 } },
	{ GL_RGBA8I, GL_RGBA_INTEGER, GL_BYTE, IN, { 8, 8, 8, 8 } },
	{ GL_R16UI, GL_RED_INTEGER, SHORTS, UI, { 16 } },
	{ GL_RG16I, GL_RG_INTEGER, GL_SHORT, IN, { 16, 16 } },
	{ GL_RGBA16UI, GL_RGBA_INTEGER, SHORTS, UI, { 16, 16, 16, 16 } },
	{ GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, UI, { 32 } },
	{ GL_R32I, GL_RED_INTEGER, GL_INT, IN, { 32 } },
	{ GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT, UI, { 32, 32 } },
	{ GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, UI,
	  { 32, 32, 32, 32 } },
	{ GL_RGBA32I, GL_RGBA_INTEGER, GL_INT, IN, { 32, 32, 32, 32 } },

	/* The bits of the depth, and what stands above them in a texel. */
	{ GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT, SHORTS, PEEL_DEPTH, { 16 } },
	{ GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, PEEL_DEPTH,
	  { 24, 8 } },
	{ GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8,
	  PEEL_DEPTH, { 24, 8 } },
	{ GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, PEEL_DEPTH,
	  { 32 } },
	{ GL_DEPTH32F_STENCIL8, GL_DEPTH_STENCIL,
	  GL_FLOAT_32_UNSIGNED_INT_24_8_REV, PEEL_DEPTH, { 32, 32 } },
};

const struct peel_format *
peel_format(GLenum internal)
{
	for (int i = 0; i < ARRAY_SIZE(formats); i++) {
		if (formats[i].internal == internal)
			return &formats[i];
	}
	printf("the tests know no format %s\n",
	       piglit_get_gl_enum_name(internal));
	piglit_report_result(PIGLIT_FAIL);
	return NULL;
}

int
peel_texel_size(const struct peel_format *format)
{
	const int *b = format->bits;

	return (b[0] + b[1] + b[2] + b[3]) / 8;
}

static uint32_t
low_bits(int bits)
{
	return bits == 32 ? ~0u : (1u << bits) - 1;
}

void
peel_unpack(const struct peel_format *format, const void *texel,
	    uint32_t codes[4])
{
	int at = 0;

	for (int c = 0; c < 4; c++) {
		uint64_t word = 0;

		memcpy(&word, (const char *)texel + at / 32 * 4,
		       MIN2(4, peel_texel_size(format) - at / 32 * 4));
		codes[c] = format->bits[c] ?
			(word >> at % 32) & low_bits(format->bits[c]) : 0;
		at += format->bits[c];
		if (at >= peel_texel_size(format) * 8)
			at = 0;
	}
}

/** The same in the fragment shader, see peel-common.c. */
static uint32_t
hash(uint32_t id, uint32_t slot)
{
	uint32_t v = (id * 64 + slot) * 2654435761u;

	v = (v ^ v >> 15) * 2246822519u;
	return v ^ v >> 13;
}

/** A small integer as a float of so many bits. */
static uint32_t
float_code(uint32_t n, int bits)
{
	/* 10 and 11 bits are without a sign. */
	const int mantissa = bits == 32 ? 23 : bits == 16 ? 10 : bits - 5;
	const int bias = bits == 32 ? 127 : 15;
	int e = 0;

	if (n == 0)
		return 0;
	while (n >> (e + 1))
		e++;
	return (uint32_t)(e + bias) << mantissa |
		(n - (1u << e)) << (mantissa - e);
}

uint32_t
peel_color_code(const struct peel_format *format, int output, int component,
		uint32_t id)
{
	const int bits = format->bits[component];
	const uint32_t v = hash(id, 4 * output + component);
	const uint32_t most = low_bits(bits - 1);

	if (bits == 0)
		return 0;
	switch (format->kind) {
	case PEEL_SNORM:
		return (v % (2 * most + 1) - most) & low_bits(bits);
	case PEEL_FLOAT:
		/* What every format holds exactly. */
		return float_code(v & 31, bits);
	default:
		return v & low_bits(bits);
	}
}

uint32_t
peel_max_depth(const struct peel_format *format)
{
	/* 32 bits are a float: 1.0 */
	return format->bits[0] == 32 ? 0x3f800000 : low_bits(format->bits[0]);
}

uint32_t
peel_unpack_depth(const struct peel_format *format, const void *texel)
{
	uint32_t word;

	if (format->bits[0] == 16)
		return *(const uint16_t *)texel;
	memcpy(&word, texel, 4);
	/* The depth is above the stencil; where there is none it is widened. */
	return format->bits[0] == 24 ? word >> 8 : word;
}

uint32_t
peel_clamp_depth(const struct peel_format *format, uint32_t code)
{
	/* Negative floats have the highest bit. */
	if (format->bits[0] == 32 && code > INT32_MAX)
		return 0;
	return MIN2(code, peel_max_depth(format));
}

uint32_t
peel_depth_code(const struct peel_format *format, double z)
{
	z = CLAMP(z, 0, 1);
	if (format->bits[0] == 32) {
		const float value = z;
		uint32_t code;

		memcpy(&code, &value, 4);
		return code;
	}
	return z * peel_max_depth(format);
}

float
peel_depth(const struct peel_format *format, uint32_t code)
{
	float z;

	if (format->bits[0] == 32) {
		memcpy(&z, &code, 4);
		return z;
	}
	if (code == peel_max_depth(format))
		return 1;
	/*
	 * A bit above the code, where a driver that rounds and one that
	 * truncates agree.  The upper half of 24 bits has one float for each
	 * code: (code + 1) * 2^-24, less than half a code above.
	 */
	if (format->bits[0] == 24 && code >= 1u << 23)
		return ldexpf(code + 1, -24);
	return (code + 0.25) / peel_max_depth(format);
}
