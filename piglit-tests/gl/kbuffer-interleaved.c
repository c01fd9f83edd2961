/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-interleaved.c
 * Random sequences of draws with different k-buffer programs, plain and
 * blended draws, whole and partial clears and uploads, all in random
 * rectangles with nothing between them, against a model of the framebuffer in
 * the test.  All values are small integers, so that every format used holds
 * them exactly.
 */

#include "kbuffer-common.h"

/* Tiles of 64x64, blocks of 4x4, and parts of such. */
#define W 150
#define H 77
#define MAX_ENTRIES 64

struct shape { int attachments, layers; GLenum format; };

struct rect { int x, y, w, h; };

static uint32_t state;

static int
random_below(int n)
{
	state = state * 1664525 + 1013904223;
	return (state >> 8) % n;
}

static struct rect
random_rect(void)
{
	struct rect r = { random_below(W), random_below(H) };

	r.w = 1 + random_below(random_below(3) ? 20 : W);
	r.h = 1 + random_below(random_below(3) ? 20 : H);
	r.w = MIN2(r.w, W - r.x);
	r.h = MIN2(r.h, H - r.y);
	return r;
}

/** model[entry][y][x][component] */
typedef float image[H][W][4];

/** The programs: their text is made for n entries of the framebuffer. */
enum { SHIFT, ONE_COMPONENT, SWAP_ENDS, KILL_ODD, NUM_PROGRAMS };

static void
program_text(int which, int n, char *text)
{
	char *end = text;

	switch (which) {
	case SHIFT:
		end += sprintf(end, "MOV result.kbuffer[0], fragment.color;\n");
		for (int e = 1; e < n; e++)
			end += sprintf(end, "MOV result.kbuffer[%d], "
				       "kbuffer[%d];\n", e, e - 1);
		break;
	case ONE_COMPONENT:
		sprintf(end, "MOV result.kbuffer[%d].z, fragment.color;\n",
			n / 2);
		break;
	case SWAP_ENDS:
		sprintf(end, "MOV result.kbuffer[0], kbuffer[%d];\n"
			"MOV result.kbuffer[%d].xyw, kbuffer[0];\n", n - 1,
			n - 1);
		break;
	case KILL_ODD:
		/* Left of every second column. */
		sprintf(end, "TEMP t;\nMUL t, fragment.position.x, 0.5;\n"
			"FRC t, t;\nSUB t, t, 0.5;\nKIL t;\n"
			"MOV result.kbuffer[%d], fragment.color;\n", n - 1);
		break;
	}
}

static void
run_program(image *model, int which, int n, int x, int y, const float *color)
{
	float swap[4];

	switch (which) {
	case SHIFT:
		for (int e = n - 1; e > 0; e--)
			memcpy(model[e][y][x], model[e - 1][y][x], 16);
		memcpy(model[0][y][x], color, 16);
		break;
	case ONE_COMPONENT:
		model[n / 2][y][x][2] = color[2];
		break;
	case SWAP_ENDS:
		if (n == 1)
			break;
		memcpy(swap, model[0][y][x], 16);
		memcpy(model[0][y][x], model[n - 1][y][x], 16);
		swap[2] = model[n - 1][y][x][2];
		memcpy(model[n - 1][y][x], swap, 16);
		break;
	case KILL_ODD:
		if (x % 2 == 1)
			memcpy(model[n - 1][y][x], color, 16);
		break;
	}
}

enum operation {
	K_DRAW, PLAIN_DRAW, BLENDED_DRAW, CLEAR, PARTIAL_CLEAR, UPLOAD,
	NUM_OPERATIONS
};

static const char *const operation_names[NUM_OPERATIONS] = {
	"program", "draw", "blended draw", "clear", "partial clear", "upload",
};

/** The model's side of all but the programs. */
static void
model_set(image *model, int entry, struct rect r, const float *color, bool add)
{
	for (int y = r.y; y < r.y + r.h; y++) {
		for (int x = r.x; x < r.x + r.w; x++) {
			for (int c = 0; c < 4; c++)
				model[entry][y][x][c] = color[c] +
					(add ? model[entry][y][x][c] : 0);
		}
	}
}

