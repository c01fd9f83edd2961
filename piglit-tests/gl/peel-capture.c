/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-capture.c
 * Fragments of any primitive: what the same GL draws without peeling.
 *
 * Each primitive is drawn alone into one layer of the same formats, with the
 * depth test always passing, over two different clear depths.  A sample at
 * which both give the same depth has a fragment, the depth and colors of which
 * are taken as they are stored.
 */

#include "peel-common.h"

static struct peel
create_capture(const struct peel *p)
{
	struct peel_shape shape = {
		1, p->width, p->height, p->samples, p->depth->internal,
	};
	struct peel capture;
	const GLuint program = p->program;
	GLint clamp;

	for (int a = 0; a < p->colors; a++)
		shape.colors[a] = p->color[a]->internal;
	glGetIntegerv(GL_CLAMP_FRAGMENT_COLOR, &clamp);
	capture = peel_create(&shape);
	glClampColor(GL_CLAMP_FRAGMENT_COLOR, clamp);
	peel_draw_buffers(&capture, PEEL_MAX_COLORS, p->buffers);
	glUseProgram(program);
	return capture;
}

struct image {
	uint32_t *depth, *color[PEEL_MAX_COLORS];
};

static struct image
draw_alone(struct peel *capture, float clear, GLenum mode,
	   const struct peel_vertex *vertices, int n)
{
	struct image image = { NULL };

	glPushAttrib(GL_DEPTH_BUFFER_BIT | GL_COLOR_BUFFER_BIT |
		     GL_ENABLE_BIT);
	glClearDepth(clear);
	glDisable(GL_DEPTH_PEELING_MESA);
	peel_clear(capture);
	glDisable(GL_BLEND);
	glDisable(GL_COLOR_LOGIC_OP);
	glEnable(GL_DEPTH_TEST);
	glDepthFunc(GL_ALWAYS);
	glDepthMask(GL_TRUE);
	glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
	peel_draw_vertices(mode, vertices, n);
	glPopAttrib();

	image.depth = capture->samples ?
		peel_read_samples(capture, capture->depth_tex,
				  capture->depth) : peel_read_depth(capture);
	for (int a = 0; a < capture->colors; a++)
		image.color[a] = capture->samples ?
			peel_read_samples(capture, capture->color_tex[a],
					  capture->color[a]) :
			peel_read_color(capture, a);
	return image;
}

static void
free_image(struct image *image)
{
	free(image->depth);
	for (int a = 0; a < PEEL_MAX_COLORS; a++)
		free(image->color[a]);
}

static int
vertices_of(GLenum mode)
{
	return mode == GL_POINTS ? 1 : mode == GL_LINES ? 2 : 3;
}

void
peel_draw_captured(struct peel *p, GLenum mode,
		   const struct peel_vertex *vertices, int n)
{
	const int area = p->width * p->height, samples = MAX2(p->samples, 1);
	struct peel capture;
	int found = 0;

	peel_draw_vertices(mode, vertices, n);

	glPushAttrib(GL_ENABLE_BIT | GL_VIEWPORT_BIT);
	capture = create_capture(p);
	glPopAttrib();
	for (int i = 0; i < n; i += vertices_of(mode)) {
		struct image a = draw_alone(&capture, 0, mode, vertices + i,
					    vertices_of(mode));
		struct image b = draw_alone(&capture, 1, mode, vertices + i,
					    vertices_of(mode));

		/* Images are in the order sample, y, x. */
		for (int j = 0; j < samples * area; j++) {
			const int x = j % p->width;
			const int y = j % area / p->width;
			uint32_t colors[PEEL_MAX_COLORS][4] = { { 0 } };

			if (a.depth[j] != b.depth[j])
				continue;
			for (int o = 0; o < PEEL_MAX_COLORS; o++) {
				if (p->buffers[o] >= 0)
					memcpy(colors[o], a.color[p->buffers[o]]
					       + 4 * j, 16);
			}
			found++;
			peel_model_insert(p, x, y, j / area,
					  peel_clamp_depth(p->depth,
							   a.depth[j]),
					  colors);
		}
		free_image(&a);
		free_image(&b);
	}
	peel_end(&capture, true);
	if (found == 0) {
		printf("a scene without fragments\n");
		piglit_report_result(PIGLIT_FAIL);
	}
	glBindFramebuffer(GL_FRAMEBUFFER, p->fbo);
}
