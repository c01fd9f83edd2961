/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-limits.c
 * GL_MAX_KBUFFER_ENTRIES_MESA and the program limits of the target: what is
 * promised can be used, one more is refused.
 */

#include "kbuffer-capability.h"

#define HEAD "!!ARBfp1.0\nOPTION MESA_kbuffer_program;\n"

static int
max_entries(void)
{
	GLint n = 0;

	glGetIntegerv(GL_MAX_KBUFFER_ENTRIES_MESA, &n);
	return n;
}

static int
program_value(GLenum pname)
{
	GLint n = -1;

	glGetProgramivARB(GL_KBUFFER_PROGRAM_MESA, pname, &n);
	return n;
}

/** The two drivers of this project have 64 entries; 8 is the minimum. */
static enum piglit_result
entries(void *data)
{
	return kb_check_limit(GL_MAX_KBUFFER_ENTRIES_MESA, 8) &&
		max_entries() == 64 ? PIGLIT_PASS : PIGLIT_FAIL;
}

/* The minimum values of the specification. */
#define MIN_INSTRUCTIONS 4096
#define MIN_TEX_INSTRUCTIONS 256
#define MIN_TEX_INDIRECTIONS 256
#define MIN_TEMPORARIES 256
#define MIN_PARAMETERS 256
#define MIN_LOCAL_PARAMETERS 256
#define MIN_ENV_PARAMETERS 256

