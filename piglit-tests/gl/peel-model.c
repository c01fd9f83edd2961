/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-model.c
 * The specification as a scalar program: one fragment, one sample, one layer
 * after the other.
 */

#include "peel-common.h"

/** State that the model takes from GL. */
struct state {
	GLint func;
	GLboolean depth_mask, color_mask[PEEL_MAX_COLORS][4];
	uint32_t empty;
	bool scissored;
	GLint scissor[4];
};

static struct state
get_state(const struct peel *p)
{
	struct state s;
	GLdouble clear;

	glGetIntegerv(GL_DEPTH_FUNC, &s.func);
	glGetBooleanv(GL_DEPTH_WRITEMASK, &s.depth_mask);
	for (int i = 0; i < PEEL_MAX_COLORS; i++)
		glGetBooleani_v(GL_COLOR_WRITEMASK, i, s.color_mask[i]);
	glGetDoublev(GL_DEPTH_CLEAR_VALUE, &clear);
	/* Clears round. */
	s.empty = p->depth->bits[0] == 32 ? peel_depth_code(p->depth, clear) :
		llrint(clear * peel_max_depth(p->depth));
	s.scissored = glIsEnabled(GL_SCISSOR_TEST);
	glGetIntegerv(GL_SCISSOR_BOX, s.scissor);
	return s;
}

/** A number in the order of depths; those of lines may be below zero. */
static uint32_t
key(uint32_t code)
{
	return code & 0x80000000 ? ~code : code | 0x80000000;
}

/** In front of, by the strict form of DepthFunc. */
static bool
nearer(GLenum func, uint32_t a, uint32_t b)
{
	a = key(a);
	b = key(b);
	return func == GL_LESS || func == GL_LEQUAL ? a < b : a > b;
}

static bool
passes(GLenum func, uint32_t a, uint32_t b)
{
	return nearer(func, a, b) ||
		(a == b && (func == GL_LEQUAL || func == GL_GEQUAL));
}

static int
sample_index(const struct peel *p, int x, int y, int sample)
{
	return (y * p->width + x) * MAX2(p->samples, 1) + sample;
}

static int
num_samples(const struct peel *p)
{
	return p->width * p->height * MAX2(p->samples, 1);
}

static bool
insert(struct peel *p, const struct state *s, int x, int y, int sample,
       uint32_t z, uint32_t colors[][4])
{
	struct peel_model *m = &p->model;
	const int i = sample_index(p, x, y, sample), k = p->layers;
	uint32_t *depth = m->depth + i * k;
	uint32_t (*color)[4] = m->color + i * k * p->colors;
	int place = 0;

	if (s->scissored && (x < s->scissor[0] || y < s->scissor[1] ||
			     x >= s->scissor[0] + s->scissor[2] ||
			     y >= s->scissor[1] + s->scissor[3]))
		return false;

	/* What takes part, and what lies behind the bound. */
	if (!s->depth_mask || !nearer(s->func, z, s->empty))
		return false;
	if (m->rank > 0) {
		if (nearer(s->func, z, m->bound[i]))
			return false;
		if (z == m->bound[i] && m->seen[i]++ < m->taken[i])
			return false;
	}

	while (place < k && !passes(s->func, z, depth[place]))
		place++;
	if (place == k) {
		m->overflow = true;
		return false;
	}
	if (nearer(s->func, depth[k - 1], s->empty))
		m->overflow = true;

	for (int l = k - 1; l >= place; l--) {
		depth[l] = l == place ? z : depth[l - 1];
		for (int o = 0; o < PEEL_MAX_COLORS; o++) {
			const int a = p->buffers[o];

			for (int c = 0; a >= 0 && c < 4; c++) {
				if (!s->color_mask[o][c])
					continue;
				color[l * p->colors + a][c] = l == place ?
					colors[o][c] :
					color[(l - 1) * p->colors + a][c];
			}
		}
	}
	p->inserted++;
	return true;
}

bool
peel_model_insert(struct peel *p, int x, int y, int sample, uint32_t depth,
		  uint32_t colors[][4])
{
	const struct state s = get_state(p);

	return insert(p, &s, x, y, sample, depth, colors);
}

void
peel_draw_model(struct peel *p, const struct peel_quad *quads, int n)
{
	const struct state s = get_state(p);
	uint32_t colors[PEEL_MAX_COLORS][4] = { { 0 } };
	GLfloat at[KB_SAMPLES][2] = { { .5, .5 } };

	if (p->samples && glIsEnabled(GL_MULTISAMPLE)) {
		for (int i = 0; i < p->samples; i++)
			glGetMultisamplefv(GL_SAMPLE_POSITION, i, at[i]);
	} else {
		/* All samples are where the pixel's center is. */
		for (int i = 0; i < KB_SAMPLES; i++)
			at[i][0] = at[i][1] = .5;
	}
	for (const struct peel_quad *q = quads; q < quads + n; q++) {
		const uint32_t z = peel_depth_code(p->depth, q->z);
		const int x0 = MAX2(floorf(q->x0), 0), y0 = MAX2(floorf(q->y0), 0);

		for (int o = 0; o < PEEL_MAX_COLORS; o++) {
			for (int c = 0; p->buffers[o] >= 0 && c < 4; c++)
				colors[o][c] = peel_color_code(
					p->color[p->buffers[o]], o, c, q->id);
		}
		for (int y = y0; y < q->y1 && y < p->height; y++) {
			for (int x = x0; x < q->x1 && x < p->width; x++) {
				for (int i = 0; i < MAX2(p->samples, 1); i++) {
					const float sx = x + at[i][0];
					const float sy = y + at[i][1];

					if (sx >= q->x0 && sx < q->x1 &&
					    sy >= q->y0 && sy < q->y1 &&
					    (!p->stays ||
					     p->stays(x, y, i, q->id)))
						insert(p, &s, x, y, i, z,
						       colors);
				}
			}
		}
	}
}

