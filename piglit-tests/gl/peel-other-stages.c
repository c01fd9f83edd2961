/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-other-stages.c
 * Rasterizer discard, transform feedback and the queries of primitives are not
 * affected by peeling, nor peeling by them.  (Conditional rendering is in
 * peel-occlusion.c.)
 */

#include "peel-common.h"

#define W 16
#define LAYERS 3

/** Two rectangles: 4 triangles. */
static void
get_quads(const struct peel *p, struct peel_quad quads[2])
{
	quads[0] = peel_full(p, .5, 1);
	quads[1] = (struct peel_quad) { 2, 3, W - 4, W - 5, .25, 2 };
}

/** Nothing is inserted and nothing falls out; afterwards it is as before. */
static enum piglit_result
rasterizer_discard(void *data)
{
	struct peel p = peel_simple(1);
	struct peel_quad quads[2];
	bool pass;

	get_quads(&p, quads);
	glEnable(GL_RASTERIZER_DISCARD);
	peel_draw_gl(&p, quads, 2);
	glDisable(GL_RASTERIZER_DISCARD);
	pass = peel_check(&p);
	peel_draw(&p, quads, 1);
	pass = peel_check(&p) && pass;

	/* A framebuffer that could not be peeled into is an error all the
	 * same: it is of the command. */
	glFramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, 0, 0);
	glEnable(GL_RASTERIZER_DISCARD);
	peel_draw_gl(&p, quads, 2);
	glDisable(GL_RASTERIZER_DISCARD);
	pass = piglit_check_gl_error(GL_INVALID_OPERATION) && pass;
	return peel_end(&p, pass);
}

static bool
check_query(GLuint query, GLuint wanted)
{
	GLuint n = ~0u;

	glGetQueryObjectuiv(query, GL_QUERY_RESULT, &n);
	if (n != wanted)
		printf("%u primitives, expected %u\n", n, wanted);
	return n == wanted;
}

/** The vertices of all primitives are captured, and fragments are peeled. */
static enum piglit_result
transform_feedback(void *data)
{
	static const char *varying = "gl_Position";
	struct peel p = peel_simple(LAYERS);
	struct peel_quad quads[2];
	float got[4 * 3][4];
	GLuint buffer, queries[2];
	bool pass;

	get_quads(&p, quads);
	glTransformFeedbackVaryings(p.program, 1, &varying,
				    GL_INTERLEAVED_ATTRIBS);
	glLinkProgram(p.program);
	glUseProgram(p.program);
	glGenBuffers(1, &buffer);
	glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer);
	glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, sizeof(got), NULL,
		     GL_DYNAMIC_READ);
	glGenQueries(2, queries);
	glBeginQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, queries[0]);
	glBeginQuery(GL_PRIMITIVES_GENERATED, queries[1]);
	glBeginTransformFeedback(GL_TRIANGLES);
	peel_draw(&p, quads, 2);
	glEndTransformFeedback();
	glEndQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
	glEndQuery(GL_PRIMITIVES_GENERATED);
	pass = check_query(queries[0], 4);
	pass = check_query(queries[1], 4) && pass;
	glGetBufferSubData(GL_TRANSFORM_FEEDBACK_BUFFER, 0, sizeof(got), got);
	for (int i = 0; i < 4 * 3; i++) {
		const struct peel_quad *q = &quads[i / 6];

		/* x0 of W pixels, from -1 to 1: exact in the float. */
		if (i % 6 == 0 && (got[i][0] != 2 * q->x0 / W - 1 ||
				   got[i][2] != q->z || got[i][3] != 1)) {
			printf("vertex %d: %g %g %g %g\n", i, got[i][0],
			       got[i][1], got[i][2], got[i][3]);
			pass = false;
		}
	}
	pass = peel_check(&p) && pass;
	glDeleteQueries(2, queries);
	glDeleteBuffers(1, &buffer);
	return peel_end(&p, pass);
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("rasterizer-discard", rasterizer_discard, NULL),
	KB_SUBTEST("transform-feedback", transform_feedback, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
