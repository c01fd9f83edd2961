/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-color-formats.c
 * Colors of every format are converted once, when they are inserted, and then
 * move from layer to layer as bits.
 */

#include "peel-common.h"

#define K 5
#define NUM 12

static struct peel
make(GLenum format)
{
	return peel_create(&(struct peel_shape) {
		K, 19, 9, 0, GL_DEPTH_COMPONENT32F, { format } });
}

static void
random_quads(struct peel_quad *quads, int n)
{
	peel_seed(n);
	for (int i = 0; i < n; i++)
		quads[i] = (struct peel_quad) {
			peel_random(8), peel_random(4), 19 - peel_random(8),
			9 - peel_random(4), (i + 1) / 16., i
		};
	peel_shuffle(quads, n);
}

static enum piglit_result
format(void *data)
{
	struct peel p = make(*(const GLenum *)data);
	struct peel_quad quads[NUM];

	random_quads(quads, NUM);
	peel_draw(&p, quads, NUM);
	return peel_end(&p, peel_check_ranks(&p, quads, NUM) &&
			peel_check(&p));
}

/** The color that is inserted is encoded, those that move are not. */
static enum piglit_result
srgb(void *data)
{
	struct peel p = make(GL_SRGB8_ALPHA8);
	struct peel_vertex vertices[3 * NUM];

	glEnable(GL_FRAMEBUFFER_SRGB);
	peel_seed(1);
	peel_random_triangles(vertices, NUM, 1);
	peel_draw_captured(&p, GL_TRIANGLES, vertices, 3 * NUM);
	return peel_end(&p, peel_check(&p));
}

/** The same layers with the encoding, and without it. */
static enum piglit_result
srgb_switched(void *data)
{
	struct peel p = make(GL_SRGB8_ALPHA8);
	struct peel_vertex vertices[3 * NUM];

	peel_seed(2);
	for (int i = 0; i < 6; i++) {
		if (i % 2)
			glEnable(GL_FRAMEBUFFER_SRGB);
		else
			glDisable(GL_FRAMEBUFFER_SRGB);
		peel_random_triangles(vertices, 3, 3 * i);
		peel_draw_captured(&p, GL_TRIANGLES, vertices, 9);
	}
	return peel_end(&p, peel_check(&p));
}

/** Colors beyond 0 and 1, which fragment color clamping may limit. */
static enum piglit_result
clamped(void *data)
{
	static const GLenum formats[] = {
		GL_RGBA8, GL_RGBA16F, GL_RGBA32F, GL_RGB10_A2,
		GL_R11F_G11F_B10F,
	};
	const GLenum clamp = *(const GLenum *)data;
	bool pass = true;

	for (int i = 0; i < ARRAY_SIZE(formats) && pass; i++) {
		struct peel p = make(formats[i]);
		struct peel_vertex vertices[3 * NUM];

		p.program = kb_use_glsl(
			"#version 150 compatibility\n"
			"void main() { gl_Position = gl_Vertex; }\n", NULL,
			"#version 150 compatibility\nout vec4 o;\n"
			"void main() { vec2 p = gl_FragCoord.xy;\n"
			"  o = vec4(p.x / 8.0 - 1.0, 2.0 - p.y / 4.0,\n"
			"           p.x / 4.0, -p.y); }\n");
		glClampColor(GL_CLAMP_FRAGMENT_COLOR, clamp);
		peel_seed(3);
		peel_random_triangles(vertices, NUM, 1);
		peel_draw_captured(&p, GL_TRIANGLES, vertices, 3 * NUM);
		pass = peel_check(&p);
		if (!pass)
			printf("in %s\n", piglit_get_gl_enum_name(formats[i]));
		peel_end(&p, pass);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/**
 * Any bits, NaN with a payload among them, that were in the layers before: the
 * fragments that come in front move them back.
 */
static enum piglit_result
moved_bits(void *data)
{
	struct peel p = make(*(const GLenum *)data);
	const int area = p.width * p.height;
	const int bytes = K * area * peel_texel_size(p.color[0]);
	uint8_t *texels = malloc(bytes);
	float *depths = malloc(K * area * 4);
	const struct peel_quad quads[2] = {
		peel_full(&p, .25, 7), { 3, 2, 15, 8, .6875, 8 }
	};
	uint32_t *codes;
	bool pass;

	peel_seed(6);
	for (int i = 0; i < bytes; i++)
		texels[i] = peel_random(256);
	/* So that a third of the floats are NaN or infinite. */
	for (int i = 0; i < bytes; i += 1 + peel_random(7)) {
		texels[i] |= 0x7f;
		if (i > 0)
			texels[i - 1] |= 0xf0;
	}
	for (int i = 0; i < K * area; i++)
		depths[i] = (8 + i / area) / 16.;
	glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
	glBindTexture(GL_TEXTURE_2D_ARRAY, p.color_tex[0]);
	glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, p.width, p.height, K,
			p.color[0]->format, p.color[0]->type, texels);
	glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
	glBindTexture(GL_TEXTURE_2D_ARRAY, p.depth_tex);
	glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, p.width, p.height, K,
			GL_DEPTH_COMPONENT, GL_FLOAT, depths);

	/* The model begins with the bits as they are now. */
	codes = peel_read_color(&p, 0);
	for (int i = 0; i < K * area; i++) {
		const int at = i % area * K + i / area;

		memcpy(p.model.color[at], codes + 4 * i, 16);
		p.model.depth[at] = peel_depth_code(p.depth, depths[i]);
	}
	peel_draw(&p, quads, 2);
	pass = peel_check(&p);
	free(codes);
	free(depths);
	free(texels);
	return peel_end(&p, pass);
}

#define FORMAT(name) \
	{ #name, #name, format, (void *)&(const GLenum) { GL_##name } }, \
	{ #name "-bits", #name "-bits", moved_bits, \
	  (void *)&(const GLenum) { GL_##name } }

static const GLenum clamp = GL_TRUE, no_clamp = GL_FALSE;

const struct piglit_subtest kbuffer_subtests[] = {
	FORMAT(R8),
	FORMAT(RG8),
	FORMAT(RGB8),
	FORMAT(RGBA8),
	FORMAT(SRGB8_ALPHA8),
	FORMAT(RGBA8_SNORM),
	FORMAT(RGB565),
	FORMAT(RGBA4),
	FORMAT(RGB5_A1),
	FORMAT(RGB10_A2),
	FORMAT(RGB10_A2UI),
	FORMAT(R16),
	FORMAT(RGBA16),
	FORMAT(RGBA16_SNORM),
	FORMAT(R11F_G11F_B10F),
	FORMAT(R16F),
	FORMAT(RG16F),
	FORMAT(RGBA16F),
	FORMAT(R32F),
	FORMAT(RG32F),
	FORMAT(RGBA32F),
	FORMAT(R8UI),
	FORMAT(RGBA8UI),
	FORMAT(RGBA8I),
	FORMAT(R16UI),
	FORMAT(RG16I),
	FORMAT(RGBA16UI),
	FORMAT(R32UI),
	FORMAT(R32I),
	FORMAT(RG32UI),
	FORMAT(RGBA32UI),
	FORMAT(RGBA32I),
	KB_SUBTEST("clamped", clamped, &clamp),
	KB_SUBTEST("not-clamped", clamped, &no_clamp),
	KB_SUBTEST("srgb", srgb, NULL),
	KB_SUBTEST("srgb-switched", srgb_switched, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
