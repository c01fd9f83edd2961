/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-side-effects.c
 * A fragment shader that has side effects runs in full for every fragment,
 * those that the layers refuse included.
 */

#include "peel-common.h"

#define W 70
#define H 33
#define K 3
#define NUM 20

/** What a shader counts its invocations in, for each pixel or in one number. */
struct counter {
	const char *extension;
	GLenum target;
	int numbers;
	const char *declaration, *statement;
	/** It is there in the second pass, which has a bound. */
	bool second_pass;
};

#define IMAGE "GL_ARB_shader_image_load_store", GL_TEXTURE_2D, W * H, \
	"layout(r32ui) uniform uimage2D counts;\n"
#define ADD_TO_IMAGE "imageAtomicAdd(counts, ivec2(gl_FragCoord.xy), 1u);"

static const struct counter image_atomic = { IMAGE, ADD_TO_IMAGE };
static const struct counter image_store = { IMAGE,
	"ivec2 at = ivec2(gl_FragCoord.xy);\n"
	"imageStore(counts, at, imageLoad(counts, at) + 1u);"
};
static const struct counter second_pass = { IMAGE, ADD_TO_IMAGE, true };
/** Insertion is none of the tests that can be early. */
static const struct counter early_tests = {
	"GL_ARB_shader_image_load_store", GL_TEXTURE_2D, W * H,
	"layout(early_fragment_tests) in;\n"
	"layout(r32ui) uniform uimage2D counts;\n", ADD_TO_IMAGE
};
static const struct counter early_tests_second_pass = {
	"GL_ARB_shader_image_load_store", GL_TEXTURE_2D, W * H,
	"layout(early_fragment_tests) in;\n"
	"layout(r32ui) uniform uimage2D counts;\n", ADD_TO_IMAGE, true
};
static const struct counter storage_buffer = {
	"GL_ARB_shader_storage_buffer_object", GL_SHADER_STORAGE_BUFFER, W * H,
	"layout(std430) buffer Counts { uint counts[]; };\n",
	"atomicAdd(counts[int(gl_FragCoord.y) * 70 + int(gl_FragCoord.x)], "
	"1u);"
};
static const struct counter atomic_counter = {
	"GL_ARB_shader_atomic_counters", GL_ATOMIC_COUNTER_BUFFER, 1,
	"layout(binding = 0, offset = 0) uniform atomic_uint n;\n",
	"atomicCounterIncrement(n);"
};

/** Make it, zero, and use a shader that counts. */
static GLuint
start(struct peel *p, const struct counter *c)
{
	GLuint *zeros = calloc(c->numbers, sizeof(GLuint)), name;
	char *declarations;

	if (c->target == GL_TEXTURE_2D) {
		name = kb_new_texture();
		glBindTexture(GL_TEXTURE_2D, name);
		glTexImage2D(GL_TEXTURE_2D, 0, GL_R32UI, W, H, 0,
			     GL_RED_INTEGER, GL_UNSIGNED_INT, zeros);
		glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER,
				GL_NEAREST);
		glBindImageTexture(0, name, 0, GL_FALSE, 0, GL_READ_WRITE,
				   GL_R32UI);
	} else {
		glGenBuffers(1, &name);
		glBindBuffer(c->target, name);
		glBufferData(c->target, c->numbers * sizeof(GLuint), zeros,
			     GL_DYNAMIC_READ);
		glBindBufferBase(c->target, 0, name);
	}
	if (asprintf(&declarations, "#extension %s: require\n%s", c->extension,
		     c->declaration) < 0)
		abort();
	peel_use_program(p, declarations, c->statement);
	free(declarations);
	free(zeros);
	return name;
}

static GLuint *
read_and_delete(const struct counter *c, GLuint name)
{
	GLuint *counts = malloc(c->numbers * sizeof(GLuint));

	glMemoryBarrier(GL_ALL_BARRIER_BITS);
	if (c->target == GL_TEXTURE_2D) {
		glGetTexImage(GL_TEXTURE_2D, 0, GL_RED_INTEGER,
			      GL_UNSIGNED_INT, counts);
	} else {
		glGetBufferSubData(c->target, 0, c->numbers * sizeof(GLuint),
				   counts);
		glDeleteBuffers(1, &name);
	}
	return counts;
}

/** Each pixel was counted as often as it was drawn to. */
static bool
check_counts(const struct counter *c, const GLuint *counts,
	     const struct peel_quad *quads)
{
	GLuint *expected = calloc(c->numbers, sizeof(GLuint));
	bool pass = true;

	for (int i = 0; i < W * H; i++) {
		for (int j = 0; j < NUM; j++)
			expected[c->numbers == 1 ? 0 : i] +=
				i % W >= quads[j].x0 && i % W < quads[j].x1 &&
				i / W >= quads[j].y0 && i / W < quads[j].y1;
	}
	for (int i = 0; i < c->numbers && pass; i++) {
		pass = counts[i] == expected[i];
		if (!pass)
			printf("%u invocations, not %u, at %d of %d\n",
			       counts[i], expected[i], i, c->numbers);
	}
	free(expected);
	return pass;
}

/** Front to back: all but the first K are refused. */
static bool
draw_and_check(struct peel *p, struct peel_quad *quads)
{
	for (int i = 0; i < NUM; i++)
		quads[i] = (struct peel_quad) {
			i, i % 7, W - i % 5, H - i / 2, (1 + i) / 32., i
		};
	peel_draw(p, quads, NUM);
	return peel_check_ranks(p, quads, NUM) && peel_check(p);
}

static enum piglit_result
invocations(void *data)
{
	const struct counter *c = data;
	struct peel_quad quads[NUM];
	struct peel p;
	GLuint name, *counts;
	bool pass = true;

	if (!piglit_is_extension_supported(c->extension)) {
		printf("no %s here\n", c->extension);
		return PIGLIT_SKIP;
	}
	p = peel_create(&(struct peel_shape) {
		K, W, H, 0, GL_DEPTH_COMPONENT32F, { GL_R32UI } });
	if (c->second_pass) {
		pass = draw_and_check(&p, quads);
		peel_next(&p);
	}
	name = start(&p, c);
	pass = draw_and_check(&p, quads) && pass;
	counts = read_and_delete(c, name);
	pass = check_counts(c, counts, quads) && pass;
	free(counts);
	return peel_end(&p, pass);
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("image-atomic", invocations, &image_atomic),
	KB_SUBTEST("image-store", invocations, &image_store),
	KB_SUBTEST("storage-buffer", invocations, &storage_buffer),
	KB_SUBTEST("atomic-counter", invocations, &atomic_counter),
	KB_SUBTEST("second-pass", invocations, &second_pass),
	KB_SUBTEST("early-tests", invocations, &early_tests),
	KB_SUBTEST("early-tests-second-pass", invocations,
		   &early_tests_second_pass),
	KB_SUBTEST_END
};

PEEL_TEST(32)
