/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-parameters.c
 * Environment parameters of the target and local parameters of its programs:
 * every way to set and get them, apart from those of the fragment target,
 * errors, and a changed value counts from the next draw on.
 */

#include "kbuffer-common.h"

#define K GL_KBUFFER_PROGRAM_MESA
#define F GL_FRAGMENT_PROGRAM_ARB

static bool
same(const float *got, float x, float y, float z, float w)
{
	if (got[0] == x && got[1] == y && got[2] == z && got[3] == w)
		return true;
	printf("got %g %g %g %g, expected %g %g %g %g\n", got[0], got[1],
	       got[2], got[3], x, y, z, w);
	return false;
}

static bool
check_env(GLenum target, int index, float x, float y, float z, float w)
{
	float f[4] = { -9, -9, -9, -9 };
	double d[4] = { -9, -9, -9, -9 };

	glGetProgramEnvParameterfvARB(target, index, f);
	glGetProgramEnvParameterdvARB(target, index, d);
	return same(f, x, y, z, w) && d[0] == x && d[1] == y && d[2] == z &&
		d[3] == w;
}

static bool
check_local(GLenum target, int index, float x, float y, float z, float w)
{
	float f[4] = { -9, -9, -9, -9 };
	double d[4] = { -9, -9, -9, -9 };

	glGetProgramLocalParameterfvARB(target, index, f);
	glGetProgramLocalParameterdvARB(target, index, d);
	return same(f, x, y, z, w) && d[0] == x && d[1] == y && d[2] == z &&
		d[3] == w;
}

static const float f2[2][4] = { { 1, 2, 3, 4 }, { 5, 6, 7, 8 } };
static const double d1[4] = { .5, .25, -1, 1e6 };

static enum piglit_result
env(void *data)
{
	bool pass = check_env(K, 3, 0, 0, 0, 0);

	glProgramEnvParameter4fARB(K, 0, 1, 2, 3, 4);
	glProgramEnvParameter4dARB(K, 1, 9, 8, 7, 6);
	glProgramEnvParameter4fvARB(K, 2, f2[1]);
	glProgramEnvParameter4dvARB(K, 3, d1);
	pass = check_env(K, 0, 1, 2, 3, 4) && pass;
	pass = check_env(K, 1, 9, 8, 7, 6) && pass;
	pass = check_env(K, 2, 5, 6, 7, 8) && pass;
	pass = check_env(K, 3, .5, .25, -1, 1e6) && pass;
	if (piglit_is_extension_supported("GL_EXT_gpu_program_parameters")) {
		glProgramEnvParameters4fvEXT(K, 5, 2, f2[0]);
		pass = check_env(K, 5, 1, 2, 3, 4) && pass;
		pass = check_env(K, 6, 5, 6, 7, 8) && pass;
	}

	/* The fragment target has a set of its own. */
	pass = check_env(F, 0, 0, 0, 0, 0) && pass;
	glProgramEnvParameter4fARB(F, 0, -1, -2, -3, -4);
	pass = check_env(K, 0, 1, 2, 3, 4) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
local(void *data)
{
	GLuint one = kb_program("MOV result.kbuffer[0], program.local[0];");
	GLuint two = kb_program("MOV result.kbuffer[0], program.local[0];");
	bool pass = check_local(K, 0, 0, 0, 0, 0);

	glProgramLocalParameter4fARB(K, 0, 1, 2, 3, 4);
	glProgramLocalParameter4dARB(K, 1, 9, 8, 7, 6);
	glProgramLocalParameter4fvARB(K, 2, f2[1]);
	glProgramLocalParameter4dvARB(K, 3, d1);
	pass = check_local(K, 0, 1, 2, 3, 4) && pass;
	pass = check_local(K, 1, 9, 8, 7, 6) && pass;
	pass = check_local(K, 2, 5, 6, 7, 8) && pass;
	pass = check_local(K, 3, .5, .25, -1, 1e6) && pass;
	if (piglit_is_extension_supported("GL_EXT_gpu_program_parameters")) {
		glProgramLocalParameters4fvEXT(K, 5, 2, f2[0]);
		pass = check_local(K, 5, 1, 2, 3, 4) && pass;
		pass = check_local(K, 6, 5, 6, 7, 8) && pass;
	}

	/* Each program has a set of its own. */
	glBindProgramARB(K, one);
	pass = check_local(K, 0, 0, 0, 0, 0) && pass;
	glBindProgramARB(K, two);
	pass = check_local(K, 0, 1, 2, 3, 4) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
direct_state_access(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, 8, 8);
	GLuint one = kb_program("MOV result.kbuffer[0], program.local[1];");
	float got[4] = { 0 };
	bool pass;

	piglit_require_extension("GL_EXT_direct_state_access");
	glEnable(K);
	glNamedProgramLocalParameter4fEXT(one, K, 1, 1, 2, 3, 4);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 1, 2, 3, 4);
	kb_program("MOV result.kbuffer[0], 0;");
	glNamedProgramLocalParameter4fvEXT(one, K, 1, f2[1]);
	glGetNamedProgramLocalParameterfvEXT(one, K, 1, got);
	pass = same(got, 5, 6, 7, 8) && pass;
	glBindProgramARB(K, one);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 5, 6, 7, 8) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
