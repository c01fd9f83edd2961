/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-values.h
 * Colors that are hard to convert, all formats that they are converted to, and
 * what is known of the result.
 */

#ifndef KBUFFER_VALUES_H
#define KBUFFER_VALUES_H

#include "kbuffer-common.h"

enum kb_kind { KB_UNORM, KB_SRGB, KB_SNORM, KB_FLOAT, KB_INT, KB_UINT };

struct kb_format {
	const char *name;
	GLenum format;
	enum kb_kind kind;
	bool required;          /**< by GL: it can be rendered to */
	/* Of red, green, blue, alpha; mantissa bits of floats; 0: missing. */
	int bits[4];
};

/** F(name, kind, required, bits...) for each format of a size that GL knows. */
#define KB_COLOR_FORMATS(F)					\
	F(R8, KB_UNORM, true, 8)				\
	F(RG8, KB_UNORM, true, 8, 8)				\
	F(RGB8, KB_UNORM, true, 8, 8, 8)			\
	F(RGBA8, KB_UNORM, true, 8, 8, 8, 8)			\
	F(SRGB8_ALPHA8, KB_SRGB, true, 8, 8, 8, 8)		\
	F(R3_G3_B2, KB_UNORM, false, 3, 3, 2)			\
	F(RGBA4, KB_UNORM, true, 4, 4, 4, 4)			\
	F(RGB5_A1, KB_UNORM, true, 5, 5, 5, 1)			\
	F(RGB565, KB_UNORM, true, 5, 6, 5)			\
	F(RGB10_A2, KB_UNORM, true, 10, 10, 10, 2)		\
	F(R16, KB_UNORM, true, 16)				\
	F(RG16, KB_UNORM, true, 16, 16)				\
	F(RGB16, KB_UNORM, false, 16, 16, 16)			\
	F(RGBA16, KB_UNORM, true, 16, 16, 16, 16)		\
	F(R8_SNORM, KB_SNORM, false, 8)				\
	F(RG8_SNORM, KB_SNORM, false, 8, 8)			\
	F(RGBA8_SNORM, KB_SNORM, false, 8, 8, 8, 8)		\
	F(R16_SNORM, KB_SNORM, false, 16)			\
	F(RG16_SNORM, KB_SNORM, false, 16, 16)			\
	F(RGBA16_SNORM, KB_SNORM, false, 16, 16, 16, 16)	\
	F(R16F, KB_FLOAT, true, 10)				\
	F(RG16F, KB_FLOAT, true, 10, 10)			\
	F(RGB16F, KB_FLOAT, false, 10, 10, 10)			\
	F(RGBA16F, KB_FLOAT, true, 10, 10, 10, 10)		\
	F(R32F, KB_FLOAT, true, 23)				\
	F(RG32F, KB_FLOAT, true, 23, 23)			\
	F(RGB32F, KB_FLOAT, false, 23, 23, 23)			\
	F(RGBA32F, KB_FLOAT, true, 23, 23, 23, 23)		\
	F(R11F_G11F_B10F, KB_FLOAT, true, 6, 6, 5)

/** The same of integers. */
#define KB_INTEGER_FORMATS(F)					\
	F(R8I, KB_INT, true, 8)					\
	F(RG8I, KB_INT, true, 8, 8)				\
	F(RGBA8I, KB_INT, true, 8, 8, 8, 8)			\
	F(RG16I, KB_INT, true, 16, 16)				\
	F(RGBA16I, KB_INT, true, 16, 16, 16, 16)		\
	F(R32I, KB_INT, true, 32)				\
	F(RGBA32I, KB_INT, true, 32, 32, 32, 32)		\
	F(R8UI, KB_UINT, true, 8)				\
	F(RG8UI, KB_UINT, true, 8, 8)				\
	F(RGBA8UI, KB_UINT, true, 8, 8, 8, 8)			\
	F(RGB10_A2UI, KB_UINT, true, 10, 10, 10, 2)		\
	F(RG16UI, KB_UINT, true, 16, 16)			\
	F(RGBA16UI, KB_UINT, true, 16, 16, 16, 16)		\
	F(R32UI, KB_UINT, true, 32)				\
	F(RGBA32UI, KB_UINT, true, 32, 32, 32, 32)

/** A subtest for such a format. */
#define KB_FORMAT_SUBTEST(format, kind, required, ...) \
	KB_SUBTEST(#format, test_format, (&(const struct kb_format) { \
		#format, GL_##format, kind, required, { __VA_ARGS__ } })),

/** The GL can render to it. */
bool
kb_is_renderable(const struct kb_format *f);

/** Width and height of an image of values. */
#define KB_VALUES_SIZE 16

/** So many RGBA values, as their bits. */
#define KB_NUM_VALUES (KB_VALUES_SIZE * KB_VALUES_SIZE)

typedef uint32_t kb_values[KB_NUM_VALUES][4];

/**
 * NaNs, infinities, zeros and denormals, the ends of the format's range and
 * what is beyond, halves between two of its values and their neighbors; for
 * integer formats those and their neighbors.  Each of them comes in each
 * component.
 */
void
kb_hard_values(const struct kb_format *f, kb_values values);

/** Make and bind a framebuffer of the format; integers are not cleared. */
struct kb
kb_create_values(const struct kb_format *f, int layers);

/** Bind a fragment shader that gives each pixel its value, bit for bit. */
void
kb_use_values(const struct kb_format *f, kb_values values);

/** What a layer of a texture holds: floats, or integers. */
void
kb_read_values(const struct kb *kb, const struct kb_format *f, int entry,
	       kb_values got);

/**
 * Compare what one way of drawing has stored with what another has, the one
 * without the extensions, where that is what GL allows, and in any case with
 * what GL allows and the specifications of the extensions say.  Prints what
 * differs.
 */
bool
kb_check_values(const struct kb_format *f, kb_values values, kb_values plain,
		kb_values got);

#endif /* KBUFFER_VALUES_H */
