/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-common.h
 * What the tests of GL_MESA_kbuffer_program share.
 *
 * A test is a list of subtests, \c kbuffer_subtests, and KBUFFER_TEST().  The
 * common code requires the extension, runs the subtests, brings the context
 * back to its defaults after each of them, and fails a subtest that leaves a
 * GL error behind.
 */

#ifndef KBUFFER_COMMON_H
#define KBUFFER_COMMON_H

#include "piglit-util-gl.h"
#include <GL/mesa_kbuffer.h>

#define KB_MAX_ATTACHMENTS 8

/** Every test of the extension ends with this. */
#define KBUFFER_TEST(version) KB_TEST(version, "GL_MESA_kbuffer_program")

/** A test of \p extension. */
#define KB_TEST(version, extension)                                     \
	const char *const kb_extension = (extension);                   \
	PIGLIT_GL_TEST_CONFIG_BEGIN                                     \
		config.supports_gl_compat_version = (version);          \
		config.window_width = 64;                               \
		config.window_height = 64;                              \
		config.window_visual = PIGLIT_GL_VISUAL_RGBA |          \
			PIGLIT_GL_VISUAL_DEPTH | PIGLIT_GL_VISUAL_DOUBLE; \
		config.khr_no_error_support = PIGLIT_HAS_ERRORS;        \
		config.subtests = kbuffer_subtests;                     \
	PIGLIT_GL_TEST_CONFIG_END

/** The name in the log is the one on the command line. */
#define KB_SUBTEST(name, func, data) { name, name, func, (void *)(data) }
#define KB_SUBTEST_END { NULL }

extern const struct piglit_subtest kbuffer_subtests[];
extern const char *const kb_extension;

/** A framebuffer object whose color attachments are textures of one format. */
struct kb {
	GLuint fbo;
	GLuint tex[KB_MAX_ATTACHMENTS];
	GLenum target;          /**< 2D, 2D array, or their multisample forms */
	GLenum format;
	int attachments;
	int layers;             /**< 0: not layered */
	int width, height;
};

/** Objects that are deleted when the subtest ends. */
GLuint
kb_new_texture(void);
GLuint
kb_new_framebuffer(void);
GLuint
kb_new_glsl_program(void);

/**
 * Make and bind a framebuffer with \p attachments color textures of
 * \p layers layers (0: plain 2D textures), all of them draw buffers, cleared
 * to zero.  It is deleted when the subtest ends.
 */
struct kb
kb_create(GLenum format, int attachments, int layers, int width, int height);

/** Attach a depth texture (with as many layers as the colors). */
void
kb_attach_depth(const struct kb *kb, GLenum format);

/** Number of entries. */
int
kb_entries(const struct kb *kb);

/** Give all pixels of an entry one value. */
void
kb_fill(const struct kb *kb, int entry, float r, float g, float b, float a);

/** The same for RGBA32F with four bit patterns. */
void
kb_fill_bits(const struct kb *kb, int entry, const uint32_t bits[4]);

/** Upload width * height * 4 floats to an entry. */
void
kb_upload(const struct kb *kb, int entry, const void *pixels);

/** width * height * 4 floats of an entry; free() it. */
float *
kb_read(const struct kb *kb, int entry);

/** All pixels of an entry are within \p tolerance of the value. */
bool
kb_expect(const struct kb *kb, int entry, float tolerance,
	  float r, float g, float b, float a);

/** The same for the pixels of a rectangle. */
bool
kb_expect_rect(const struct kb *kb, int entry, int x, int y, int w, int h,
	       float tolerance, float r, float g, float b, float a);

/** \p inside is in the pixels of the rectangle, \p outside in all others. */
bool
kb_expect_only_rect(const struct kb *kb, int entry, int x, int y, int w, int h,
		    const float inside[4], const float outside[4]);

/** All pixels of an RGBA32F entry have these bits. */
bool
kb_expect_bits(const struct kb *kb, int entry, const uint32_t bits[4]);

#define KB_SAMPLES 4
#define KB_MS_SIZE 32

/** A multisample framebuffer of RGBA32F and a 32-bit depth buffer. */
struct kb_ms {
	struct kb kb;
	GLuint tex[2], depth;
};

/** Make, bind and clear one; ends the test where there are no four samples. */
struct kb_ms
kb_ms_create(int attachments, int layers);

/**
 * All samples of one of its textures (of one layer): KB_SAMPLES images of
 * KB_MS_SIZE squared RGBA; free() them.
 */
float *
kb_ms_read(const struct kb_ms *ms, GLuint tex, int layer);

/**
 * Load and bind a k-buffer program; \p body is what stands between the
 * option and END.  Ends the test with a failure if it is not accepted.
 */
GLuint
kb_program(const char *body);

/** Load a program string of any length for any target: the GL error. */
GLenum
kb_load(GLenum target, const char *string, int length);

/**
 * Bind an ARB fragment program that writes values[i], unclamped, to color
 * output i.
 */
void
kb_fragment_values(const float (*values)[4], int n);

/** The same with one value, the only color output. */
void
kb_fragment_value(float r, float g, float b, float a);

/** Link and use a GLSL program; GL_GEOMETRY_SHADER if \p gs is not NULL. */
GLuint
kb_use_glsl(const char *vs, const char *gs, const char *fs);

/** Draw a rectangle in pixels of the viewport at a window z. */
void
kb_draw_rect(const struct kb *kb, float x, float y, float w, float h, float z);

/** Draw a rectangle over the whole framebuffer at z = 0.5. */
void
kb_draw(const struct kb *kb);

/** Does this process run on softpipe? */
bool
kb_is_softpipe(void);

/**
 * Each kind of command that draws, over all of a framebuffer of this size, with
 * the state as it is.
 */
#define KB_COMMAND_SIZE 8
#define KB_NUM_COMMANDS 13

struct kb_command { const char *name; void (*draw)(void); bool is_pixels; };

extern const struct kb_command kb_commands[KB_NUM_COMMANDS];

#endif /* KBUFFER_COMMON_H */