index_errors(void *data)
{
	GLint env_max, local_max;
	float f[4];
	bool pass = true;

	kb_program("MOV result.kbuffer[0], 0;");
	glGetProgramivARB(K, GL_MAX_PROGRAM_ENV_PARAMETERS_ARB, &env_max);
	glGetProgramivARB(K, GL_MAX_PROGRAM_LOCAL_PARAMETERS_ARB, &local_max);

	glProgramEnvParameter4fARB(K, env_max, 1, 2, 3, 4);
	pass = piglit_check_gl_error(GL_INVALID_VALUE) && pass;
	glGetProgramEnvParameterfvARB(K, env_max, f);
	pass = piglit_check_gl_error(GL_INVALID_VALUE) && pass;
	glProgramEnvParameters4fvEXT(K, env_max - 1, 2, f2[0]);
	pass = piglit_check_gl_error(GL_INVALID_VALUE) && pass;
	glProgramEnvParameters4fvEXT(K, 0, -1, f2[0]);
	pass = piglit_check_gl_error(GL_INVALID_VALUE) && pass;
	glProgramLocalParameter4fARB(K, local_max, 1, 2, 3, 4);
	pass = piglit_check_gl_error(GL_INVALID_VALUE) && pass;
	glGetProgramLocalParameterfvARB(K, local_max, f);
	pass = piglit_check_gl_error(GL_INVALID_VALUE) && pass;

	glProgramEnvParameter4fARB(K, env_max - 1, 1, 2, 3, 4);
	glProgramLocalParameter4fARB(K, local_max - 1, 4, 3, 2, 1);
	pass = check_env(K, env_max - 1, 1, 2, 3, 4) && pass;
	pass = check_local(K, local_max - 1, 4, 3, 2, 1) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Draws between changes, with nothing else changed. */
static enum piglit_result
change_between_draws(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 2, 0, 8, 8);
	float env_sum = 0, local_sum = 0;

	kb_program("ADD result.kbuffer[0], kbuffer[0], program.env[7];\n"
		   "ADD result.kbuffer[1], kbuffer[1], program.local[7];");
	glEnable(K);
	for (int i = 0; i < 50; i++) {
		if (i % 2) {
			glProgramEnvParameter4fARB(K, 7, i, -i, 2 * i, 1);
		} else {
			glProgramLocalParameter4fARB(K, 7, 3 * i, i, 0, 1);
		}
		/* Those of the fragment target are none of its business. */
		glProgramEnvParameter4fARB(F, 7, 1000, 1000, 1000, 1000);
		kb_draw(&kb);
		env_sum += i % 2 ? i : MAX2(i - 1, 0);
		local_sum += 3 * (i % 2 ? i - 1 : i);
	}
	return kb_expect(&kb, 0, 0, env_sum, -env_sum, 2 * env_sum, 49) &&
		kb_expect(&kb, 1, 0, local_sum, local_sum / 3, 0, 50) ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

/** The fragment program and the k-buffer program read each its own. */
static enum piglit_result
both_stages(void *data)
{
	static const char fp[] = "!!ARBfp1.0\n"
		"ADD result.color, program.env[0], program.local[0];\nEND\n";
	struct kb kb = kb_create(GL_RGBA32F, 2, 0, 8, 8);
	bool pass;

	kb_program("ADD result.kbuffer[0], program.env[0], program.local[0];\n"
		   "MOV result.kbuffer[1], fragment.color;");
	kb_fragment_value(0, 0, 0, 0);
	pass = kb_load(F, fp, strlen(fp)) == GL_NO_ERROR;
	glProgramEnvParameter4fARB(K, 0, 1, 2, 3, 4);
	glProgramLocalParameter4fARB(K, 0, 10, 20, 30, 40);
	glProgramEnvParameter4fARB(F, 0, 5, 6, 7, 8);
	glProgramLocalParameter4fARB(F, 0, 50, 60, 70, 80);
	glEnable(K);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 11, 22, 33, 44) && pass;
	pass = kb_expect(&kb, 1, 0, 55, 66, 77, 88) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
arrays(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 2, 0, 8, 8);

	kb_program("PARAM e[4] = { program.env[2..5] };\n"
		   "PARAM m[] = { program.local[1..2], { 10, 20, 30, 40 },"
		   " program.env[9], 0.5 };\nTEMP t;\n"
		   "ADD t, e[0], e[3];\n"
		   "MOV result.kbuffer[0], t;\n"
		   "ADD t, m[0], m[1];\nADD t, t, m[2];\n"
		   "ADD t, t, m[3];\nADD result.kbuffer[1], t, m[4];");
	for (int i = 0; i < 10; i++) {
		glProgramEnvParameter4fARB(K, i, i, 10 * i, 100 * i, 1);
		glProgramLocalParameter4fARB(K, i, i, i, 2 * i, -i);
	}
	glEnable(K);
	kb_draw(&kb);
	return kb_expect(&kb, 0, 0, 7, 70, 700, 2) &&
		kb_expect(&kb, 1, 0, 22.5, 113.5, 936.5, 38.5) ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("env", env, NULL),
	KB_SUBTEST("local", local, NULL),
	KB_SUBTEST("direct-state-access", direct_state_access, NULL),
	KB_SUBTEST("index-errors", index_errors, NULL),
	KB_SUBTEST("change-between-draws", change_between_draws, NULL),
	KB_SUBTEST("both-stages", both_stages, NULL),
	KB_SUBTEST("arrays", arrays, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(30)
