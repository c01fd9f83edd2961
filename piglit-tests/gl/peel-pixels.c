/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-pixels.c
 * The fragments of DrawPixels, Bitmap and CopyPixels are inserted by rank, at
 * the depth of the raster position.
 */

#include "peel-common.h"

#define W 40
#define H 30
#define K 4
#define IW 17
#define IH 11

static struct peel
make(void)
{
	struct peel p = peel_create(&(struct peel_shape) {
		K, W, H, 0, GL_DEPTH_COMPONENT32F, { GL_RGBA8 } });

	glUseProgram(0);
	return p;
}

/** Some quads to be in front of, and behind. */
static void
draw_quads(struct peel *p, int first)
{
	glUseProgram(p->program);
	for (int i = 0; i < 2; i++) {
		const struct peel_quad q = {
			i * 5, i, W - i, H - i * 3,
			(5 + 4 * i + first) / 16., first + i
		};

		peel_draw(p, &q, 1);
	}
	glUseProgram(0);
}

static void
insert(struct peel *p, int x, int y, float z, const GLubyte *rgba)
{
	uint32_t colors[PEEL_MAX_COLORS][4] = { { 0 } };

	for (int c = 0; c < 4; c++)
		colors[0][c] = rgba[c];
	peel_model_insert(p, x, y, 0, peel_depth_code(p->depth, z), colors);
}

static void
random_bytes(void *bytes, int n)
{
	for (int i = 0; i < n; i++)
		((GLubyte *)bytes)[i] = peel_random(256);
}

static enum piglit_result
draw_pixels(void *data)
{
	struct peel p = make();
	GLubyte pixels[IH][IW][4];

	peel_seed(1);
	draw_quads(&p, 0);
	for (int i = 0; i < 5; i++) {
		const int x = 3 + 4 * i, y = 2 + 3 * i;
		const float z = (1 + i * 3 % 5 * 3) / 16.;

		random_bytes(pixels, sizeof(pixels));
		glWindowPos3f(x, y, z);
		glDrawPixels(IW, IH, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
		for (int j = 0; j < IH * IW; j++)
			insert(&p, x + j % IW, y + j / IW, z,
			       pixels[j / IW][j % IW]);
	}
	draw_quads(&p, 1);
	return peel_end(&p, peel_check(&p));
}

static enum piglit_result
bitmap(void *data)
{
	struct peel p = make();
	GLubyte bits[IH][(IW + 7) / 8];

	peel_seed(2);
	draw_quads(&p, 0);
	glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
	for (int i = 0; i < 6; i++) {
		const int x = 3 + 4 * i, y = 2 + 3 * i;
		const float z = (1 + i * 3 % 5 * 3) / 16.;
		const GLubyte color[4] = { 40 * i, 255 - i, 7, 128 };

		random_bytes(bits, sizeof(bits));
		glColor4ubv(color);
		glWindowPos3f(x, y, z);
		glBitmap(IW, IH, 0, 0, 0, 0, bits[0]);
		for (int j = 0; j < IH * IW; j++) {
			const int column = j % IW;

			if (bits[j / IW][column / 8] & 0x80 >> column % 8)
				insert(&p, x + column, y + j / IW, z, color);
		}
		/* Some are drawn at once, some later. */
		if (i == 3)
			draw_quads(&p, 1);
	}
	glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
	return peel_end(&p, peel_check(&p));
}

/** Text of one color and depth, that overlaps: all of it is inserted. */
static enum piglit_result
bitmaps_of_one_depth(void *data)
{
	static const GLubyte bits[8] = { 0x18, 0x3c, 0x66, 0xc3, 0xff, 0xc3 };
	static const GLubyte color[4] = { 255, 128, 0, 255 };
	struct peel p = make();

	draw_quads(&p, 0);
	glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
	glColor4ubv(color);
	for (int i = 0; i < 3; i++) {
		glWindowPos3f(4 + i, 5, .25);
		glBitmap(8, 8, 0, 0, 0, 0, bits);
		for (int j = 0; j < 64; j++) {
			if (bits[j / 8] & 0x80 >> j % 8)
				insert(&p, 4 + i + j % 8, 5 + j / 8, .25,
				       color);
		}
	}
	glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
	return peel_end(&p, peel_check(&p));
}

static enum piglit_result
copy_pixels(void *data)
{
	struct peel p = make();
	struct kb source;
	GLubyte pixels[IH][IW][4];

	peel_seed(3);
	random_bytes(pixels, sizeof(pixels));
	draw_quads(&p, 0);
	source = kb_create(GL_RGBA8, 0, 0, IW, IH);
	source.tex[0] = kb_new_texture();
	glBindTexture(GL_TEXTURE_2D, source.tex[0]);
	glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, IW, IH, 0, GL_RGBA,
		     GL_UNSIGNED_BYTE, pixels);
	glBindTexture(GL_TEXTURE_2D, 0);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
			     source.tex[0], 0);
	glBindFramebuffer(GL_FRAMEBUFFER, p.fbo);
	glBindFramebuffer(GL_READ_FRAMEBUFFER, source.fbo);
	glReadBuffer(GL_COLOR_ATTACHMENT0);
	glViewport(0, 0, W, H);
	for (int i = 0; i < 4; i++) {
		const int x = 3 + 4 * i, y = 2 + 3 * i;
		const float z = (3 + i * 3 % 5 * 3) / 16.;

		glWindowPos3f(x, y, z);
		glCopyPixels(0, 0, IW, IH, GL_COLOR);
		for (int j = 0; j < IH * IW; j++)
			insert(&p, x + j % IW, y + j / IW, z,
			       pixels[j / IW][j % IW]);
	}
	glBindFramebuffer(GL_FRAMEBUFFER, p.fbo);
	draw_quads(&p, 1);
	return peel_end(&p, peel_check(&p));
}

