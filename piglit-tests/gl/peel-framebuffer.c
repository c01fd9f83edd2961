/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-framebuffer.c
 * Layered framebuffers for depth peeling: made, read, compared with the model.
 */

#include "peel-common.h"

static GLuint
make_texture(const struct peel_shape *s, const struct peel_format *format,
	     GLenum attachment)
{
	const GLenum target = s->samples ? GL_TEXTURE_2D_MULTISAMPLE_ARRAY :
		GL_TEXTURE_2D_ARRAY;
	const GLuint tex = kb_new_texture();

	glBindTexture(target, tex);
	if (s->samples) {
		glTexImage3DMultisample(target, s->samples, format->internal,
					s->width, s->height, s->layers,
					GL_TRUE);
	} else {
		glTexImage3D(target, 0, format->internal, s->width, s->height,
			     s->layers, 0, format->format, format->type, NULL);
		glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
		glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
	}
	glBindTexture(target, 0);
	glFramebufferTexture(GL_FRAMEBUFFER, attachment, tex, 0);
	return tex;
}

struct peel
peel_create(const struct peel_shape *s)
{
	struct peel p = {
		.layers = s->layers, .width = s->width, .height = s->height,
		.samples = s->samples,
	};
	const int samples = s->width * s->height * MAX2(s->samples, 1);
	const int identity[PEEL_MAX_COLORS] = { 0, 1, 2, 3, 4, 5, 6, 7 };
	GLenum status;

	if (s->samples) {
		GLint max = 0;

		glGetIntegerv(GL_MAX_SAMPLES, &max);
		if (max < s->samples) {
			printf("there are no %d samples here\n", s->samples);
			piglit_report_result(PIGLIT_SKIP);
		}
	}
	p.fbo = kb_new_framebuffer();
	glBindFramebuffer(GL_FRAMEBUFFER, p.fbo);
	p.depth = peel_format(s->depth);
	p.depth_tex = make_texture(s, p.depth, p.depth->format ==
				   GL_DEPTH_STENCIL ?
				   GL_DEPTH_STENCIL_ATTACHMENT :
				   GL_DEPTH_ATTACHMENT);
	while (p.colors < PEEL_MAX_COLORS && s->colors[p.colors]) {
		const int a = p.colors++;

		p.color[a] = peel_format(s->colors[a]);
		p.color_tex[a] = make_texture(s, p.color[a],
					      GL_COLOR_ATTACHMENT0 + a);
	}
	peel_draw_buffers(&p, p.colors, identity);
	glViewport(0, 0, p.width, p.height);
	status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
	if (status != GL_FRAMEBUFFER_COMPLETE) {
		printf("framebuffer is %s\n", piglit_get_gl_enum_name(status));
		piglit_report_result(PIGLIT_FAIL);
	}

	p.model.depth = malloc(samples * p.layers * 4);
	p.model.color = calloc(samples * p.layers * MAX2(p.colors, 1), 16);
	p.model.bound = calloc(samples, 4);
	p.model.taken = calloc(samples, sizeof(int));
	p.model.seen = calloc(samples, sizeof(int));

	glClampColor(GL_CLAMP_FRAGMENT_COLOR, GL_FALSE);
	glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
	glEnable(GL_DEPTH_PEELING_MESA);
	peel_use_program(&p, "", "");
	peel_clear(&p);
	return p;
}

struct peel
peel_simple(int layers)
{
	return peel_create(&(struct peel_shape) {
		layers, 16, 16, 0, GL_DEPTH_COMPONENT32F, { GL_R32UI } });
}

