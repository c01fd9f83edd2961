/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-framebuffer-fetch.c
 * What EXT_shader_framebuffer_fetch does in the fragment shader, a k-buffer
 * program does behind it: the cases of VK-GL-CTS's framebuffer_fetch.basic
 * group, under their names, and what lies near them.  Its format group is in
 * kbuffer-framebuffer-fetch-formats.c; promises.md has the list.
 *
 * Values are bytes, and so are their sums: the tolerance is that of a byte
 * divided by 255 in single precision, once by the test and once by GL.
 */

#include "kbuffer-common.h"

#define W 64
#define TOLERANCE ldexpf(1, -23)

/** Bytes as a color. */
#define B(n) ((n) / 255.f)

#define FETCH "ADD result.kbuffer[0], kbuffer[0], fragment.color;\n"

/** Odd and even squares of 8 by 8 pixels. */
static bool
is_odd(int x, int y)
{
	return (x / 8 + y / 8) % 2;
}

static float *
grid(const float even[4], const float odd[4])
{
	float *pixels = malloc(W * W * 16);

	for (int i = 0; i < W * W; i++)
		memcpy(pixels + 4 * i, is_odd(i % W, i / W) ? odd : even, 16);
	return pixels;
}

static bool
expect_grid(const struct kb *kb, const float even[4], const float odd[4])
{
	float *wanted = grid(even, odd), *got = kb_read(kb, 0);
	bool pass = true;

	for (int i = 0; i < W * W * 4 && pass; i++) {
		pass = fabsf(got[i] - wanted[i]) <= TOLERANCE;
		if (!pass)
			printf("(%d, %d) component %d: %g, expected %g\n",
			       i / 4 % W, i / 4 / W, i % 4, got[i], wanted[i]);
	}
	free(wanted);
	free(got);
	return pass;
}

