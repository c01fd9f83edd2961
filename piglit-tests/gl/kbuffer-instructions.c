/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-instructions.c
 * Every instruction of ARB_fragment_program on entries, with swizzles,
 * negation, write masks and saturation.  Entry 0 is { .5, -2, 3, 4 }, entry 1
 * { 1, 2, -.25, 8 }, the fragment's color { 2, 0, -1, .5 }.
 */

#include "kbuffer-common.h"

#define W 8

/* Of the results' size: approximations of functions may be this far off. */
#define EXACT 0
#define APPROX 2e-5f

struct instruction {
	const char *name, *body;
	float expected[4];
	float tolerance;
};

#define A "kbuffer[0]"
#define B "kbuffer[1]"
#define C "fragment.color"
#define R "result.kbuffer[2]"

static const struct instruction instructions[] = {
	{ "ABS", "ABS " R ", " A ";", { .5, 2, 3, 4 } },
	{ "ADD", "ADD " R ", " A ", " B ";", { 1.5, 0, 2.75, 12 } },
	{ "CMP", "CMP " R ", " A ", " B ", " C ";", { 2, 2, -1, .5 } },
	{ "COS", "COS " R ", " A ".x;",
	  { .87758256, .87758256, .87758256, .87758256 }, APPROX },
	{ "DP3", "DP3 " R ", " A ", " B ";", { -4.25, -4.25, -4.25, -4.25 } },
	{ "DP4", "DP4 " R ", " A ", " B ";", { 27.75, 27.75, 27.75, 27.75 } },
	{ "DPH", "DPH " R ", " A ", " B ";", { 3.75, 3.75, 3.75, 3.75 } },
	{ "DST", "DST " R ", " A ", " B ";", { 1, -4, 3, 8 } },
	{ "EX2", "EX2 " R ", " A ".y;", { .25, .25, .25, .25 }, APPROX },
	{ "FLR", "FLR " R ", " B ".zxyw;", { -1, 1, 2, 8 } },
	{ "FRC", "FRC " R ", " B ".zxyw;", { .75, 0, 0, 0 } },
	{ "LG2", "LG2 " R ", " B ".w;", { 3, 3, 3, 3 }, APPROX },
	{ "LIT", "LIT " R ", " A ".xzzw;", { 1, .5, 81, 1 }, 81 * APPROX },
	{ "LRP", "LRP " R ", " A ", " B ", " C ";", { 1.5, -4, 1.25, 30.5 } },
	{ "MAD", "MAD " R ", " A ", " B ", " C ";", { 2.5, -4, -1.75, 32.5 } },
	{ "MAX", "MAX " R ", " A ", " B ";", { 1, 2, 3, 8 } },
	{ "MIN", "MIN " R ", " A ", " B ";", { .5, -2, -.25, 4 } },
	{ "MOV", "MOV " R ", " A ";", { .5, -2, 3, 4 } },
	{ "MUL", "MUL " R ", " A ", " B ";", { .5, -4, -.75, 32 } },
	{ "POW", "POW " R ", " A ".w, " A ".x;", { 2, 2, 2, 2 }, 2 * APPROX },
	{ "RCP", "RCP " R ", " B ".w;", { .125, .125, .125, .125 }, APPROX },
	{ "RSQ", "RSQ " R ", " A ".w;", { .5, .5, .5, .5 }, APPROX },
	{ "SCS", "SCS " R ".xy, " A ".x;", { .87758256, .47942554, 0, 0 },
	  APPROX },
	{ "SGE", "SGE " R ", " A ", " B ";", { 0, 0, 1, 0 } },
	{ "SIN", "SIN " R ", " A ".x;",
	  { .47942554, .47942554, .47942554, .47942554 }, APPROX },
	{ "SLT", "SLT " R ", " A ", " B ";", { 1, 1, 0, 1 } },
	{ "SUB", "SUB " R ", " A ", " B ";", { -.5, -4, 3.25, -4 } },
	{ "SWZ", "SWZ " R ", " A ", -z, 0, 1, -x;", { -3, 0, 1, -.5 } },
	{ "XPD", "XPD " R ".xyz, " A ", " B ";", { -5.5, 3.125, 3, 0 } },

	{ "sat", "ADD_SAT " R ", " A ", " B ";", { 1, 0, 1, 1 } },
	{ "negate", "ADD " R ", -" A ", -" B ".wzyx;",
	  { -8.5, 2.25, -5, -5 } },
	{ "scalar-swizzle", "MUL " R ", " A ".z, " B ".y;", { 6, 6, 6, 6 } },
	{ "write-mask", "MOV " R ".yw, " A ".xxzz;", { 0, .5, 0, 3 } },
	{ "constants", "PARAM p = { 1, 2 };\nPARAM q = 3;\n"
	  "MAD " R ", p, q, { 0.5, 0.25, 0.125 };", { 3.5, 6.25, .125, 4 } },
	/* One attribute, three different entries and a parameter. */
	{ "many-inputs", "TEMP t;\nMAD t, " A ", " B ", " C ";\n"
	  "ADD " R ", t, fragment.position.w;", { 3.5, -3, -.75, 33.5 } },
	{ "temporary-chain", "TEMP t, u;\nMOV t, " A ";\nMOV t.xy, " B ";\n"
	  "MOV u.zw, t.yxyx;\nMOV u.xy, t.wzyx;\nMOV " R ", u;",
	  { 4, 3, 2, 1 } },
	{ "alias", "TEMP t;\nALIAS s = t;\nADD s, " A ", 1;\nMOV " R ", t;",
	  { 1.5, -1, 4, 5 } },
	{ "precision-hint", "OPTION ARB_precision_hint_fastest;\n"
	  "MOV " R ", " A ";", { .5, -2, 3, 4 } },
	{ "color-names", "MOV " R ", fragment.color[0].bgra;",
	  { -1, 0, 2, .5 } },
	{ "names-with-kbuffer", "TEMP kbuffer0, mykbuffer;\n"
	  "MOV kbuffer0, 1;\nMOV mykbuffer, kbuffer0;\n"
	  "MOV " R ", mykbuffer;", { 1, 1, 1, 1 } },
};