static enum piglit_result
minimum_values(void *data)
{
	GLint draw_buffers = 0;

	glGetIntegerv(GL_MAX_DRAW_BUFFERS, &draw_buffers);

	const int attribs = 1 + draw_buffers + max_entries();
	const struct { GLenum pname; int min; } limits[] = {
		{ GL_MAX_PROGRAM_INSTRUCTIONS_ARB, MIN_INSTRUCTIONS },
		{ GL_MAX_PROGRAM_NATIVE_INSTRUCTIONS_ARB, MIN_INSTRUCTIONS },
		{ GL_MAX_PROGRAM_ALU_INSTRUCTIONS_ARB, MIN_INSTRUCTIONS },
		{ GL_MAX_PROGRAM_NATIVE_ALU_INSTRUCTIONS_ARB,
		  MIN_INSTRUCTIONS },
		{ GL_MAX_PROGRAM_TEX_INSTRUCTIONS_ARB, MIN_TEX_INSTRUCTIONS },
		{ GL_MAX_PROGRAM_NATIVE_TEX_INSTRUCTIONS_ARB,
		  MIN_TEX_INSTRUCTIONS },
		{ GL_MAX_PROGRAM_TEX_INDIRECTIONS_ARB, MIN_TEX_INDIRECTIONS },
		{ GL_MAX_PROGRAM_NATIVE_TEX_INDIRECTIONS_ARB,
		  MIN_TEX_INDIRECTIONS },
		{ GL_MAX_PROGRAM_TEMPORARIES_ARB, MIN_TEMPORARIES },
		{ GL_MAX_PROGRAM_NATIVE_TEMPORARIES_ARB, MIN_TEMPORARIES },
		{ GL_MAX_PROGRAM_PARAMETERS_ARB, MIN_PARAMETERS },
		{ GL_MAX_PROGRAM_NATIVE_PARAMETERS_ARB, MIN_PARAMETERS },
		{ GL_MAX_PROGRAM_ATTRIBS_ARB, attribs },
		{ GL_MAX_PROGRAM_NATIVE_ATTRIBS_ARB, attribs },
		{ GL_MAX_PROGRAM_LOCAL_PARAMETERS_ARB, MIN_LOCAL_PARAMETERS },
		{ GL_MAX_PROGRAM_ENV_PARAMETERS_ARB, MIN_ENV_PARAMETERS },
	};
	bool pass = true;

	for (int i = 0; i < ARRAY_SIZE(limits); i++) {
		int n = program_value(limits[i].pname);

		if (n >= limits[i].min)
			continue;
		printf("%s is %d, less than %d\n",
		       piglit_get_gl_enum_name(limits[i].pname), n,
		       limits[i].min);
		pass = false;
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/**
 * A program that is at all of these values at once loads and runs: temporaries
 * that are all alive, of parameters of both kinds; lookups that each depend on
 * the one before; sums of them.
 */
static enum piglit_result
minimum_values_at_once(void *data)
{
	enum { LINE = 80, LOCALS = MIN_PARAMETERS / 2 };
	/* Texel i leads to texel i + 1, and to 0 from the last. */
	static const float texels[8] = {
		1.5 / 8, 2.5 / 8, 3.5 / 8, 4.5 / 8, 5.5 / 8, 6.5 / 8, 7.5 / 8,
		.5 / 8
	};
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, 8, 8);
	const GLuint tex = kb_new_texture();
	char *body = calloc(MIN_INSTRUCTIONS + MIN_TEMPORARIES, LINE);
	char *end = body;
	float sum = 0, last = .5f / 8;
	int instructions = 0;
	bool pass;

	glBindTexture(GL_TEXTURE_1D, tex);
	glTexImage1D(GL_TEXTURE_1D, 0, GL_R32F, 8, 0, GL_RED, GL_FLOAT, texels);
	glTexParameteri(GL_TEXTURE_1D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	glTexParameteri(GL_TEXTURE_1D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);

	/* Temporary 0 is the coordinate, from the entry's alpha. */
	end += sprintf(end, "TEMP t0;\nMOV t0, kbuffer[0].w;\n");
	instructions++;
	for (int i = 1; i < MIN_TEMPORARIES; i++, instructions++)
		end += sprintf(end, "TEMP t%d;\nMUL t%d, kbuffer[0], "
			       "program.%s[%d];\n", i, i,
			       i < LOCALS ? "local" : "env", i % LOCALS);
	for (int i = 0; i < MIN_TEX_INSTRUCTIONS; i++, instructions++) {
		end += sprintf(end, "TEX t0, t0, texture[0], 1D;\n");
		last = texels[(int)(last * 8)];
	}
	sum = 1;
	for (int i = 2; instructions < MIN_INSTRUCTIONS - 2; instructions++) {
		end += sprintf(end, "ADD t1, t1, t%d;\n", i);
		sum += i % 5;
		i = i + 1 < MIN_TEMPORARIES ? i + 1 : 2;
	}
	/* The last parameter, which is local number 0. */
	end += sprintf(end, "MUL t1.w, t0.x, program.local[0];\n");
	sprintf(end, "MOV result.kbuffer[0], t1;");
	kb_program(body);
	for (int i = 0; i < MIN_PARAMETERS; i++) {
		const float v = i % 5;

		if (i < LOCALS)
			glProgramLocalParameter4fARB(GL_KBUFFER_PROGRAM_MESA,
						     i, v, v, v, v);
		else
			glProgramEnvParameter4fARB(GL_KBUFFER_PROGRAM_MESA,
						   i % LOCALS, v, v, v, v);
	}
	glProgramLocalParameter4fARB(GL_KBUFFER_PROGRAM_MESA, 0, 8, 8, 8, 8);

	pass = program_value(GL_PROGRAM_INSTRUCTIONS_ARB) >= MIN_INSTRUCTIONS &&
		program_value(GL_PROGRAM_TEX_INSTRUCTIONS_ARB) ==
		MIN_TEX_INSTRUCTIONS &&
		program_value(GL_PROGRAM_TEMPORARIES_ARB) == MIN_TEMPORARIES &&
		program_value(GL_PROGRAM_PARAMETERS_ARB) == MIN_PARAMETERS &&
		program_value(GL_PROGRAM_UNDER_NATIVE_LIMITS_ARB) == 1;
	if (!pass)
		printf("%d instructions, %d of texture, %d temporaries, "
		       "%d parameters, native %d\n",
		       program_value(GL_PROGRAM_INSTRUCTIONS_ARB),
		       program_value(GL_PROGRAM_TEX_INSTRUCTIONS_ARB),
		       program_value(GL_PROGRAM_TEMPORARIES_ARB),
		       program_value(GL_PROGRAM_PARAMETERS_ARB),
		       program_value(GL_PROGRAM_UNDER_NATIVE_LIMITS_ARB));
	kb_fill(&kb, 0, 1, 2, 3, .5f / 8);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, sum, 2 * sum, 3 * sum, 8 * last) && pass;
	free(body);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Sorting 64 entries takes about five instructions an entry. */
static enum piglit_result
instructions_for_all_entries(void *data)
{
	return program_value(GL_MAX_PROGRAM_INSTRUCTIONS_ARB) >= 5 * 64 &&
		program_value(GL_MAX_PROGRAM_ATTRIBS_ARB) >= 64 ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

/** A program of n instructions "ADD t, t, 1;" and a store; free() it. */
static char *
long_program(int n)
{
	static const char add[] = "ADD t, t, 1;\n";
	char *string = malloc(200 + n * sizeof(add)), *end = string;

	end += sprintf(end, HEAD "TEMP t;\nMOV t, 0;\n");
	for (int i = 2; i < n; i++)
		end += sprintf(end, add);
	sprintf(end, "MOV result.kbuffer[0], t;\nEND\n");
	return string;
}

static enum piglit_result
long_program_runs(void *data)
{
	const int n = MIN2(program_value(GL_MAX_PROGRAM_INSTRUCTIONS_ARB),
			   1000);
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, 8, 8);
	char *string = long_program(n);
	bool pass;

	kb_program("");
	pass = kb_load(GL_KBUFFER_PROGRAM_MESA, string, strlen(string)) ==
		GL_NO_ERROR;
	pass = program_value(GL_PROGRAM_INSTRUCTIONS_ARB) >= n && pass;
	pass = program_value(GL_PROGRAM_UNDER_NATIVE_LIMITS_ARB) == 1 && pass;
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, n - 2, n - 2, n - 2, n - 2) && pass;
	free(string);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
too_many_instructions(void *data)
{
	const int n = program_value(GL_MAX_PROGRAM_INSTRUCTIONS_ARB);
	GLint position = -1;
	char *string;
	bool pass;

	/* More than memory holds is no limit that a program could meet. */
	if (n > 1 << 20) {
		printf("%d instructions are allowed\n", n);
		return PIGLIT_FAIL;
	}
	string = long_program(n + 1);
	kb_program("");
	pass = kb_load(GL_KBUFFER_PROGRAM_MESA, string, strlen(string)) ==
		GL_INVALID_OPERATION;
	glGetIntegerv(GL_PROGRAM_ERROR_POSITION_ARB, &position);
	pass = position >= 0 && position <= strlen(string) && pass;
	pass = *glGetString(GL_PROGRAM_ERROR_STRING_ARB) && pass;
	free(string);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Load HEAD, "MOV result.kbuffer[0], <what>[<index>];", END. */
static GLenum
load_indexed(const char *what, int index)
{
	char string[256];

	snprintf(string, sizeof(string),
		 HEAD "MOV result.kbuffer[0], %s[%d];\nEND\n", what, index);
	return kb_load(GL_KBUFFER_PROGRAM_MESA, string, strlen(string));
}

struct indexed { const char *binding; GLenum limit; };

static enum piglit_result
last_index(void *data)
{
	const struct indexed *in = data;
	const int n = in->limit == GL_MAX_KBUFFER_ENTRIES_MESA ?
		max_entries() : program_value(in->limit);

	kb_program("");
	return load_indexed(in->binding, n - 1) == GL_NO_ERROR &&
		load_indexed(in->binding, n) == GL_INVALID_OPERATION ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

static const struct indexed
kbuffer_entry = { "kbuffer", GL_MAX_KBUFFER_ENTRIES_MESA },
local_parameter = { "program.local", GL_MAX_PROGRAM_LOCAL_PARAMETERS_ARB },
env_parameter = { "program.env", GL_MAX_PROGRAM_ENV_PARAMETERS_ARB };

/** Every color output that there can be is an input. */
static enum piglit_result
all_color_inputs(void *data)
{
	GLint n = 0;

	glGetIntegerv(GL_MAX_DRAW_BUFFERS, &n);
	kb_program("");
	return load_indexed("fragment.color", n - 1) == GL_NO_ERROR &&
		load_indexed("fragment.color", n) == GL_INVALID_OPERATION ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

/** All temporaries that are promised (at most 200 of them) can be live. */
static enum piglit_result
temporaries(void *data)
{
	const int n = MIN2(program_value(GL_MAX_PROGRAM_TEMPORARIES_ARB), 200);
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, 8, 8);
	char *body = calloc(n + 1, 100), *end = body;
	float sum = 0;
	bool pass;

	for (int i = 0; i < n; i++) {
		end += sprintf(end, "TEMP t%d;\n"
			       "MUL t%d, kbuffer[0], %d;\n", i, i, i);
		sum += i;
	}
	for (int i = 1; i < n; i++)
		end += sprintf(end, "ADD t0, t0, t%d;\n", i);
	sprintf(end, "MOV result.kbuffer[0], t0;");
	kb_program(body);
	pass = program_value(GL_PROGRAM_TEMPORARIES_ARB) == n;
	kb_fill(&kb, 0, 1, 2, 3, 4);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, sum, 2 * sum, 3 * sum, 4 * sum) && pass;
	free(body);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("entries", entries, NULL),
	KB_SUBTEST("minimum-values", minimum_values, NULL),
	KB_SUBTEST("minimum-values-at-once", minimum_values_at_once, NULL),
	KB_SUBTEST("instructions-for-all-entries",
		   instructions_for_all_entries, NULL),
	KB_SUBTEST("long-program-runs", long_program_runs, NULL),
	KB_SUBTEST("too-many-instructions", too_many_instructions, NULL),
	KB_SUBTEST("last-entry", last_index, &kbuffer_entry),
	KB_SUBTEST("last-local-parameter", last_index, &local_parameter),
	KB_SUBTEST("last-env-parameter", last_index, &env_parameter),
	KB_SUBTEST("all-color-inputs", all_color_inputs, NULL),
	KB_SUBTEST("temporaries", temporaries, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(30)
