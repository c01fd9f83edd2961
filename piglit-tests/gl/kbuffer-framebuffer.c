/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-framebuffer.c
 * Framebuffers that the tests draw to: made, filled, read, compared.
 */

#include "kbuffer-common.h"

struct kb
kb_create(GLenum format, int attachments, int layers, int width, int height)
{
	struct kb kb = {
		.target = layers ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D,
		.format = format, .attachments = attachments,
		.layers = layers, .width = width, .height = height,
	};
	GLenum buffers[KB_MAX_ATTACHMENTS];
	static const float zero[4];

	kb.fbo = kb_new_framebuffer();
	glBindFramebuffer(GL_FRAMEBUFFER, kb.fbo);

	for (int i = 0; i < attachments; i++) {
		kb.tex[i] = kb_new_texture();
		glBindTexture(kb.target, kb.tex[i]);
		glTexParameteri(kb.target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
		glTexParameteri(kb.target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
		if (layers)
			glTexImage3D(kb.target, 0, format, width, height,
				     layers, 0, GL_RGBA, GL_FLOAT, NULL);
		else
			glTexImage2D(kb.target, 0, format, width, height,
				     0, GL_RGBA, GL_FLOAT, NULL);
		buffers[i] = GL_COLOR_ATTACHMENT0 + i;
		glFramebufferTexture(GL_FRAMEBUFFER, buffers[i], kb.tex[i], 0);
	}
	glBindTexture(kb.target, 0);
	glDrawBuffers(attachments, buffers);
	glViewport(0, 0, width, height);

	if (attachments) {
		GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);

		if (status != GL_FRAMEBUFFER_COMPLETE) {
			printf("%s x %d x %d layers: framebuffer is %s\n",
			       piglit_get_gl_enum_name(format), attachments,
			       layers, piglit_get_gl_enum_name(status));
			piglit_report_result(PIGLIT_FAIL);
		}
		for (int i = 0; i < attachments; i++)
			glClearBufferfv(GL_COLOR, i, zero);
	}
	return kb;
}

void
kb_attach_depth(const struct kb *kb, GLenum format)
{
	GLuint tex = kb_new_texture();

	glBindTexture(kb->target, tex);
	if (kb->layers)
		glTexImage3D(kb->target, 0, format, kb->width, kb->height,
			     kb->layers, 0, GL_DEPTH_COMPONENT, GL_FLOAT, NULL);
	else
		glTexImage2D(kb->target, 0, format, kb->width, kb->height,
			     0, GL_DEPTH_COMPONENT, GL_FLOAT, NULL);
	glBindTexture(kb->target, 0);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, tex, 0);
}

int
kb_entries(const struct kb *kb)
{
	return kb->attachments * MAX2(kb->layers, 1);
}

/** Bind a color texture of the framebuffer; returns what was bound. */
static GLuint
bind(const struct kb *kb, GLuint tex)
{
	GLint bound;

	glGetIntegerv(kb->layers ? GL_TEXTURE_BINDING_2D_ARRAY :
		      GL_TEXTURE_BINDING_2D, &bound);
	glBindTexture(kb->target, tex);
	return bound;
}

void
kb_upload(const struct kb *kb, int entry, const void *pixels)
{
	GLuint bound = bind(kb, kb->tex[entry % kb->attachments]);

	if (kb->layers)
		glTexSubImage3D(kb->target, 0, 0, 0, entry / kb->attachments,
				kb->width, kb->height, 1, GL_RGBA, GL_FLOAT,
				pixels);
	else
		glTexSubImage2D(kb->target, 0, 0, 0, kb->width, kb->height,
				GL_RGBA, GL_FLOAT, pixels);
	bind(kb, bound);
}

void
kb_fill_bits(const struct kb *kb, int entry, const uint32_t bits[4])
{
	const int n = kb->width * kb->height;
	uint32_t *pixels = malloc(n * 16);

	for (int i = 0; i < n; i++)
		memcpy(pixels + 4 * i, bits, 16);
	kb_upload(kb, entry, pixels);
	free(pixels);
}

void
kb_fill(const struct kb *kb, int entry, float r, float g, float b, float a)
{
	const float value[4] = { r, g, b, a };
	uint32_t bits[4];

	memcpy(bits, value, sizeof(bits));
	kb_fill_bits(kb, entry, bits);
}

float *
kb_read(const struct kb *kb, int entry)
{
	const size_t layer_size = kb->width * kb->height * 4;
	float *all = malloc(layer_size * MAX2(kb->layers, 1) * sizeof(float));
	GLuint bound = bind(kb, kb->tex[entry % kb->attachments]);

	glGetTexImage(kb->target, 0, GL_RGBA, GL_FLOAT, all);
	bind(kb, bound);
	memmove(all, all + layer_size * (entry / kb->attachments),
		layer_size * sizeof(float));
	return all;
}

static bool
expect(const struct kb *kb, int entry, int x0, int y0, int x1, int y1,
       const float value[4], const float *tolerance)
{
	float *pixels = kb_read(kb, entry);
	bool pass = true;

	for (int y = y0; y < y1 && pass; y++) {
		for (int x = x0; x < x1 && pass; x++) {
			const float *p = pixels + 4 * (y * kb->width + x);

			for (int c = 0; c < 4; c++) {
				if (tolerance ?
				    !(fabsf(p[c] - value[c]) <= *tolerance) :
				    memcmp(p + c, value + c, 4) != 0)
					pass = false;
			}
			if (pass)
				continue;

			uint32_t e[4], o[4];
			memcpy(e, value, sizeof(e));
			memcpy(o, p, sizeof(o));
			printf("entry %d at (%d, %d)\n"
			       "  expected %.9g %.9g %.9g %.9g (%08x %08x %08x %08x)\n"
			       "  observed %.9g %.9g %.9g %.9g (%08x %08x %08x %08x)\n",
			       entry, x, y, value[0], value[1], value[2],
			       value[3], e[0], e[1], e[2], e[3], p[0], p[1],
			       p[2], p[3], o[0], o[1], o[2], o[3]);
		}
	}
	free(pixels);
	return pass;
}

bool
kb_expect(const struct kb *kb, int entry, float tolerance,
	  float r, float g, float b, float a)
{
	const float value[4] = { r, g, b, a };

	return expect(kb, entry, 0, 0, kb->width, kb->height, value,
		      &tolerance);
}

bool
kb_expect_rect(const struct kb *kb, int entry, int x, int y, int w, int h,
	       float tolerance, float r, float g, float b, float a)
{
	const float value[4] = { r, g, b, a };

	return expect(kb, entry, x, y, x + w, y + h, value, &tolerance);
}

bool
kb_expect_only_rect(const struct kb *kb, int entry, int x, int y, int w, int h,
		    const float inside[4], const float outside[4])
{
	return expect(kb, entry, x, y, x + w, y + h, inside, NULL) &&
	       expect(kb, entry, 0, 0, x, kb->height, outside, NULL) &&
	       expect(kb, entry, x + w, 0, kb->width, kb->height, outside,
		      NULL) &&
	       expect(kb, entry, x, 0, x + w, y, outside, NULL) &&
	       expect(kb, entry, x, y + h, x + w, kb->height, outside, NULL);
}

bool
kb_expect_bits(const struct kb *kb, int entry, const uint32_t bits[4])
{
	float value[4];

	memcpy(value, bits, sizeof(value));
	return expect(kb, entry, 0, 0, kb->width, kb->height, value, NULL);
}
