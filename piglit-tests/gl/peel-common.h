/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-common.h
 * What the tests of GL_MESA_depth_peeling share.
 *
 * A test draws by peel_draw(), which draws with GL and does the same to a
 * scalar model of the specification; peel_check() then compares all layers of
 * all attachments.  The model takes the state (DepthFunc, masks, scissor,
 * clear depth) from GL itself, so a test sets it by the ordinary commands.
 *
 * Nothing is approximate.  A fragment has an id, from which its color in every
 * attachment follows, exact in the attachment's format; texels are read and
 * compared as the codes (bits) of their components.
 */

#ifndef PEEL_COMMON_H
#define PEEL_COMMON_H

#include "kbuffer-common.h"

#define PEEL_MAX_COLORS 8

/** Every test of depth peeling ends with this. */
#define PEEL_TEST(version) KB_TEST(version, "GL_MESA_depth_peeling")

enum peel_kind {
	PEEL_UNORM, PEEL_SNORM, PEEL_FLOAT, PEEL_INT, PEEL_UINT, PEEL_DEPTH,
};

/** How a texture format is made, read, and coded. */
struct peel_format {
	GLenum internal, format, type;
	enum peel_kind kind;
	/** Components lie from the lowest bit up. */
	int bits[4];
};

/** Of an internal format that the tests know. */
const struct peel_format *
peel_format(GLenum internal);

/** Bytes of a texel as it is read. */
int
peel_texel_size(const struct peel_format *format);

/** The codes of the components of a color texel; 0 for missing ones. */
void
peel_unpack(const struct peel_format *format, const void *texel,
	    uint32_t codes[4]);

/** The code of a component of the color of fragment \p id in output \p output. */
uint32_t
peel_color_code(const struct peel_format *format, int output, int component,
		uint32_t id);

/** Codes of depths sort as the depths do. */
uint32_t
peel_max_depth(const struct peel_format *format);

uint32_t
peel_unpack_depth(const struct peel_format *format, const void *texel);

/**
 * The code of a depth that depth peeling clamps to [0, 1] and an ordinary depth
 * test may not: in buffers of floats interpolation makes errors to both sides.
 */
uint32_t
peel_clamp_depth(const struct peel_format *format, uint32_t code);

/** The code that a depth is stored as, if it is stored by truncation. */
uint32_t
peel_depth_code(const struct peel_format *format, double z);

/** A depth that is stored as the code, whether stored by rounding or not. */
float
peel_depth(const struct peel_format *format, uint32_t code);

/** What the layers hold, and what the continuation keeps of a sample. */
struct peel_model {
	uint32_t *depth;        /**< [sample][layer] */
	uint32_t (*color)[4];   /**< [sample][layer][attachment] */
	int rank;               /**< FIRST_LAYER */
	uint32_t *bound;        /**< of each sample: what was in front ends at
				     this depth, */
	int *taken;             /**< so many of which have been in layers, */
	int *seen;              /**< of so many that came in this pass */
	bool overflow;
};

/** A layered framebuffer, and the model of it. */
struct peel {
	GLuint fbo, depth_tex, color_tex[PEEL_MAX_COLORS];
	const struct peel_format *depth, *color[PEEL_MAX_COLORS];
	int colors, layers, width, height, samples;

	/** The attachment of each fragment output, -1 for NONE. */
	int buffers[PEEL_MAX_COLORS];

	GLuint program;

	/** Of a fragment shader with discard; NULL: all fragments stay. */
	bool (*stays)(int x, int y, int sample, uint32_t id);

	/** Samples at which a fragment was inserted, for occlusion queries. */
	int inserted;

	struct peel_model model;
};

/** What a framebuffer is made with; 0 samples is a plain 2D array. */
struct peel_shape {
	int layers, width, height, samples;
	GLenum depth;
	GLenum colors[PEEL_MAX_COLORS];         /**< up to the first 0 */
};

/**
 * Make, bind and clear a framebuffer, enable peeling, and use a program for
 * peel_draw().  glClipControl(ZERO_TO_ONE) is on so that window z is exactly
 * what is drawn.  The subtest's end deletes it.
 */
