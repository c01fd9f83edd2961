/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-pixels.c
 * The fragments of DrawPixels, Bitmap and CopyPixels of colors and depths are
 * inserted by rank, colors at the depth of the raster position.  Stencil
 * indices, and depths and stencil indices together, are written to layer 0.
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

static enum piglit_result
copy_depths(void *data)
{
	struct peel p = make();
	const GLubyte color[4] = { 30, 60, 90, 120 };
	struct kb source;
	float depths[IH * IW];
	GLuint tex;

	peel_seed(6);
	draw_quads(&p, 0);
	for (int i = 0; i < IH * IW; i++)
		depths[i] = (1 + peel_random(14)) / 16.;
	source = kb_create(GL_RGBA8, 1, 0, IW, IH);
	tex = kb_new_texture();
	glBindTexture(GL_TEXTURE_2D, tex);
	glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, IW, IH, 0,
		     GL_DEPTH_COMPONENT, GL_FLOAT, depths);
	glBindTexture(GL_TEXTURE_2D, 0);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, tex, 0);
	glBindFramebuffer(GL_FRAMEBUFFER, p.fbo);
	glBindFramebuffer(GL_READ_FRAMEBUFFER, source.fbo);
	glViewport(0, 0, W, H);
	glColor4ubv(color);
	glWindowPos3f(5, 6, .5);
	glCopyPixels(0, 0, IW, IH, GL_DEPTH);
	for (int j = 0; j < IH * IW; j++)
		insert(&p, 5 + j % IW, 6 + j / IW, depths[j], color);
	glBindFramebuffer(GL_FRAMEBUFFER, p.fbo);
	return peel_end(&p, peel_check(&p));
}

/** Packed depths and stencil indices of all layers. */
static uint32_t *
read_packed(const struct peel *p)
{
	uint32_t *packed = malloc(K * W * H * 4);

	glBindTexture(GL_TEXTURE_2D_ARRAY, p->depth_tex);
	glGetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_DEPTH_STENCIL,
		      GL_UNSIGNED_INT_24_8, packed);
	glBindTexture(GL_TEXTURE_2D_ARRAY, 0);
	return packed;
}

/**
 * With the format of DrawPixels: of layer 0 the stencil indices, or they and
 * the depths, are those of the image, and all else is as it was.  Depths go
 * through single precision, whose 24 bits give them two roundings of half a
 * unit.
 */
static enum piglit_result
draw_stencil(void *data)
{
	const GLenum format = (GLenum)(intptr_t)data;
	const bool depths = format == GL_DEPTH_STENCIL;
	struct peel p = peel_create(&(struct peel_shape) {
		K, W, H, 0, GL_DEPTH24_STENCIL8, { GL_RGBA8 } });
	uint32_t image[IH * IW], *before, *after, *colors[2];
	GLubyte indices[IH * IW];
	bool pass = true;

	peel_seed(7);
	glClearStencil(9);
	glClear(GL_STENCIL_BUFFER_BIT);
	draw_quads(&p, 0);
	before = read_packed(&p);
	colors[0] = peel_read_color(&p, 0);
	for (int i = 0; i < IH * IW; i++) {
		indices[i] = peel_random(256);
		image[i] = (uint32_t)peel_random(1 << 24) << 8 | indices[i];
	}
	glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
	glWindowPos3f(5, 6, .0625);
	if (depths)
		glDrawPixels(IW, IH, format, GL_UNSIGNED_INT_24_8, image);
	else
		glDrawPixels(IW, IH, format, GL_UNSIGNED_BYTE, indices);
	glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
	after = read_packed(&p);
	for (int i = 0; i < K * W * H && pass; i++) {
		const int x = i % W - 5, y = i / W % H - 6;
		const bool in = i < W * H && x >= 0 && x < IW && y >= 0 &&
			y < IH;
		const uint32_t mask = !in ? 0 : depths ? ~0u : 0xff;
		const uint32_t wanted = (before[i] & ~mask) |
			((in ? image[y * IW + x] : 0) & mask);
		const int off = (int)(after[i] >> 8) - (int)(wanted >> 8);

		pass = (after[i] & 0xff) == (wanted & 0xff) &&
			abs(off) <= (in && depths);
		if (!pass)
			printf("texel %d of layer %d: %08x, expected %08x\n",
			       i % (W * H), i / (W * H), after[i], wanted);
	}
	colors[1] = peel_read_color(&p, 0);
	if (memcmp(colors[0], colors[1], K * W * H * 16) != 0) {
		printf("the colors have changed\n");
		pass = false;
	}
	free(before);
	free(after);
	free(colors[0]);
	free(colors[1]);
	return peel_end(&p, peel_check_overflow(&p) && pass);
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("draw-pixels", draw_pixels, NULL),
	KB_SUBTEST("draw-pixels-zoomed", zoomed, NULL),
	KB_SUBTEST("draw-depths", draw_depths, NULL),
	KB_SUBTEST("draw-stencil", draw_stencil, GL_STENCIL_INDEX),
	KB_SUBTEST("draw-depths-and-stencil", draw_stencil, GL_DEPTH_STENCIL),
	KB_SUBTEST("bitmap", bitmap, NULL),
	KB_SUBTEST("bitmaps-of-one-depth", bitmaps_of_one_depth, NULL),
	KB_SUBTEST("copy-pixels", copy_pixels, NULL),
	KB_SUBTEST("copy-depths", copy_depths, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
