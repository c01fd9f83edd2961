/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-queries.c
 * Occlusion queries count the samples that ran the program and were not
 * killed by it; a fragment shader's side effects happen all the same.
 */

#include "kbuffer-common.h"

#define W 64

static struct kb
make(const char *program)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);

	kb_program(program);
	/* What a draw without the program would leave. */
	glColor4f(0, 0, 0, 0);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	return kb;
}

static bool
check_count(GLuint query, GLuint wanted)
{
	GLuint n = ~0u;

	glGetQueryObjectuiv(query, GL_QUERY_RESULT, &n);
	glDeleteQueries(1, &query);
	if (n == wanted)
		return true;
	printf("counted %u, expected %u\n", n, wanted);
	return false;
}

static GLuint
begin(GLenum target)
{
	GLuint query;

	glGenQueries(1, &query);
	glBeginQuery(target, query);
	return query;
}

static enum piglit_result
all_pass(void *data)
{
	struct kb kb = make("MOV result.kbuffer[0], 1;");
	GLuint query = begin(GL_SAMPLES_PASSED);

	kb_draw_rect(&kb, 5, 6, 40, 30, .5);
	kb_draw_rect(&kb, 0, 0, 10, 10, .5);
	glEndQuery(GL_SAMPLES_PASSED);
	return kb_expect_rect(&kb, 0, 5, 6, 40, 30, 0, 1, 1, 1, 1) &&
		check_count(query, 40 * 30 + 100) ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
killed(void *data)
{
	struct kb kb = make("TEMP t;\nSUB t, fragment.position.x, 20;\n"
			    "KIL t.x;\nMOV result.kbuffer[0], 1;");
	GLuint query = begin(GL_SAMPLES_PASSED);

	kb_draw(&kb);
	glEndQuery(GL_SAMPLES_PASSED);
	return check_count(query, (W - 20) * W) ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
all_killed(void *data)
{
	struct kb kb = make("KIL -1;");
	GLuint query = begin(GL_SAMPLES_PASSED);

	kb_draw(&kb);
	glEndQuery(GL_SAMPLES_PASSED);
	if (!check_count(query, 0))
		return PIGLIT_FAIL;
	query = begin(GL_ANY_SAMPLES_PASSED);
	kb_draw(&kb);
	glEndQuery(GL_ANY_SAMPLES_PASSED);
	return check_count(query, 0) ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** What an earlier fragment wrote decides over the later one. */
static enum piglit_result
killed_by_entry(void *data)
{
	struct kb kb = make("TEMP t;\nSUB t, 1, kbuffer[0];\nKIL t.x;\n"
			    "ADD result.kbuffer[0], kbuffer[0], 1;");
	GLuint query = begin(GL_SAMPLES_PASSED);

	for (int i = 0; i < 5; i++)
		kb_draw(&kb);
	glEndQuery(GL_SAMPLES_PASSED);
	return check_count(query, 2 * W * W) ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
failed_tests(void *data)
{
	struct kb kb = make("MOV result.kbuffer[0], 1;");
	GLuint query;

	kb_attach_depth(&kb, GL_DEPTH_COMPONENT24);
	glClearDepth(.5);
	glClear(GL_DEPTH_BUFFER_BIT);
	glEnable(GL_DEPTH_TEST);
	query = begin(GL_SAMPLES_PASSED);
	kb_draw_rect(&kb, 0, 0, W, W, .75);
	kb_draw_rect(&kb, 0, 0, 10, W, .25);
	glEndQuery(GL_SAMPLES_PASSED);
	return kb_expect_rect(&kb, 0, 0, 0, 10, W, 0, 1, 1, 1, 1) &&
		check_count(query, 10 * W) ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** The query decides over a later draw with the program. */
static enum piglit_result
conditional_render(void *data)
{
	struct kb kb = make("KIL -1;");
	GLuint query = begin(GL_SAMPLES_PASSED);
	bool pass;

	kb_draw(&kb);
	glEndQuery(GL_SAMPLES_PASSED);
	kb_program("MOV result.kbuffer[0], 1;");
	glBeginConditionalRender(query, GL_QUERY_WAIT);
	kb_draw(&kb);
	glEndConditionalRender();
	pass = kb_expect(&kb, 0, 0, 0, 0, 0, 0);
	return check_count(query, 0) && pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
side_effects(void *data)
{
	static const char fs[] =
		"#version 420 compatibility\n"
		"layout(binding = 0, offset = 0) uniform atomic_uint n;\n"
		"out vec4 o;\n"
		"void main() { atomicCounterIncrement(n); o = vec4(1); }\n";
	struct kb kb = make((const char *)data);
	GLuint buffer, n = 0;
	bool pass;

	if (!piglit_is_extension_supported("GL_ARB_shader_atomic_counters") ||
	    piglit_get_gl_version() < 42) {
		printf("no atomic counters here\n");
		return PIGLIT_SKIP;
	}
	glGenBuffers(1, &buffer);
	glBindBuffer(GL_ATOMIC_COUNTER_BUFFER, buffer);
	glBufferData(GL_ATOMIC_COUNTER_BUFFER, 4, &n, GL_DYNAMIC_READ);
	glBindBufferBase(GL_ATOMIC_COUNTER_BUFFER, 0, buffer);
	kb_use_glsl("#version 130\nvoid main() { gl_Position = gl_Vertex; }\n",
		    NULL, fs);
	for (int i = 0; i < 3; i++)
		kb_draw_rect(&kb, 0, 0, 32, W, .5);
	glFinish();
	glGetBufferSubData(GL_ATOMIC_COUNTER_BUFFER, 0, 4, &n);
	pass = n == 3 * 32 * W;
	if (!pass)
		printf("the shader ran %u times\n", n);
	glDeleteBuffers(1, &buffer);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Transform feedback and primitive queries go on as without the stage. */
static enum piglit_result
transform_feedback(void *data)
{
	struct kb kb = make("ADD result.kbuffer[0], kbuffer[0], 1;");
	static const char *varying = "v";
	GLuint program = glCreateProgram(), buffer, query;
	GLuint vs = piglit_compile_shader_text(GL_VERTEX_SHADER,
		"#version 130\nout float v;\n"
		"void main() { gl_Position = gl_Vertex; v = gl_VertexID; }\n");
	float got[6] = { 0 };
	bool pass;

	glAttachShader(program, vs);
	glTransformFeedbackVaryings(program, 1, &varying,
				    GL_INTERLEAVED_ATTRIBS);
	glLinkProgram(program);
	glUseProgram(program);
	glGenBuffers(1, &buffer);
	glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer);
	glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, sizeof(got), NULL,
		     GL_DYNAMIC_READ);
	query = begin(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
	glBeginTransformFeedback(GL_TRIANGLES);
	glBegin(GL_TRIANGLES);
	for (int i = 0; i < 3; i++)
		glVertex2f(i == 1 ? 3 : -1, i == 2 ? 3 : -1);
	glEnd();
	glEndTransformFeedback();
	glEndQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
	glGetBufferSubData(GL_TRANSFORM_FEEDBACK_BUFFER, 0, sizeof(got), got);
	pass = got[0] == 0 && got[1] == 1 && got[2] == 2;
	pass = check_count(query, 1) && pass;
	pass = kb_expect(&kb, 0, 0, 1, 1, 1, 1) && pass;
	glUseProgram(0);
	glDeleteProgram(program);
	glDeleteShader(vs);
	glDeleteBuffers(1, &buffer);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("all-pass", all_pass, NULL),
	KB_SUBTEST("killed", killed, NULL),
	KB_SUBTEST("all-killed", all_killed, NULL),
	KB_SUBTEST("killed-by-entry", killed_by_entry, NULL),
	KB_SUBTEST("failed-tests", failed_tests, NULL),
	KB_SUBTEST("conditional-render", conditional_render, NULL),
	KB_SUBTEST("side-effects", side_effects, "MOV result.kbuffer[0], 1;"),
	KB_SUBTEST("side-effects-of-killed", side_effects, "KIL -1;"),
	KB_SUBTEST("side-effects-without-output", side_effects,
		   "TEMP t;\nMOV t, 0;"),
	KB_SUBTEST("transform-feedback", transform_feedback, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