static enum piglit_result
all(void *data)
{
	bool pass = true;

	for (int i = 0; i < ARRAY_SIZE(instructions); i++) {
		const struct instruction *in = instructions + i;
		const float *v = in->expected;
		struct kb kb = kb_create(GL_RGBA32F, 3, 0, W, W);
		bool one;

		kb_fill(&kb, 0, .5, -2, 3, 4);
		kb_fill(&kb, 1, 1, 2, -.25, 8);
		kb_fragment_value(2, 0, -1, .5);
		kb_program(in->body);
		glEnable(GL_KBUFFER_PROGRAM_MESA);
		kb_draw(&kb);
		one = kb_expect(&kb, 2, in->tolerance, v[0], v[1], v[2], v[3])
			&& kb_expect(&kb, 0, 0, .5, -2, 3, 4)
			&& kb_expect(&kb, 1, 0, 1, 2, -.25, 8)
			&& piglit_check_gl_error(GL_NO_ERROR);
		piglit_report_subtest_result(one ? PIGLIT_PASS : PIGLIT_FAIL,
					     "%s", in->name);
		pass = one && pass;
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** "kbuffer" is a reserved word only in programs with the option. */
static enum piglit_result
reserved_word(void *data)
{
	static const char fp[] = "!!ARBfp1.0\nTEMP kbuffer;\n"
		"MOV kbuffer, fragment.color;\nMOV result.color, kbuffer;\n"
		"END\n";
	static const char kp[] = "!!ARBfp1.0\nOPTION MESA_kbuffer_program;\n"
		"TEMP kbuffer;\nMOV kbuffer, fragment.color;\nEND\n";

	return kb_load(GL_FRAGMENT_PROGRAM_ARB, fp, strlen(fp)) ==
		GL_NO_ERROR && kb_load(GL_KBUFFER_PROGRAM_MESA, kp,
				       strlen(kp)) == GL_INVALID_OPERATION ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("all", all, NULL),
	KB_SUBTEST("reserved-word", reserved_word, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(30)