static bool
compare(const struct kb *kb, image *model)
{
	for (int e = 0; e < kb_entries(kb); e++) {
		float *got = kb_read(kb, e);

		for (int i = 0; i < W * H * 4; i++) {
			const float wanted = model[e][i / 4 / W][i / 4 % W]
						  [i % 4];

			/* RGBA8 holds n / 255. */
			if (fabsf(got[i] - wanted) < 1e-6f)
				continue;
			printf("entry %d at (%d, %d), component %d: %.9g, "
			       "expected %.9g\n", e, i / 4 % W, i / 4 / W,
			       i % 4, got[i], wanted);
			free(got);
			return false;
		}
		free(got);
	}
	return true;
}

static enum piglit_result
interleaved(void *data)
{
	const struct shape *shape = data;
	struct kb kb = kb_create(shape->format, shape->attachments,
				 shape->layers, W, H);
	const int n = MIN2(kb_entries(&kb), MAX_ENTRIES);
	const float unit = shape->format == GL_RGBA8 ? 1 / 255.0f : 1;
	const struct rect all = { 0, 0, W, H };
	image *model = calloc(kb_entries(&kb), sizeof(image));
	char *text = malloc(64 * n + 512);
	GLuint programs[NUM_PROGRAMS][2];
	bool pass = true;

	/* Each for all entries and for about half of them. */
	for (int p = 0; p < NUM_PROGRAMS; p++) {
		for (int half = 0; half < 2; half++) {
			program_text(p, half ? (n + 1) / 2 : n, text);
			programs[p][half] = kb_program(text);
		}
	}
	kb_fragment_values((const float[8][4]) { { 0 } }, shape->attachments);
	glBlendFunc(GL_ONE, GL_ONE);
	state = 7;
	for (int i = 0; i < 400 && pass; i++) {
		const struct rect r = random_rect();
		/* Mostly programs: runs of them between the others. */
		const int op = random_below(3) ? K_DRAW :
			random_below(NUM_OPERATIONS);
		const int p = random_below(NUM_PROGRAMS);
		const int half = random_below(2);
		const int b = random_below(shape->attachments);
		float color[4];

		for (int c = 0; c < 4; c++)
			color[c] = random_below(8) * unit;
		for (int a = 0; a < shape->attachments; a++)
			glProgramLocalParameter4fvARB(GL_FRAGMENT_PROGRAM_ARB,
						      a, color);
		glDisable(GL_KBUFFER_PROGRAM_MESA);
		glDisable(GL_BLEND);
		switch (op) {
		case K_DRAW:
			glBindProgramARB(GL_KBUFFER_PROGRAM_MESA,
					 programs[p][half]);
			glEnable(GL_KBUFFER_PROGRAM_MESA);
			kb_draw_rect(&kb, r.x, r.y, r.w, r.h, 0.5);
			for (int y = r.y; y < r.y + r.h; y++) {
				for (int x = r.x; x < r.x + r.w; x++)
					run_program(model, p, half ?
						    (n + 1) / 2 : n, x, y,
						    color);
			}
			break;
		case PLAIN_DRAW:
		case BLENDED_DRAW:
			if (op == BLENDED_DRAW)
				glEnable(GL_BLEND);
			kb_draw_rect(&kb, r.x, r.y, r.w, r.h, 0.5);
			/* Layer 0 of each attachment. */
			for (int a = 0; a < shape->attachments; a++)
				model_set(model, a, r, color,
					  op == BLENDED_DRAW);
			break;
		case CLEAR:
			glClearBufferfv(GL_COLOR, b, color);
			for (int e = b; e < kb_entries(&kb);
			     e += shape->attachments)
				model_set(model, e, all, color, false);
			break;
		case PARTIAL_CLEAR:
			glEnable(GL_SCISSOR_TEST);
			glScissor(r.x, r.y, r.w, r.h);
			glClearBufferfv(GL_COLOR, b, color);
			glDisable(GL_SCISSOR_TEST);
			for (int e = b; e < kb_entries(&kb);
			     e += shape->attachments)
				model_set(model, e, r, color, false);
			break;
		case UPLOAD: {
			const int e = random_below(kb_entries(&kb));

			kb_fill(&kb, e, color[0], color[1], color[2],
				color[3]);
			model_set(model, e, all, color, false);
			break;
		}
		}
		/* Comparing ends the driver's batch, so not too often. */
		if (i % 57 == 56 && !compare(&kb, model)) {
			printf("after operation %d, last a %s\n", i,
			       operation_names[op]);
			pass = false;
		}
	}
	pass = pass && compare(&kb, model);
	free(model);
	free(text);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/**
 * With no other change of state: the second draw goes on with the first's.
 * The program names n entries.
 */
static enum piglit_result
clear_between(const struct shape *shape, int n)
{
	const float color[4] = { 1, 2, 3, 4 };
	struct kb kb = kb_create(shape->format, shape->attachments,
				 shape->layers, W, H);
	const struct rect all = { 0, 0, W, H };
	image *model = calloc(kb_entries(&kb), sizeof(image));
	char *text = malloc(64 * n + 512);
	bool pass;

	program_text(SHIFT, n, text);
	glBindProgramARB(GL_KBUFFER_PROGRAM_MESA, kb_program(text));
	kb_fragment_values((const float[8][4]) { { 0 } }, shape->attachments);
	glProgramLocalParameter4fvARB(GL_FRAGMENT_PROGRAM_ARB, 0, color);
	glClearColor(7, 7, 7, 7);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw_rect(&kb, 0, 0, W, H, 0.5);
	glClear(GL_COLOR_BUFFER_BIT);
	kb_draw_rect(&kb, 0, 0, W, H, 0.5);
	glDisable(GL_KBUFFER_PROGRAM_MESA);

	for (int e = 0; e < kb_entries(&kb); e++)
		model_set(model, e, all, (const float[4]) { 7, 7, 7, 7 },
			  false);
	model_set(model, 0, all, color, false);
	pass = compare(&kb, model);
	free(model);
	free(text);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
clear_between_draws(void *data)
{
	const struct shape *shape = data;

	return clear_between(shape, shape->attachments * shape->layers);
}

static enum piglit_result
clear_between_draws_of_some(void *data)
{
	const struct shape *shape = data;

	return clear_between(shape, shape->attachments * shape->layers / 2);
}

/** The same of draws without a program, among some with one. */
static enum piglit_result
clear_between_plain_draws(void *data)
{
	const float black[4] = { 0, 0, 0, 0 }, color[4] = { 1, 2, 3, 4 };
	const float before[4] = { 7, 7, 7, 7 };
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, H);
	bool pass;

	kb_program("MOV result.kbuffer[0], kbuffer[0];\n");
	kb_fragment_values(&color, 1);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw_rect(&kb, 0, 0, W, H, 0.5);
	glDisable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw_rect(&kb, 0, 0, W, H, 0.5);
	glClearColor(7, 7, 7, 7);
	glClear(GL_COLOR_BUFFER_BIT);
	kb_draw_rect(&kb, 9, 6, 31, 22, 0.5);
	pass = kb_expect_only_rect(&kb, 0, 9, 6, 31, 22, color, before);

	/* And the other way round: what was cleared is then drawn to. */
	glClearColor(0, 0, 0, 0);
	glClear(GL_COLOR_BUFFER_BIT);
	kb_draw_rect(&kb, 9, 6, 31, 22, 0.5);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw_rect(&kb, 0, 0, W, H, 0.5);
	glDisable(GL_KBUFFER_PROGRAM_MESA);
	pass = kb_expect_only_rect(&kb, 0, 9, 6, 31, 22, color, black) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static const struct shape one = { 1, 0, GL_RGBA32F },
	eight = { 8, 0, GL_RGBA32F }, layers = { 1, 16, GL_RGBA32F },
	many = { 8, 8, GL_RGBA32F }, bytes = { 4, 4, GL_RGBA8 },
	halves = { 3, 5, GL_RGBA16F };

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("1-rgba32f", interleaved, &one),
	KB_SUBTEST("8-rgba32f", interleaved, &eight),
	KB_SUBTEST("1x16-rgba32f", interleaved, &layers),
	KB_SUBTEST("8x8-rgba32f", interleaved, &many),
	KB_SUBTEST("4x4-rgba8", interleaved, &bytes),
	KB_SUBTEST("3x5-rgba16f", interleaved, &halves),
	KB_SUBTEST("clear-between-draws", clear_between_draws, &many),
	KB_SUBTEST("clear-between-draws-of-some", clear_between_draws_of_some,
		   &layers),
	KB_SUBTEST("clear-between-plain-draws", clear_between_plain_draws,
		   NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