/** The entry, and a texture that the program looks up. */
static enum piglit_result
texel_fetch(void *data)
{
	static const float even[4] = { B(128), B(128), 0, B(64) };
	static const float odd[4] = { B(32), 0, B(128), B(64) };
	static const float even_sum[4] = { B(192), B(128), B(16), B(128) };
	static const float odd_sum[4] = { B(96), 0, B(144), B(128) };
	struct kb kb = kb_create(GL_RGBA8, 1, 0, W, W);
	float *pixels = grid(even, odd);
	GLuint tex = kb_new_texture();

	kb_fill(&kb, 0, B(64), 0, B(16), B(64));
	glBindTexture(GL_TEXTURE_2D, tex);
	glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, W, W, 0, GL_RGBA, GL_FLOAT,
		     pixels);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
	free(pixels);
	kb_program("TEMP t;\n"
		   "MUL t, fragment.position, 0.015625;\n"
		   "TEX t, t, texture[0], 2D;\n"
		   "ADD result.kbuffer[0], kbuffer[0], t;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	return expect_grid(&kb, even_sum, odd_sum) ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** The single color of an old fragment stage: gl_FragColor. */
static enum piglit_result
last_frag_data(void *data)
{
	struct kb kb = kb_create(GL_RGBA8, 1, 0, W, W);

	kb_fill(&kb, 0, B(128), B(3), 0, B(200));
	kb_use_glsl("#version 110\nvoid main() { gl_Position = gl_Vertex; }\n",
		    NULL, "#version 110\nvoid main() {\n"
		    "  gl_FragColor = vec4(25., 26., 27., 55.) / 255.;\n}\n");
	kb_program(FETCH);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	return kb_expect(&kb, 0, TOLERANCE, B(153), B(29), B(27), 1) ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

/** What the entry holds decides whether the fragment stays. */
static enum piglit_result
fragment_discard(void *data)
{
	static const float even[4] = { B(100), 0, B(120), B(127) };
	static const float odd[4] = { 0, B(255), B(10), B(20) };
	static const float even_sum[4] = { B(200), 0, B(240), B(254) };
	struct kb kb = kb_create(GL_RGBA8, 1, 0, W, W);
	float *pixels = grid(even, odd);

	kb_upload(&kb, 0, pixels);
	free(pixels);
	kb_program("TEMP t;\n"
		   "SUB t, kbuffer[0], fragment.color;\n"
		   "ABS t, t;\n"
		   "SUB t, 0.0005, t;\n"
		   "KIL t;\n" FETCH);
	kb_fragment_value(even[0], even[1], even[2], even[3]);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	return expect_grid(&kb, even_sum, odd) ? PIGLIT_PASS : PIGLIT_FAIL;
}

/**
 * Assigned once on the left, and on the right a second time, what would be the
 * sum of three.  A result cannot be read: both times it is the old entry that
 * is added to.
 */
static enum piglit_result
multiple_assignment(void *data)
{
	struct kb kb = kb_create(GL_RGBA8, 1, 0, W, W);
	bool pass;

	kb_fill(&kb, 0, B(60), B(10), 0, B(1));
	kb_program("TEMP left, once, twice;\n" FETCH
		   "ADD once, kbuffer[0], fragment.color;\n"
		   "ADD twice, once, fragment.color;\n"
		   "SLT left, fragment.position.x, 32;\n"
		   "CMP result.kbuffer[0], -left, once, twice;");
	kb_fragment_value(B(50), B(20), B(90), B(7));
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	pass = kb_expect_rect(&kb, 0, 0, 0, W / 2, W, TOLERANCE, B(110), B(30),
			      B(90), B(8));
	pass = kb_expect_rect(&kb, 0, W / 2, 0, W / 2, W, TOLERANCE, B(160),
			      B(50), B(180), B(15)) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
multiple_render_targets(void *data)
{
	struct kb kb = kb_create(GL_RGBA8, 4, 0, W, W);
	bool pass = true;

	for (int e = 0; e < 4; e++)
		kb_fill(&kb, e, B(20 * e), B(200 - e), B(e), B(50 * e));
	kb_program("ADD result.kbuffer[0], kbuffer[0], fragment.color;\n"
		   "ADD result.kbuffer[1], kbuffer[1], fragment.color;\n"
		   "ADD result.kbuffer[2], kbuffer[2], fragment.color;\n"
		   "ADD result.kbuffer[3], kbuffer[3], fragment.color;");
	kb_fragment_value(B(1), B(2), B(3), B(4));
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	for (int e = 0; e < 4; e++)
		pass = kb_expect(&kb, e, TOLERANCE, B(20 * e + 1), B(202 - e),
				 B(e + 3), B(50 * e + 4)) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** One level or one layer after the other of one texture is the k-buffer. */
static enum piglit_result
one_of_texture(void *data)
{
	const bool levels = strcmp(data, "level") == 0;
	struct kb kb = { .width = W, .height = W };
	GLuint tex = kb_new_texture();
	float *pixels = malloc(W * W * 16);
	bool pass = true;

	kb.fbo = kb_new_framebuffer();
	glBindFramebuffer(GL_FRAMEBUFFER, kb.fbo);
	glBindTexture(GL_TEXTURE_2D_ARRAY, tex);
	glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL,
			levels ? 2 : 0);
	for (int level = 0; level < (levels ? 3 : 1); level++)
		glTexImage3D(GL_TEXTURE_2D_ARRAY, level, GL_RGBA8, W >> level,
			     W >> level, 3, 0, GL_RGBA, GL_UNSIGNED_BYTE, NULL);
	kb_program(FETCH);
	kb_fragment_value(B(3), B(5), B(7), B(9));
	/* All are filled before any is drawn to. */
	for (int draw = 0; draw < 2; draw++) {
		for (int i = 0; i < 3; i++) {
			glFramebufferTextureLayer(
				GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, tex,
				levels ? i : 0, levels ? 1 : i);
			kb.width = kb.height = levels ? W >> i : W;
			glViewport(0, 0, kb.width, kb.width);
			glClearColor(B(40 * i), B(100 - i), 0, B(200));
			if (draw) {
				glEnable(GL_KBUFFER_PROGRAM_MESA);
				kb_draw(&kb);
			} else {
				glClear(GL_COLOR_BUFFER_BIT);
			}
		}
	}
	for (int i = 0; i < 3; i++) {
		const float wanted[4] = {
			B(40 * i + 3), B(105 - i), B(7), B(209)
		};
		const int size = levels ? W >> i : W;

		glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
					  tex, levels ? i : 0, levels ? 1 : i);
		glReadPixels(0, 0, size, size, GL_RGBA, GL_FLOAT, pixels);
		for (int j = 0; j < size * size * 4 && pass; j++) {
			pass = fabsf(pixels[j] - wanted[j % 4]) <= TOLERANCE;
			if (!pass)
				printf("%s %d, component %d: %g, expected "
				       "%g\n", (const char *)data, i, j % 4,
				       pixels[j], wanted[j % 4]);
		}
	}
	free(pixels);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Every fragment of a pixel adds to what those before have left. */
static enum piglit_result
overdraw(void *data)
{
	const int n = 200;
	struct kb kb = kb_create(GL_RGBA8, 1, 0, W, W);
	bool pass;

	kb_program(FETCH);
	kb_fragment_value(B(1), 0, B(1), B(1));
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	glBegin(GL_TRIANGLES);
	for (int i = 0; i < n; i++) {
		/* Half of them over all pixels, half over the left half. */
		const float right = i % 2 ? 1 : 0;

		glVertex2f(-1, -1);
		glVertex2f(right, -1);
		glVertex2f(right, 1);
		glVertex2f(-1, -1);
		glVertex2f(right, 1);
		glVertex2f(-1, 1);
	}
	glEnd();
	pass = kb_expect_rect(&kb, 0, 0, 0, W / 2, W, TOLERANCE, B(n), 0, B(n),
			      B(n));
	pass = kb_expect_rect(&kb, 0, W / 2, 0, W / 2, W, TOLERANCE, B(n / 2),
			      0, B(n / 2), B(n / 2)) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** An entry is of the draw buffer, which is not the attachment's number. */
static enum piglit_result
draw_buffers(void *data)
{
	static const GLenum buffers[3] = {
		GL_COLOR_ATTACHMENT2, GL_NONE, GL_COLOR_ATTACHMENT0
	};
	struct kb kb = kb_create(GL_RGBA8, 3, 0, W, W);
	bool pass;

	for (int a = 0; a < 3; a++)
		kb_fill(&kb, a, B(10 + a), B(20 + a), B(30 + a), B(40 + a));
	glDrawBuffers(3, buffers);
	kb_program("ADD result.kbuffer[0], kbuffer[0], fragment.color;\n"
		   "SUB result.kbuffer[2], kbuffer[2], fragment.color;");
	kb_fragment_value(B(1), B(2), B(3), B(4));
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, TOLERANCE, B(9), B(18), B(27), B(36));
	pass = kb_expect(&kb, 1, TOLERANCE, B(11), B(21), B(31), B(41)) && pass;
	pass = kb_expect(&kb, 2, TOLERANCE, B(13), B(24), B(35), B(46)) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** What is blitted between two draws is read by the second, from both. */
static enum piglit_result
blit_between(void *data)
{
	struct kb from = kb_create(GL_RGBA8, 1, 0, W, W);
	struct kb kb = kb_create(GL_RGBA8, 1, 0, W, W);
	bool pass;

	kb_fill(&from, 0, B(100), B(101), B(102), B(103));
	kb_program(FETCH);
	kb_fragment_value(B(1), B(2), B(3), B(4));
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	glBindFramebuffer(GL_READ_FRAMEBUFFER, from.fbo);
	glBlitFramebuffer(0, 0, W, W, W / 2, 0, W, W, GL_COLOR_BUFFER_BIT,
			  GL_NEAREST);
	kb_draw(&kb);
	/* And back, into what is then drawn to. */
	glBindFramebuffer(GL_READ_FRAMEBUFFER, kb.fbo);
	glBindFramebuffer(GL_DRAW_FRAMEBUFFER, from.fbo);
	glBlitFramebuffer(0, 0, W, W, 0, 0, W, W, GL_COLOR_BUFFER_BIT,
			  GL_NEAREST);
	kb_draw(&from);
	pass = kb_expect_rect(&kb, 0, 0, 0, W / 2, W, TOLERANCE, B(2), B(4),
			      B(6), B(8));
	pass = kb_expect_rect(&kb, 0, W / 2, 0, W / 2, W, TOLERANCE, B(101),
			      B(103), B(105), B(107)) && pass;
	pass = kb_expect_rect(&from, 0, 0, 0, W / 2, W, TOLERANCE, B(3), B(6),
			      B(9), B(12)) && pass;
	pass = kb_expect_rect(&from, 0, W / 2, 0, W / 2, W, TOLERANCE, B(102),
			      B(105), B(108), B(111)) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** A fragment shader that fetches sees what programs and clears left. */
static enum piglit_result
both_stages(void *data)
{
	struct kb kb = kb_create(GL_RGBA8, 1, 0, W, W);

	if (!piglit_is_extension_supported("GL_EXT_shader_framebuffer_fetch")) {
		printf("no framebuffer fetch here\n");
		return PIGLIT_SKIP;
	}
	kb_use_glsl("#version 130\n"
		    "void main() { gl_Position = gl_Vertex; }\n", NULL,
		    "#version 130\n"
		    "#extension GL_EXT_shader_framebuffer_fetch: require\n"
		    "inout vec4 color;\n"
		    "void main() { color += vec4(1, 2, 3, 4) / 255.0; }\n");
	kb_program("ADD result.kbuffer[0], fragment.color, { 0, 0, 0, 0.2 };");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	glClearColor(B(100), B(100), B(100), B(10));
	glClear(GL_COLOR_BUFFER_BIT);
	for (int i = 0; i < 3; i++)
		kb_draw(&kb);
	/* 0.2 is 51 of 255. */
	return kb_expect(&kb, 0, TOLERANCE, B(103), B(106), B(109),
			 B(10 + 3 * (4 + 51))) ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("texel-fetch", texel_fetch, NULL),
	KB_SUBTEST("last-frag-data", last_frag_data, NULL),
	KB_SUBTEST("fragment-discard", fragment_discard, NULL),
	KB_SUBTEST("multiple-assignment", multiple_assignment, NULL),
	KB_SUBTEST("multiple-render-targets", multiple_render_targets, NULL),
	KB_SUBTEST("framebuffer-texture-level", one_of_texture, "level"),
	KB_SUBTEST("framebuffer-texture-layer", one_of_texture, "layer"),
	KB_SUBTEST("overdraw", overdraw, NULL),
	KB_SUBTEST("draw-buffers", draw_buffers, NULL),
	KB_SUBTEST("blit-between", blit_between, NULL),
	KB_SUBTEST("both-stages", both_stages, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(30)
