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

static struct peel
make(void)
{
	return peel_create(&(struct peel_shape) {
		K, W, H, 0, GL_DEPTH_COMPONENT32F, { GL_R32UI } });
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

/** How often each pixel was drawn to. */
static bool
check_counts(const GLuint *counts, const struct peel_quad *quads)
{
	for (int i = 0; i < W * H; i++) {
		const int x = i % W, y = i / W;
		int expected = 0;

		for (int j = 0; j < NUM; j++)
			expected += x >= quads[j].x0 && x < quads[j].x1 &&
				y >= quads[j].y0 && y < quads[j].y1;
		if (counts[i] != expected) {
			printf("the shader ran %u times at (%d, %d), not %d\n",
			       counts[i], x, y, expected);
			return false;
		}
	}
	return true;
}

static enum piglit_result
image(void *data)
{
	struct peel p;
	struct peel_quad quads[NUM];
	GLuint tex, *counts = calloc(W * H, 4);
	bool pass;

	if (!piglit_is_extension_supported("GL_ARB_shader_image_load_store")) {
		printf("no images here\n");
		free(counts);
		return PIGLIT_SKIP;
	}
	p = make();
	tex = kb_new_texture();
	glBindTexture(GL_TEXTURE_2D, tex);
	glTexImage2D(GL_TEXTURE_2D, 0, GL_R32UI, W, H, 0, GL_RED_INTEGER,
		     GL_UNSIGNED_INT, counts);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	glBindImageTexture(0, tex, 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32UI);
	peel_use_program(&p,
		"#extension GL_ARB_shader_image_load_store: require\n"
		"layout(r32ui) uniform uimage2D counts;\n",
		data ? data :
		"imageAtomicAdd(counts, ivec2(gl_FragCoord.xy), 1u);");
	pass = draw_and_check(&p, quads);
	glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
	glGetTexImage(GL_TEXTURE_2D, 0, GL_RED_INTEGER, GL_UNSIGNED_INT,
		      counts);
	pass = check_counts(counts, quads) && pass;
	free(counts);
	return peel_end(&p, pass);
}

static enum piglit_result
storage_buffer(void *data)
{
	struct peel p;
	struct peel_quad quads[NUM];
	GLuint buffer, *counts = calloc(W * H, 4);
	bool pass;

	if (!piglit_is_extension_supported(
		    "GL_ARB_shader_storage_buffer_object")) {
		printf("no storage buffers here\n");
		free(counts);
		return PIGLIT_SKIP;
	}
	p = make();
	glGenBuffers(1, &buffer);
	glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
	glBufferData(GL_SHADER_STORAGE_BUFFER, W * H * 4, counts,
		     GL_DYNAMIC_READ);
	glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer);
	peel_use_program(&p,
		"#extension GL_ARB_shader_storage_buffer_object: require\n"
		"layout(std430) buffer Counts { uint counts[]; };\n",
		"atomicAdd(counts[int(gl_FragCoord.y) * 70 + "
		"int(gl_FragCoord.x)], 1u);");
	pass = draw_and_check(&p, quads);
	glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
	glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, W * H * 4, counts);
	pass = check_counts(counts, quads) && pass;
	glDeleteBuffers(1, &buffer);
	free(counts);
	return peel_end(&p, pass);
}

static enum piglit_result
atomic_counter(void *data)
{
	struct peel p;
	struct peel_quad quads[NUM];
	GLuint buffer, n = 0, expected = 0;
	bool pass;

	if (!piglit_is_extension_supported("GL_ARB_shader_atomic_counters")) {
		printf("no atomic counters here\n");
		return PIGLIT_SKIP;
	}
	p = make();
	glGenBuffers(1, &buffer);
	glBindBuffer(GL_ATOMIC_COUNTER_BUFFER, buffer);
	glBufferData(GL_ATOMIC_COUNTER_BUFFER, 4, &n, GL_DYNAMIC_READ);
	glBindBufferBase(GL_ATOMIC_COUNTER_BUFFER, 0, buffer);
	peel_use_program(&p,
		"#extension GL_ARB_shader_atomic_counters: require\n"
		"layout(binding = 0, offset = 0) uniform atomic_uint n;\n",
		"atomicCounterIncrement(n);");
	pass = draw_and_check(&p, quads);
	for (int i = 0; i < NUM; i++)
		expected += (quads[i].x1 - quads[i].x0) *
			(quads[i].y1 - quads[i].y0);
	glGetBufferSubData(GL_ATOMIC_COUNTER_BUFFER, 0, 4, &n);
	if (n != expected) {
		printf("the shader ran %u times, not %u\n", n, expected);
		pass = false;
	}
	glDeleteBuffers(1, &buffer);
	return peel_end(&p, pass);
}

/** Refused by the bound: the second pass runs for all fragments, too. */
static enum piglit_result
second_pass(void *data)
{
	struct peel p;
	struct peel_quad quads[NUM];
	GLuint tex, *counts = calloc(W * H, 4);
	bool pass;

	if (!piglit_is_extension_supported("GL_ARB_shader_image_load_store")) {
		printf("no images here\n");
		free(counts);
		return PIGLIT_SKIP;
	}
	p = make();
	pass = draw_and_check(&p, quads);
	peel_next(&p);
	tex = kb_new_texture();
	glBindTexture(GL_TEXTURE_2D, tex);
	glTexImage2D(GL_TEXTURE_2D, 0, GL_R32UI, W, H, 0, GL_RED_INTEGER,
		     GL_UNSIGNED_INT, counts);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	glBindImageTexture(0, tex, 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32UI);
	peel_use_program(&p,
		"#extension GL_ARB_shader_image_load_store: require\n"
		"layout(r32ui) uniform uimage2D counts;\n",
		"imageAtomicAdd(counts, ivec2(gl_FragCoord.xy), 1u);");
	pass = draw_and_check(&p, quads) && pass;
	glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
	glGetTexImage(GL_TEXTURE_2D, 0, GL_RED_INTEGER, GL_UNSIGNED_INT,
		      counts);
	pass = check_counts(counts, quads) && pass;
	free(counts);
	return peel_end(&p, pass);
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("image-atomic", image, NULL),
	KB_SUBTEST("image-store", image,
		   "ivec2 at = ivec2(gl_FragCoord.xy);\n"
		   "imageStore(counts, at, imageLoad(counts, at) + 1u);"),
	KB_SUBTEST("storage-buffer", storage_buffer, NULL),
	KB_SUBTEST("atomic-counter", atomic_counter, NULL),
	KB_SUBTEST("second-pass", second_pass, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
