/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-multisample.c
 * A look at the samples of the layers of a multisample framebuffer.
 */

#include "peel-common.h"

/** The code of a component from what texelFetch gave, as bits. */
static uint32_t
code_of(const struct peel_format *format, int component, uint32_t bits)
{
	const int b = format->bits[component];
	const uint32_t mask = b == 32 ? ~0u : (1u << b) - 1;
	float value;

	if (b == 0)
		return 0;
	memcpy(&value, &bits, 4);
	switch (format->kind) {
	case PEEL_UNORM:
		return lrintf(value * mask);
	case PEEL_SNORM:
		return (uint32_t)lrintf(value * (mask / 2)) & mask;
	case PEEL_FLOAT:
		/* 10 and 11 bits are those of a half but for the sign. */
		return b == 32 ? bits : piglit_half_from_float(value) >>
			(b == 16 ? 0 : 15 - b);
	case PEEL_DEPTH:
		return b == 32 ? bits : llrint((double)value * mask);
	default:
		return bits & mask;
	}
}

/**
 * What reads texels: a picture in which sample s of layer l is the tile in
 * column s of row l.  Made once; it outlives the subtests.
 */
static struct reader {
	GLuint fbo, tex;
	GLuint programs[3];     /**< for floats, int, uint */
} reader;

static GLuint
make_program(const char *prefix)
{
	char *fs;
	GLuint program;

	if (asprintf(&fs,
		     "#version 150 compatibility\n"
		     "#extension GL_ARB_shader_bit_encoding: require\n"
		     "uniform %ssampler2DMSArray t;\nuniform ivec2 size;\n"
		     "out uvec4 o;\n"
		     "void main() {\n"
		     "  ivec2 p = ivec2(gl_FragCoord.xy);\n"
		     "  ivec3 at = ivec3(p %% size, p.y / size.y);\n"
		     "  o = %s(texelFetch(t, at, p.x / size.x));\n}\n", prefix,
		     *prefix ? "uvec4" : "floatBitsToUint") < 0)
		abort();
	program = piglit_build_simple_program(
		"#version 150 compatibility\n"
		"void main() { gl_Position = gl_Vertex; }\n", fs);
	free(fs);
	return program;
}

/** Draw the picture and read it. */
static uint32_t *
read_picture(const struct peel *p, GLuint tex, enum peel_kind kind)
{
	static const char *const prefixes[3] = { "", "i", "u" };
	const int type = kind == PEEL_INT ? 1 : kind == PEEL_UINT ? 2 : 0;
	const int w = p->width * p->samples, h = p->height * p->layers;
	uint32_t *texels = malloc(w * h * 16);
	const struct kb whole = { .width = w, .height = h };
	GLint old;

	glGetIntegerv(GL_CURRENT_PROGRAM, &old);
	glPushAttrib(GL_ALL_ATTRIB_BITS);
	glDisable(GL_DEPTH_PEELING_MESA);
	glDisable(GL_DEPTH_TEST);
	glDisable(GL_SCISSOR_TEST);
	glDisable(GL_ALPHA_TEST);
	glDisable(GL_CULL_FACE);
	glDisable(GL_POLYGON_STIPPLE);
	glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
	glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
	if (!reader.fbo) {
		glGenFramebuffers(1, &reader.fbo);
		glGenTextures(1, &reader.tex);
	}
	glBindFramebuffer(GL_FRAMEBUFFER, reader.fbo);
	glBindTexture(GL_TEXTURE_2D, reader.tex);
	glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32UI, w, h, 0, GL_RGBA_INTEGER,
		     GL_UNSIGNED_INT, NULL);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, reader.tex,
			     0);
	glDrawBuffer(GL_COLOR_ATTACHMENT0);
	glReadBuffer(GL_COLOR_ATTACHMENT0);
	glViewport(0, 0, w, h);
	if (!reader.programs[type])
		reader.programs[type] = make_program(prefixes[type]);
	glUseProgram(reader.programs[type]);
	glUniform2i(glGetUniformLocation(reader.programs[type], "size"),
		    p->width, p->height);
	glBindTexture(GL_TEXTURE_2D_MULTISAMPLE_ARRAY, tex);
	kb_draw(&whole);
	glReadPixels(0, 0, w, h, GL_RGBA_INTEGER, GL_UNSIGNED_INT, texels);
	glBindTexture(GL_TEXTURE_2D_MULTISAMPLE_ARRAY, 0);
	glBindTexture(GL_TEXTURE_2D, 0);
	glBindFramebuffer(GL_FRAMEBUFFER, p->fbo);
	glPopAttrib();
	glUseProgram(old);
	return texels;
}

uint32_t *
peel_read_samples(const struct peel *p, GLuint tex,
		  const struct peel_format *format)
{
	const int n = format->kind == PEEL_DEPTH ? 1 : 4;
	const int area = p->width * p->height;
	uint32_t *codes = malloc(p->samples * p->layers * area * n * 4);
	uint32_t *texels = read_picture(p, tex, format->kind);

	for (int i = 0; i < p->samples * p->layers * area; i++) {
		const int s = i / area / p->layers, l = i / area % p->layers;
		const int x = s * p->width + i % p->width;
		const int y = l * p->height + i % area / p->width;
		const uint32_t *texel = texels +
			4 * (y * p->width * p->samples + x);

		for (int c = 0; c < n; c++)
			codes[i * n + c] = code_of(format, c, texel[c]);
	}
	free(texels);
	return codes;
}