enum piglit_result
peel_end(struct peel *p, bool pass)
{
	free(p->model.depth);
	free(p->model.color);
	free(p->model.bound);
	free(p->model.taken);
	free(p->model.seen);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

void
peel_draw_buffers(struct peel *p, int n, const int *attachments)
{
	GLenum buffers[PEEL_MAX_COLORS];

	for (int o = 0; o < PEEL_MAX_COLORS; o++) {
		p->buffers[o] = o < n ? attachments[o] : -1;
		buffers[o] = p->buffers[o] < 0 ? GL_NONE :
			GL_COLOR_ATTACHMENT0 + p->buffers[o];
	}
	glDrawBuffers(n, buffers);
	/* A framebuffer without a color buffer to read is complete, too. */
	glReadBuffer(GL_NONE);
}

/** All texels of an array texture. */
static char *
read_texture(const struct peel *p, GLuint tex,
	     const struct peel_format *format)
{
	char *texels = malloc(p->width * p->height * p->layers *
			      peel_texel_size(format));

	glPushClientAttrib(GL_CLIENT_PIXEL_STORE_BIT);
	glPixelStorei(GL_PACK_ALIGNMENT, 1);
	glBindTexture(GL_TEXTURE_2D_ARRAY, tex);
	glGetTexImage(GL_TEXTURE_2D_ARRAY, 0, format->format, format->type,
		      texels);
	glBindTexture(GL_TEXTURE_2D_ARRAY, 0);
	glPopClientAttrib();
	return texels;
}

uint32_t *
peel_read_color(const struct peel *p, int attachment)
{
	const struct peel_format *format = p->color[attachment];
	const int n = p->width * p->height * p->layers;
	const int size = peel_texel_size(format);
	char *texels = read_texture(p, p->color_tex[attachment], format);
	uint32_t *codes = malloc(n * 16);

	for (int i = 0; i < n; i++)
		peel_unpack(format, texels + i * size, codes + 4 * i);
	free(texels);
	return codes;
}

uint32_t *
peel_read_depth(const struct peel *p)
{
	const int n = p->width * p->height * p->layers;
	const int size = peel_texel_size(p->depth);
	char *texels = read_texture(p, p->depth_tex, p->depth);
	uint32_t *codes = malloc(n * 4);

	for (int i = 0; i < n; i++)
		codes[i] = peel_unpack_depth(p->depth, texels + i * size);
	free(texels);
	return codes;
}

/**
 * Compare one attachment (-1: depth), read in the order sample, layer, y, x,
 * with the model.
 */
static bool
compare(const struct peel *p, int attachment, const uint32_t *codes)
{
	const int n = attachment < 0 ? 1 : 4;
	const int samples = MAX2(p->samples, 1);
	const int area = p->width * p->height;

	for (int i = 0; i < samples * p->layers * area; i++) {
		const int s = i / area / p->layers, l = i / area % p->layers;
		const int at = (i % area * samples + s) * p->layers + l;
		const uint32_t *expected = attachment < 0 ?
			&p->model.depth[at] :
			p->model.color[at * p->colors + attachment];

		if (memcmp(codes + n * i, expected, 4 * n) == 0)
			continue;
		printf("%s at (%d, %d)", attachment < 0 ? "depth" : "color",
		       i % p->width, i % area / p->width);
		if (p->samples)
			printf(", sample %d", s);
		if (attachment >= 0)
			printf(", attachment %d", attachment);
		printf(", layer %d of %d, first rank %d\n  expected", l,
		       p->layers, p->model.rank);
		for (int c = 0; c < n; c++)
			printf(" %08x", expected[c]);
		printf("\n  observed");
		for (int c = 0; c < n; c++)
			printf(" %08x", codes[n * i + c]);
		printf("\n");
		return false;
	}
	return true;
}

bool
peel_check_layers(const struct peel *p)
{
	bool pass = true;

	for (int a = -1; a < p->colors && pass; a++) {
		uint32_t *codes;

		if (p->samples)
			codes = peel_read_samples(p, a < 0 ? p->depth_tex :
						  p->color_tex[a], a < 0 ?
						  p->depth : p->color[a]);
		else
			codes = a < 0 ? peel_read_depth(p) :
				peel_read_color(p, a);
		pass = compare(p, a, codes);
		free(codes);
	}
	return pass;
}

int
peel_get(GLenum pname)
{
	GLint value = -1;

	glGetFramebufferParameteriv(GL_FRAMEBUFFER, pname, &value);
	return value;
}

bool
peel_check_overflow(const struct peel *p)
{
	const int overflow = peel_get(GL_DEPTH_PEELING_OVERFLOW_MESA);

	if ((overflow != 0) == p->model.overflow)
		return true;
	printf("overflow is %d, but %s fragment fell behind\n", overflow,
	       p->model.overflow ? "a" : "no");
	return false;
}

bool
peel_check(struct peel *p)
{
	return peel_check_layers(p) && peel_check_overflow(p);
}
