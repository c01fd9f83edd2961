/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-meta-ops.c
 * Blits, ReadPixels, copies, texture uploads, clears of textures and mipmap
 * generation are not affected: with peeling enabled they do to the layers and
 * to others what they do without it, and count neither as fallen out nor as
 * drawn.  (Clears of framebuffers are in peel-clear.c.)
 */

#include "peel-common.h"

#define W 32
#define LAYERS 3

/** What an operation gave, beside what it did to the layers. */
struct output { float pixels[W * W][4]; };

static void
draw_scene(struct peel *p)
{
	for (int i = 0; i < LAYERS; i++) {
		const struct peel_quad q = {
			i, 2 * i, W - 3 * i, W - i, (7 - 2 * i) / 8.f, i + 1
		};

		peel_draw(p, &q, 1);
	}
}

/** A plain framebuffer of one color, which is left bound for reading. */
static struct kb
other(const struct peel *p, float r, float g, float b, float a)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);

	kb_attach_depth(&kb, GL_DEPTH_COMPONENT32F);
	kb_fill(&kb, 0, r, g, b, a);
	glClearDepth(.0625);
	glClear(GL_DEPTH_BUFFER_BIT);
	glClearDepth(1);
	glBindFramebuffer(GL_DRAW_FRAMEBUFFER, p->fbo);
	return kb;
}

static void
get(const struct kb *kb, struct output *out)
{
	float *pixels = kb_read(kb, 0);

	memcpy(out->pixels, pixels, sizeof(out->pixels));
	free(pixels);
}

/** Of layer 0 to another framebuffer; while it is bound drawing is an error. */
static void
blit_from(struct peel *p, struct output *out)
{
	struct kb to = other(p, 0, 0, 0, 0);

	glBindFramebuffer(GL_READ_FRAMEBUFFER, p->fbo);
	glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to.fbo);
	glBlitFramebuffer(0, 0, W, W, 3, 3, W - 4, W - 4, GL_COLOR_BUFFER_BIT,
			  GL_LINEAR);
	get(&to, out);
}

/** To layer 0, on which neither depths nor ranks have a say. */
static void
blit_to(struct peel *p, struct output *out)
{
	other(p, .2, .4, .6, .8);
	glBlitFramebuffer(0, 0, W, W, 5, 6, W, W - 7, GL_COLOR_BUFFER_BIT,
			  GL_NEAREST);
}

static void
blit_depth(struct peel *p, struct output *out)
{
	other(p, .2, .4, .6, .8);
	glBlitFramebuffer(0, 0, W, W, 0, 0, W, W, GL_DEPTH_BUFFER_BIT,
			  GL_NEAREST);
}

/** Conversions that drivers do by drawing. */
static void
read_pixels(struct peel *p, struct output *out)
{
	GLuint buffer;

	glGenBuffers(1, &buffer);
	glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
	glBufferData(GL_PIXEL_PACK_BUFFER, sizeof(*out), NULL, GL_STREAM_READ);
	glReadPixels(0, 0, W, W, GL_BGRA, GL_FLOAT, NULL);
	glGetBufferSubData(GL_PIXEL_PACK_BUFFER, 0, sizeof(*out), out);
	glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
	glDeleteBuffers(1, &buffer);
}

static void
copy_tex_sub_image(struct peel *p, struct output *out)
{
	struct kb to = other(p, .5, .5, .5, .5);

	glBindFramebuffer(GL_FRAMEBUFFER, p->fbo);
	glBindTexture(GL_TEXTURE_2D, to.tex[0]);
	glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 4, 5, 0, 0, W - 8, W - 8);
	get(&to, out);
}

/** From a buffer object, to two of the layers. */
static void
tex_sub_image(struct peel *p, struct output *out)
{
	float (*texels)[4] = malloc(2 * W * W * 16);
	GLuint buffer;

	for (int i = 0; i < 2 * W * W; i++) {
		for (int c = 0; c < 4; c++)
			texels[i][c] = (4 * i + c) % 256 / 255.f;
	}
	glGenBuffers(1, &buffer);
	glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer);
	glBufferData(GL_PIXEL_UNPACK_BUFFER, 2 * W * W * 16, texels,
		     GL_STREAM_DRAW);
	glBindTexture(GL_TEXTURE_2D_ARRAY, p->color_tex[0]);
	glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, 1, W, W, 2, GL_RGBA,
			GL_FLOAT, NULL);
	glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
	glDeleteBuffers(1, &buffer);
	free(texels);
}