void
peel_clear(struct peel *p)
{
	static const GLuint zero[4];
	const struct state s = get_state(p);

	glPushAttrib(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT |
		     GL_SCISSOR_BIT);
	glDisable(GL_SCISSOR_TEST);
	glDepthMask(GL_TRUE);
	glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
	for (int o = 0; o < PEEL_MAX_COLORS; o++) {
		if (p->buffers[o] < 0)
			continue;
		switch (p->color[p->buffers[o]]->kind) {
		case PEEL_INT:
			glClearBufferiv(GL_COLOR, o, (const GLint *)zero);
			break;
		case PEEL_UINT:
			glClearBufferuiv(GL_COLOR, o, zero);
			break;
		default:
			glClearBufferfv(GL_COLOR, o, (const GLfloat *)zero);
		}
	}
	glClear(GL_DEPTH_BUFFER_BIT);
	glPopAttrib();

	for (int i = 0; i < num_samples(p) * p->layers; i++) {
		p->model.depth[i] = s.empty;
		for (int o = 0; o < PEEL_MAX_COLORS; o++) {
			if (p->buffers[o] >= 0)
				memset(p->model.color[i * p->colors +
						      p->buffers[o]], 0, 16);
		}
	}
}

void
peel_next(struct peel *p)
{
	struct peel_model *m = &p->model;
	const struct state s = get_state(p);
	const int k = p->layers;

	for (int i = 0; i < num_samples(p); i++) {
		const uint32_t last = m->depth[i * k + k - 1];

		if (m->rank == 0 || last != m->bound[i])
			m->taken[i] = 0;
		/* Empty layers hold no fragments. */
		for (int l = 0; l < k && nearer(s.func, last, s.empty); l++)
			m->taken[i] += m->depth[i * k + l] == last;
		m->bound[i] = last;
		m->seen[i] = 0;
	}
	m->rank += k;
	m->overflow = false;
	glFramebufferParameteri(GL_FRAMEBUFFER,
				GL_DEPTH_PEELING_FIRST_LAYER_MESA, m->rank);
	peel_clear(p);
}

void
peel_restart(struct peel *p)
{
	p->model.rank = 0;
	p->model.overflow = false;
	glFramebufferParameteri(GL_FRAMEBUFFER,
				GL_DEPTH_PEELING_FIRST_LAYER_MESA, 0);
	peel_clear(p);
}

/** For qsort(): by depth, and by arrival where that is equal. */
struct ranked {
	uint32_t depth, id;
	int arrival;
	GLenum func;
};

static int
compare_ranks(const void *a, const void *b)
{
	const struct ranked *p = a, *q = b;

	if (p->depth != q->depth)
		return nearer(p->func, p->depth, q->depth) ? -1 : 1;
	return passes(p->func, p->depth, q->depth) ?
		q->arrival - p->arrival : p->arrival - q->arrival;
}

bool
peel_check_ranks(const struct peel *p, const struct peel_quad *quads, int n)
{
	const struct state s = get_state(p);
	const int k = p->layers;
	struct ranked *list = malloc(n * sizeof(*list));
	bool pass = true;

	for (int i = 0; i < p->width * p->height && pass; i++) {
		const float x = i % p->width + .5, y = i / p->width + .5;
		int found = 0;

		for (int j = 0; j < n; j++) {
			const struct peel_quad *q = &quads[j];
			const uint32_t z = peel_depth_code(p->depth, q->z);

			if (x < q->x0 || x >= q->x1 || y < q->y0 ||
			    y >= q->y1 || !nearer(s.func, z, s.empty))
				continue;
			list[found++] = (struct ranked)
				{ z, q->id, j, s.func };
		}
		qsort(list, found, sizeof(*list), compare_ranks);
		for (int l = 0; l < k && pass; l++) {
			const int rank = p->model.rank + l;
			const uint32_t z = rank < found ? list[rank].depth :
				s.empty;
			const uint32_t color = rank < found ? peel_color_code(
				p->color[0], 0, 0, list[rank].id) : 0;

			pass = p->model.depth[i * k + l] == z &&
				p->model.color[(i * k + l) * p->colors][0] ==
				color;
			if (!pass)
				printf("the model is wrong at (%d, %d): layer "
				       "%d is not the fragment of rank %d\n",
				       i % p->width, i / p->width, l, rank);
		}
		if (pass && p->model.overflow < (found > p->model.rank + k)) {
			printf("the model is wrong: no overflow\n");
			pass = false;
		}
	}
	free(list);
	return pass;
}
