/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-out-of-memory.c
 * Each allocation that depth peeling needs for a framebuffer fails once: the
 * error is GL_OUT_OF_MEMORY, nothing has changed, and the next try works.
 */

#include "peel-common.h"

#include <errno.h>

#define LAYERS 3

/** How many more allocations of this thread succeed; negative: all. */
static __thread int countdown = -1;
static __thread bool failed;

/** Others do not count, and succeed. */
static __thread size_t smallest = 0, largest = SIZE_MAX;

static bool
fails(size_t size)
{
	if (countdown < 0 || size < smallest || size > largest ||
	    countdown-- > 0)
		return false;
	failed = true;
	return true;
}

/* AddressSanitizer's, where it is there, or the C library's, called by those
 * that take their place.
 */
extern void *__interceptor_malloc(size_t) __attribute__((weak));
extern void *__interceptor_calloc(size_t, size_t) __attribute__((weak));
extern void *__interceptor_realloc(void *, size_t) __attribute__((weak));
extern void *__interceptor_memalign(size_t, size_t) __attribute__((weak));
extern void *__libc_malloc(size_t);
extern void *__libc_calloc(size_t, size_t);
extern void *__libc_realloc(void *, size_t);
extern void *__libc_memalign(size_t, size_t);

void *
malloc(size_t size)
{
	if (fails(size))
		return NULL;
	return __interceptor_malloc ? __interceptor_malloc(size) :
		__libc_malloc(size);
}

void *
calloc(size_t n, size_t size)
{
	if (fails(n * size))
		return NULL;
	return __interceptor_calloc ? __interceptor_calloc(n, size) :
		__libc_calloc(n, size);
}

void *
realloc(void *old, size_t size)
{
	if (fails(size))
		return NULL;
	return __interceptor_realloc ? __interceptor_realloc(old, size) :
		__libc_realloc(old, size);
}

void *
aligned_alloc(size_t alignment, size_t size)
{
	if (fails(size))
		return NULL;
	return __interceptor_memalign ?
		__interceptor_memalign(alignment, size) :
		__libc_memalign(alignment, size);
}

int
posix_memalign(void **result, size_t alignment, size_t size)
{
	void *memory = aligned_alloc(alignment, size);

	if (!memory)
		return ENOMEM;
	*result = memory;
	return 0;
}

static void
draw_scene(struct peel *p)
{
	for (int i = 0; i < 3 * LAYERS; i++) {
		const struct peel_quad q =
			peel_full(p, i % 2 ? .25f : .5f, i + 1);

		peel_draw(p, &q, 1);
	}
}

/**
 * Do something with the n-th allocation failing.  Ends with the first that
 * does not come to the n-th any more.
 */
static bool
try(struct peel *p, int n, void (*action)(struct peel *), bool *more)
{
	GLenum error;

	glFinish();
	failed = false;
	countdown = n;
	action(p);
	countdown = -1;
	error = glGetError();
	*more = failed;
	if (error == (failed ? GL_OUT_OF_MEMORY : GL_NO_ERROR))
		return true;
	printf("allocation %d %s, but the error is %s\n", n,
	       failed ? "failed" : "was not needed",
	       piglit_get_gl_error_name(error));
	return false;
}

static void
set_first_layer(struct peel *p)
{
	glFramebufferParameteri(GL_FRAMEBUFFER,
				GL_DEPTH_PEELING_FIRST_LAYER_MESA,
				p->model.rank + LAYERS);
}

/** Of the first bound, which needs memory for all samples. */
static enum piglit_result
first_layer(void *data)
{
	struct peel p = peel_simple(LAYERS);
	bool pass = true, more = true;
	int n;

	/* Now and not later: piglit looks the function up. */
	peel_restart(&p);
	draw_scene(&p);
	for (n = 0; n < 50; n++) {
		pass = try(&p, n, set_first_layer, &more) && pass;
		if (!more)
			break;
		pass = peel_get(GL_DEPTH_PEELING_FIRST_LAYER_MESA) == 0 &&
			peel_check(&p) && pass;
	}
	if (n == 0 || more) {
		printf("after %d failures: %s\n", n, more ? "still not set" :
		       "no memory is needed?");
		pass = false;
	}
	glFramebufferParameteri(GL_FRAMEBUFFER,
				GL_DEPTH_PEELING_FIRST_LAYER_MESA, 0);
	peel_next(&p);
	pass = peel_check_overflow(&p) && pass;
	return peel_end(&p, pass);
}

static void
draw_one(struct peel *p)
{
	peel_draw_gl(p, &(struct peel_quad) { 0, 0, 16, 16, .125f, 99 }, 1);
}

/**
 * Of the first draw, which has to make what belongs to a framebuffer.  These
 * are small objects; of others there are none of that size once a framebuffer
 * has been drawn to.
 */
static enum piglit_result
first_draw(void *data)
{
	struct peel p = peel_simple(LAYERS);
	bool pass = true, more = true;
	int n;

	peel_restart(&p);
	draw_scene(&p);
	for (n = 0; n < 50; n++) {
		const GLuint old = p.fbo;

		p.fbo = kb_new_framebuffer();
		glBindFramebuffer(GL_FRAMEBUFFER, p.fbo);
		glFramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT,
				     p.depth_tex, 0);
		glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
				     p.color_tex[0], 0);
		glReadBuffer(GL_NONE);
		glDeleteFramebuffers(1, &old);
		peel_restart(&p);
		largest = 64;
		pass = try(&p, n, draw_one, &more) && pass;
		largest = SIZE_MAX;
		if (!more)
			break;
		pass = peel_check(&p) && pass;

		/* The next draw tries again, without another command. */
		draw_scene(&p);
		pass = peel_check(&p) && pass;
	}
	if (n == 0 || more) {
		printf("after %d failures: %s\n", n, more ? "still not drawn" :
		       "no memory is needed?");
		pass = false;
	}
	return peel_end(&p, pass);
}

/**
 * Of a draw to more layers than any before, for which an implementation may
 * need room in each of its threads.  All else that it allocates is smaller.
 */
static enum piglit_result
more_layers(void *data)
{
	bool pass = true, more = true;
	int n;

	for (n = 0; n < 24 && more; n++) {
		struct peel p = peel_simple(64 + 8 * n);

		smallest = 1 << 20;
		pass = try(&p, n, draw_one, &more) && pass;
		smallest = 0;
		if (more) {
			pass = peel_check(&p) && pass;
			draw_scene(&p);
			pass = peel_check(&p) && pass;
		}
		peel_end(&p, pass);
	}
	if (n == 1 && kb_is_softpipe()) {
		printf("it works on the layers themselves\n");
		return PIGLIT_SKIP;
	}
	if (n == 1 || more) {
		printf("after %d failures: %s\n", n, more ? "still not drawn" :
		       "no memory is needed?");
		pass = false;
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("first-layer", first_layer, NULL),
	KB_SUBTEST("first-draw", first_draw, NULL),
	KB_SUBTEST("more-layers", more_layers, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
