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
		return b == 32 ? bits : piglit_half_from_float(value);
	case PEEL_DEPTH:
		return b == 32 ? bits : llrint((double)value * mask);
	default:
		return bits & mask;
	}
}

uint32_t *
peel_read_samples(const struct peel *p, GLuint tex,
		  const struct peel_format *format)
{
	const char *type = format->kind == PEEL_UINT ? "u" :
		format->kind == PEEL_INT ? "i" : "";
	const int n = format->kind == PEEL_DEPTH ? 1 : 4;
	const int area = p->width * p->height;
	uint32_t *codes = malloc(p->samples * p->layers * area * n * 4);
	uint32_t *texels = malloc(area * 16);
	struct kb out;
	GLuint program;
	GLint old;
	char *fs;

	if (asprintf(&fs,
		     "#version 150 compatibility\n"
		     "#extension GL_ARB_shader_bit_encoding: require\n"
		     "uniform %ssampler2DMSArray t;\nuniform int layer, s;\n"
		     "out uvec4 o;\n"
		     "void main() {\n"
		     "  ivec3 p = ivec3(gl_FragCoord.xy, layer);\n"
		     "  o = %s(texelFetch(t, p, s));\n}\n", type,
		     *type ? "uvec4" : "floatBitsToUint") < 0)
		abort();
	glGetIntegerv(GL_CURRENT_PROGRAM, &old);
	glPushAttrib(GL_ALL_ATTRIB_BITS);
	glDisable(GL_DEPTH_PEELING_MESA);
	glDisable(GL_SCISSOR_TEST);
	glDisable(GL_ALPHA_TEST);
	glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
	out = kb_create(GL_RGBA32UI, 0, 0, p->width, p->height);
	out.tex[0] = kb_new_texture();
	glBindTexture(GL_TEXTURE_2D, out.tex[0]);
	glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32UI, p->width, p->height, 0,
		     GL_RGBA_INTEGER, GL_UNSIGNED_INT, NULL);
	glBindTexture(GL_TEXTURE_2D, 0);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, out.tex[0],
			     0);
	glDrawBuffer(GL_COLOR_ATTACHMENT0);
	program = kb_use_glsl("#version 130\n"
			      "void main() { gl_Position = gl_Vertex; }\n",
			      NULL, fs);
	glBindTexture(GL_TEXTURE_2D_MULTISAMPLE_ARRAY, tex);
	for (int i = 0; i < p->samples * p->layers; i++) {
		glUniform1i(glGetUniformLocation(program, "layer"),
			    i % p->layers);
		glUniform1i(glGetUniformLocation(program, "s"), i / p->layers);
		kb_draw(&out);
		glReadPixels(0, 0, p->width, p->height, GL_RGBA_INTEGER,
			     GL_UNSIGNED_INT, texels);
		for (int j = 0; j < area * n; j++)
			codes[i * area * n + j] = code_of(format, j % n,
				texels[j / n * 4 + j % n]);
	}
	glBindTexture(GL_TEXTURE_2D_MULTISAMPLE_ARRAY, 0);
	glBindFramebuffer(GL_FRAMEBUFFER, p->fbo);
	glPopAttrib();
	glUseProgram(old);
	free(texels);
	free(fs);
	return codes;
}