struct peel
peel_create(const struct peel_shape *shape);

/** The common shape: 16 x 16, 32-bit depth, one attachment of R32UI. */
struct peel
peel_simple(int layers);

/** Frees the model; result of the subtest. */
enum piglit_result
peel_end(struct peel *p, bool pass);

/** Set the draw buffers: attachment of each output, -1 for NONE. */
void
peel_draw_buffers(struct peel *p, int n, const int *attachments);

/**
 * Use a program whose fragment shader has the declarations and, before the
 * outputs are written, the statements given.  These see `id', an uint.
 */
GLuint
peel_use_program(struct peel *p, const char *declarations,
		 const char *statements);

/** Clear all layers: colors to code 0, depth to the clear depth. */
void
peel_clear(struct peel *p);

struct peel_vertex {
	float x, y, z, w;
	uint32_t id;
};

/** Draw without the model. */
void
peel_draw_vertices(GLenum mode, const struct peel_vertex *vertices, int n);

/**
 * A rectangle, in pixels, at a window z; in normalized formats at that of the
 * code below, as peel_depth() gives it, so that z is not a matter of rounding.
 */
struct peel_quad {
	float x0, y0, x1, y1, z;
	uint32_t id;
};

/** Draw them, in one draw, in this order. */
void
peel_draw(struct peel *p, const struct peel_quad *quads, int n);

/** Only with GL, or only with the model. */
void
peel_draw_gl(const struct peel *p, const struct peel_quad *quads, int n);
void
peel_draw_model(struct peel *p, const struct peel_quad *quads, int n);

/** A rectangle over all pixels. */
struct peel_quad
peel_full(const struct peel *p, float z, uint32_t id);

/**
 * Draw primitives of any form and order.  The model's fragments are those that
 * the same GL makes of each primitive alone with peeling disabled.
 */
void
peel_draw_captured(struct peel *p, GLenum mode,
		   const struct peel_vertex *vertices, int n);

/** Set FIRST_LAYER to the next k layers, and clear. */
void
peel_next(struct peel *p);

/** Set FIRST_LAYER to 0, and clear. */
void
peel_restart(struct peel *p);

/** Of the bound framebuffer. */
int
peel_get(GLenum pname);

/** All layers of all attachments, and OVERFLOW, are as in the model. */
bool
peel_check(struct peel *p);

/** The same without OVERFLOW. */
bool
peel_check_layers(const struct peel *p);

/** OVERFLOW alone. */
bool
peel_check_overflow(const struct peel *p);

/**
 * The model's layers are what the definition says: layer i holds the fragment
 * of rank FIRST_LAYER + i of these quads, all that were drawn in this pass,
 * when they are sorted by depth and, where that is equal, by arrival.
 */
bool
peel_check_ranks(const struct peel *p, const struct peel_quad *quads, int n);

/** The model alone: the fragment's colors are by output, masks are GL's. */
bool
peel_model_insert(struct peel *p, int x, int y, int sample, uint32_t depth,
		  uint32_t colors[][4]);

/** The texels of an attachment as codes: [layer][y][x][component]; free() it. */
uint32_t *
peel_read_color(const struct peel *p, int attachment);

/** The same of the depth: [layer][y][x]. */
uint32_t *
peel_read_depth(const struct peel *p);

/** Multisample forms: [sample][layer][y][x]...; see peel-multisample.c. */
uint32_t *
peel_read_samples(const struct peel *p, GLuint tex,
		  const struct peel_format *format);

/** A sequence of pseudorandom numbers. */
void
peel_seed(uint32_t seed);
int
peel_random(int below);

/** Bring the elements of an array into random order. */
void
peel_shuffle(struct peel_quad *quads, int n);

/**
 * \p n random triangles, some partly outside of the viewport, with perspective
 * and slanted depths; ids from \p first on.
 */
void
peel_random_triangles(struct peel_vertex *vertices, int n, uint32_t first);

#endif /* PEEL_COMMON_H */