/** Of the layers' own texture: its first level is as before. */
static void
generate_mipmap(struct peel *p, struct output *out)
{
	float (*texels)[4] = malloc(LAYERS * W * W / 4 * 16);

	glBindTexture(GL_TEXTURE_2D_ARRAY, p->color_tex[0]);
	glGenerateMipmap(GL_TEXTURE_2D_ARRAY);
	glGetTexImage(GL_TEXTURE_2D_ARRAY, 1, GL_RGBA, GL_FLOAT, texels);
	memcpy(out, texels, LAYERS * W * W / 4 * 16);
	free(texels);
}

static void
clear_texture(struct peel *p, struct output *out)
{
	const GLubyte color[4] = { 10, 20, 30, 40 };
	const GLfloat depth = .03125;

	glClearTexSubImage(p->color_tex[0], 0, 3, 4, 1, 10, 20, 2, GL_RGBA,
			   GL_UNSIGNED_BYTE, color);
	glClearTexSubImage(p->depth_tex, 0, 1, 2, 0, 20, 10, 2,
			   GL_DEPTH_COMPONENT, GL_FLOAT, &depth);
}

static void
copy_image(struct peel *p, struct output *out)
{
	glCopyImageSubData(p->color_tex[0], GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0,
			   p->color_tex[0], GL_TEXTURE_2D_ARRAY, 0, 8, 8, 2,
			   W / 2, W / 2, 1);
}

/** The bits of all layers. */
static uint32_t *
layers(const struct peel *p)
{
	const size_t n = LAYERS * W * W;
	uint32_t *all = malloc(5 * n * 4);
	uint32_t *color = peel_read_color(p, 0), *depth = peel_read_depth(p);

	memcpy(all, color, 4 * n * 4);
	memcpy(all + 4 * n, depth, n * 4);
	free(color);
	free(depth);
	return all;
}

struct operation {
	const char *extension;
	void (*run)(struct peel *p, struct output *out);
};

static enum piglit_result
operation(void *data)
{
	const struct operation *o = data;
	const size_t size = 5 * LAYERS * W * W * 4;
	static struct output out[2];
	static const struct output nothing;
	uint32_t *before = NULL, *after[2];
	bool pass = true;

	if (o->extension && !piglit_is_extension_supported(o->extension)) {
		printf("no %s here\n", o->extension);
		return PIGLIT_SKIP;
	}
	memset(out, 0, sizeof(out));
	for (int enabled = 0; enabled < 2; enabled++) {
		struct peel p = peel_create(&(struct peel_shape) {
			LAYERS, W, W, 0, GL_DEPTH_COMPONENT32F,
			{ GL_RGBA8 } });

		glReadBuffer(GL_COLOR_ATTACHMENT0);
		draw_scene(&p);
		pass = peel_check(&p) && pass;
		if (!enabled)
			before = layers(&p);
		if (!enabled)
			glDisable(GL_DEPTH_PEELING_MESA);
		o->run(&p, &out[enabled]);
		glBindFramebuffer(GL_FRAMEBUFFER, p.fbo);
		after[enabled] = layers(&p);
		pass = peel_check_overflow(&p) && pass;
		glDisable(GL_DEPTH_PEELING_MESA);
		peel_end(&p, true);
	}
	if (memcmp(&out[0], &nothing, sizeof(nothing)) == 0 &&
	    memcmp(before, after[0], size) == 0) {
		printf("nothing has been done\n");
		pass = false;
	}
	if (memcmp(&out[0], &out[1], sizeof(out[0])) != 0) {
		printf("the output is another with peeling enabled\n");
		pass = false;
	}
	if (memcmp(after[0], after[1], size) != 0) {
		printf("the layers are others with peeling enabled\n");
		pass = false;
	}
	free(before);
	free(after[0]);
	free(after[1]);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

#define OPERATION(name, extension, run) \
	KB_SUBTEST(name, operation, (&(struct operation) { extension, run }))

const struct piglit_subtest kbuffer_subtests[] = {
	OPERATION("BlitFramebuffer-from", NULL, blit_from),
	OPERATION("BlitFramebuffer-to", NULL, blit_to),
	OPERATION("BlitFramebuffer-depth", NULL, blit_depth),
	OPERATION("ReadPixels", NULL, read_pixels),
	OPERATION("CopyTexSubImage", NULL, copy_tex_sub_image),
	OPERATION("TexSubImage-from-buffer", NULL, tex_sub_image),
	OPERATION("GenerateMipmap", NULL, generate_mipmap),
	OPERATION("ClearTexSubImage", "GL_ARB_clear_texture", clear_texture),
	OPERATION("CopyImageSubData", "GL_ARB_copy_image", copy_image),
	KB_SUBTEST_END
};

PEEL_TEST(32)
