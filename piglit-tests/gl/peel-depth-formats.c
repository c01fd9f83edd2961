/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-depth-formats.c
 * The depth that counts is the one that is stored: every depth format keeps
 * neighbouring depths apart and in order, depths that it stores as one are
 * ties, and stencil bits stay.
 */

#include "peel-common.h"

#define K 16

static struct peel
make(GLenum format, int layers)
{
	return peel_create(&(struct peel_shape) {
		layers, 17, 10, 0, format, { GL_R32UI } });
}

/** Depths one code apart, from both ends and around the middle. */
static enum piglit_result
neighbours(void *data)
{
	const GLenum format = *(const GLenum *)data;
	const struct peel_format *f = peel_format(format);
	/* No denormals; .25, .5 and .75 are where the steps of floats change. */
	const uint32_t smallest = f->bits[0] == 32 ? 0x00800000 : 1;
	const uint32_t starts[] = {
		smallest, peel_depth_code(f, .25) - K / 2,
		peel_depth_code(f, .5) - K / 2, peel_depth_code(f, .75),
		peel_max_depth(f) - K,
	};
	bool pass = true;

	for (int s = 0; s < 2 * ARRAY_SIZE(starts) && pass; s++) {
		struct peel p = make(format, K);
		struct peel_quad quads[K];

		peel_seed(s);
		glDepthFunc(s % 2 ? GL_GREATER : GL_LESS);
		glClearDepth(s % 2 ? 0 : 1);
		peel_clear(&p);
		for (int i = 0; i < K; i++)
			quads[i] = peel_full(&p, peel_depth(f, starts[s / 2] +
							    i), i);
		peel_shuffle(quads, K);
		peel_draw(&p, quads, K);
		pass = peel_check_ranks(&p, quads, K) && peel_check(&p);
		/* All of them, none merged with another. */
		for (int i = 0; i + 1 < K && pass; i++)
			pass = p.model.depth[i] != p.model.depth[i + 1];
		if (!pass)
			printf("neighbours of %08x\n", starts[s / 2]);
		peel_end(&p, pass);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/**
 * Depths that differ but are stored as one code keep the order of arrival,
 * and none is lost: 8 planes for each code, farthest first.
 */
static enum piglit_result
merged(void *data)
{
	const GLenum format = *(const GLenum *)data;
	struct peel p = make(format, 32);
	const uint32_t codes = peel_max_depth(p.depth);
	struct peel_quad quads[32];
	bool pass;

	for (int i = 0; i < 32; i++) {
		struct peel_vertex vertices[3];
		const uint32_t code = codes / 3 + i % 4;

		/* From 0.4 of a code above it to 0.1. */
		for (int j = 0; j < 3; j++)
			vertices[j] = (struct peel_vertex) {
				j == 1 ? 3 : -1, j == 2 ? 3 : -1,
				(code + .4 - i / 4 * .04) / codes, 1, i
			};
		peel_draw_vertices(GL_TRIANGLES, vertices, 3);
		quads[i] = peel_full(&p, peel_depth(p.depth, code), i);
		peel_draw_model(&p, &quads[i], 1);
	}
	pass = peel_check_ranks(&p, quads, 32) && peel_check(&p);
	return peel_end(&p, pass);
}

static bool
check_stencil(const struct peel *p, const uint8_t *values)
{
	const int words = peel_texel_size(p->depth) / 4;
	const int area = p->width * p->height;
	uint32_t *texels = malloc(area * p->layers * words * 4);
	bool pass = true;

	glBindTexture(GL_TEXTURE_2D_ARRAY, p->depth_tex);
	glGetTexImage(GL_TEXTURE_2D_ARRAY, 0, p->depth->format, p->depth->type,
		      texels);
	for (int i = 0; i < area * p->layers && pass; i++) {
		const uint32_t stencil = texels[i * words + words - 1] & 0xff;
		const uint8_t expected = values[i / area];

		/* 24 bits of the layer's depth are above, or nothing. */
		pass = stencil == expected;
		if (!pass)
			printf("stencil of layer %d at (%d, %d) is %02x, not "
			       "%02x\n", i / area, i % p->width,
			       i % area / p->width, stencil, expected);
	}
	free(texels);
	return pass;
}

static enum piglit_result
stencil(void *data)
{
	struct peel p = make(*(const GLenum *)data, 4);
	const uint8_t values[] = { 0x5a, 0xff, 0x00, 0xa5 };
	struct peel_quad quads[7];
	bool pass;

	/* A value for each layer. */
	for (int l = 0; l < 4; l++) {
		GLuint fbo = kb_new_framebuffer();

		glBindFramebuffer(GL_FRAMEBUFFER, fbo);
		glFramebufferTextureLayer(GL_FRAMEBUFFER,
					  GL_DEPTH_STENCIL_ATTACHMENT,
					  p.depth_tex, 0, l);
		glClearStencil(values[l]);
		glClear(GL_STENCIL_BUFFER_BIT);
	}
	glBindFramebuffer(GL_FRAMEBUFFER, p.fbo);
	/* Not the stencil test: that would be an error. */
	glStencilOp(GL_ZERO, GL_INCR, GL_INVERT);
	peel_seed(3);
	for (int i = 0; i < 7; i++) {
		quads[i] = peel_full(&p, (i + 1) / 8., i);
		quads[i].x1 -= peel_random(8);
	}
	peel_shuffle(quads, 7);
	peel_draw(&p, quads, 7);
	pass = check_stencil(&p, values) && peel_check_ranks(&p, quads, 7) &&
		peel_check(&p);
	/* Clearing the depth does not touch it either. */
	peel_clear(&p);
	pass = pass && check_stencil(&p, values);
	return peel_end(&p, pass);
}

/** Slanted depths, as the format rounds them for the depth test. */
static enum piglit_result
slanted(void *data)
{
	struct peel p = make(*(const GLenum *)data, 5);
	struct peel_vertex vertices[3 * 12];

	peel_seed(9);
	peel_random_triangles(vertices, 12, 1);
	peel_draw_captured(&p, GL_TRIANGLES, vertices, 3 * 12);
	return peel_end(&p, peel_check(&p));
}

/**
 * texelFetch gives the float that is nearest to code / (2^24 - 1), and so tells
 * all codes apart.
 */
static enum piglit_result
texel_fetch_24(void *data)
{
	enum { SIZE = 64 };
	struct kb out = kb_create(GL_RGBA32F, 1, 0, SIZE, SIZE);
	const GLuint tex = kb_new_texture();
	uint32_t codes[SIZE * SIZE], texels[SIZE * SIZE];
	float *got;
	bool pass = true;

	/* Both ends, and all magnitudes. */
	for (int i = 0; i < SIZE * SIZE; i++) {
		codes[i] = i < 1024 ? i : i < 2048 ? 0xffffff - (i - 1024) :
			(i * 2654435761u) >> (8 + i % 20);
		texels[i] = codes[i] << 8;
	}
	kb_use_glsl("#version 150 compatibility\n"
		    "void main() { gl_Position = gl_Vertex; }\n", NULL,
		    "#version 150 compatibility\n"
		    "uniform sampler2D t;\nout vec4 o;\nvoid main() { "
		    "o = texelFetch(t, ivec2(gl_FragCoord.xy), 0); }\n");
	glBindTexture(GL_TEXTURE_2D, tex);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
	glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH24_STENCIL8, SIZE, SIZE, 0,
		     GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, texels);
	kb_draw(&out);
	got = kb_read(&out, 0);
	for (int i = 0; i < SIZE * SIZE && pass; i++) {
		const float wanted = codes[i] / 16777215.0;

		pass = got[4 * i] == wanted;
		if (!pass)
			printf("%06x is fetched as %.9g, not as %.9g\n",
			       codes[i], got[4 * i], wanted);
	}
	free(got);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static const GLenum d16 = GL_DEPTH_COMPONENT16, d24 = GL_DEPTH_COMPONENT24,
	d24s8 = GL_DEPTH24_STENCIL8, d32f = GL_DEPTH_COMPONENT32F,
	d32fs8 = GL_DEPTH32F_STENCIL8;

#define FORMAT(name, format)                                            \
	KB_SUBTEST(name "-neighbours", neighbours, format),             \
	KB_SUBTEST(name "-slanted", slanted, format)

/**
 * Polygon offset leads interpolated depths out of [0, 1]: they are clamped,
 * and so are equal, in the order of arrival.
 */
static enum piglit_result
offset_out_of_range(void *data)
{
	const GLenum format = *(const GLenum *)data;
	const uint32_t max = peel_max_depth(peel_format(format));
	bool pass = true;

	for (int greater = 0; greater < 2 && pass; greater++) {
		struct peel p;

		glDepthFunc(greater ? GL_GREATER : GL_LESS);
		glClearDepth(greater ? 0 : 1);
		p = make(format, 8);
		glEnable(GL_POLYGON_OFFSET_FILL);
		for (int i = 0; i < 8; i++) {
			struct peel_quad q = peel_full(&p, (1 + i * 5 % 8) /
						       16., i);

			/* More than all depths, whatever a unit is. */
			glPolygonOffset(0, greater ? 1e9 : -1e9);
			peel_draw_gl(&p, &q, 1);
			q.z = peel_depth(p.depth, greater ? max : 0);
			peel_draw_model(&p, &q, 1);
		}
		glDisable(GL_POLYGON_OFFSET_FILL);
		pass = peel_check(&p);
		peel_end(&p, pass);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/**
 * On the near plane interpolation makes errors to both sides: no depth is
 * less than 0, in no layer, nor more than 1 on the far plane.
 */
static enum piglit_result
rounded_out_of_range(void *data)
{
	enum { NUM = 60 };
	struct peel p = peel_create(&(struct peel_shape) {
		NUM, 33, 33, 0, GL_DEPTH_COMPONENT32F, { GL_R32UI } });
	struct peel_vertex vertices[3 * NUM];
	uint32_t *depth;
	int on_plane = 0;
	bool pass = true;

	peel_seed(3);
	for (int i = 0; i < NUM; i++) {
		/* An edge through the centers of pixels lies on the plane. */
		const float y = (2 * (3 + peel_random(26)) + 1) / 33. - 1;
		const float top = y + (1 + peel_random(1000)) / 300.;
		const float z = (1 + peel_random(1000)) / 1001.;

		vertices[3 * i] = (struct peel_vertex) { -1.1, y, 0, 1, i };
		vertices[3 * i + 1] = (struct peel_vertex) { 1.3, y, 0, 1, i };
		vertices[3 * i + 2] = (struct peel_vertex) { .1, top, z, 1, i };
		/* Seen from both sides: the edge is inside of one of them. */
		if (i % 2)
			vertices[3 * i + 2].y = 2 * y - top;
	}
	peel_draw_vertices(GL_TRIANGLES, vertices, 3 * NUM);
	depth = peel_read_depth(&p);
	for (int i = 0; i < NUM * 33 * 33 && pass; i++) {
		float z;

		memcpy(&z, depth + i, sizeof(z));
		pass = z >= 0 && z <= 1;
		if (!pass)
			printf("layer %d: depth %g\n", i / (33 * 33), z);
		on_plane += z < 1e-6;
	}
	if (on_plane == 0) {
		printf("there is nothing on the near plane\n");
		pass = false;
	}
	free(depth);
	return peel_end(&p, pass);
}

const struct piglit_subtest kbuffer_subtests[] = {
	FORMAT("16", &d16),
	FORMAT("24", &d24),
	FORMAT("24-8", &d24s8),
	FORMAT("32f", &d32f),
	FORMAT("32f-8", &d32fs8),
	KB_SUBTEST("16-merged", merged, &d16),
	KB_SUBTEST("24-8-texel-fetch", texel_fetch_24, NULL),
	KB_SUBTEST("24-8-stencil", stencil, &d24s8),
	KB_SUBTEST("32f-8-stencil", stencil, &d32fs8),
	KB_SUBTEST("offset-out-of-range-16", offset_out_of_range, &d16),
	KB_SUBTEST("offset-out-of-range-24", offset_out_of_range, &d24),
	KB_SUBTEST("offset-out-of-range-32f", offset_out_of_range, &d32f),
	KB_SUBTEST("rounded-out-of-range", rounded_out_of_range, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