/** Zoomed, each pixel of the image is several fragments. */
static enum piglit_result
zoomed(void *data)
{
	struct peel p = make();
	GLubyte pixels[IH][IW][4];

	peel_seed(4);
	random_bytes(pixels, sizeof(pixels));
	draw_quads(&p, 0);
	glPixelZoom(2, 2);
	glWindowPos3f(2, 4, .25);
	glDrawPixels(IW, IH, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
	for (int j = 0; j < 4 * IH * IW; j++)
		insert(&p, 2 + j % (2 * IW), 4 + j / (2 * IW), .25,
		       pixels[j / (2 * IW) / 2][j % (2 * IW) / 2]);
	glPixelZoom(1, 1);
	return peel_end(&p, peel_check(&p));
}

/** An image of depths: each fragment has its own. */
static enum piglit_result
draw_depths(void *data)
{
	struct peel p = make();
	const GLubyte color[4] = { 30, 60, 90, 120 };
	float depths[IH * IW];

	peel_seed(5);
	draw_quads(&p, 0);
	for (int i = 0; i < IH * IW; i++)
		depths[i] = (1 + peel_random(14)) / 16.;
	glColor4ubv(color);
	glWindowPos3f(5, 6, .5);
	glDrawPixels(IW, IH, GL_DEPTH_COMPONENT, GL_FLOAT, depths);
	for (int j = 0; j < IH * IW; j++)
		insert(&p, 5 + j % IW, 6 + j / IW, depths[j], color);
	return peel_end(&p, peel_check(&p));
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("draw-pixels", draw_pixels, NULL),
	KB_SUBTEST("draw-pixels-zoomed", zoomed, NULL),
	KB_SUBTEST("draw-depths", draw_depths, NULL),
	KB_SUBTEST("bitmap", bitmap, NULL),
	KB_SUBTEST("bitmaps-of-one-depth", bitmaps_of_one_depth, NULL),
	KB_SUBTEST("copy-pixels", copy_pixels, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
