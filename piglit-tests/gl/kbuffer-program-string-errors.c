/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-program-string-errors.c
 * A program string that is not valid for the target: INVALID_OPERATION, an
 * error position inside the statement that is wrong, a message, and the
 * program that was there before is still there and runs.
 *
 * Two grave accents in a string stand around the text in which the position
 * has to lie; they are not part of it.
 */

#include "kbuffer-common.h"

#define FP "!!ARBfp1.0\n"
#define OPT "OPTION MESA_kbuffer_program;\n"
#define GOOD FP OPT "ADD result.kbuffer[0], kbuffer[0], 1;\nEND\n"

struct bad {
	const char *name;
	const char *string;
	GLenum target;          /**< 0: the k-buffer target */
};

static const struct bad bad_strings[] = {
	{ "no-option", FP "`MOV result.kbuffer[0], 1;\nEND\n`" },
	{ "no-option-no-binding", FP "`TEMP t;\nMOV t, 1;\nEND\n`" },
	{ "misspelt-option",
	  FP "OPTION `MESA_kbuffer_programs`;\nMOV result.kbuffer[0], 1;\nEND\n" },
	{ "option-fog", FP OPT "OPTION `ARB_fog_exp`;\n"
	  "MOV result.kbuffer[0], 1;\nEND\n" },
	{ "option-fog-before", FP "OPTION `ARB_fog_linear`;\n" OPT
	  "MOV result.kbuffer[0], 1;\nEND\n" },
	{ "option-draw-buffers", FP OPT "OPTION `ARB_draw_buffers`;\n"
	  "MOV result.kbuffer[0], 1;\nEND\n" },
	{ "option-ati-draw-buffers", FP "OPTION `ATI_draw_buffers`;\n" OPT
	  "MOV result.kbuffer[0], 1;\nEND\n" },
	{ "option-both-precisions", FP OPT
	  "OPTION ARB_precision_hint_nicest;\n"
	  "OPTION `ARB_precision_hint_fastest`;\n"
	  "MOV result.kbuffer[0], 1;\nEND\n" },
	{ "vertex-header", "`!!ARBvp1.0\n" OPT "`MOV result.kbuffer[0], 1;\nEND\n" },
	{ "no-header", "`" OPT "MOV` result.kbuffer[0], 1;\nEND\n" },
	{ "no-end", FP OPT "MOV result.kbuffer[0], 1;\n``" },
	{ "entry-64", FP OPT "`MOV result.kbuffer[64], 1;`\nEND\n" },
	{ "entry-64-read", FP OPT "`MOV result.kbuffer[0], kbuffer[64];`\nEND\n" },
	{ "entry-negative", FP OPT "`MOV result.kbuffer[-1], 1;`\nEND\n" },
	{ "entry-4294967296",
	  FP OPT "`MOV result.kbuffer[4294967296], 1;`\nEND\n" },
	{ "entry-fraction", FP OPT "`MOV result.kbuffer[0.5], 1;`\nEND\n" },
	{ "entry-variable",
	  FP OPT "TEMP t;\n`MOV result.kbuffer[t], 1;`\nEND\n" },
	{ "entry-without-index", FP OPT "`MOV result.kbuffer, 1;`\nEND\n" },
	{ "entry-unclosed", FP OPT "`MOV result.kbuffer[0, 1;`\nEND\n" },
	{ "write-input", FP OPT "`MOV kbuffer[0], 1;`\nEND\n" },
	{ "read-output",
	  FP OPT "`MOV result.kbuffer[0], result.kbuffer[1];`\nEND\n" },
	{ "result-color", FP OPT "`MOV result.color, 1;`\nEND\n" },
	{ "result-color-n",
	  FP OPT "`OPTION ARB_draw_buffers;\nMOV result.color[1], 1;`\nEND\n" },
	{ "result-depth", FP OPT "`MOV result.depth.z, 1;`\nEND\n" },
	{ "output-of-color", FP OPT "`OUTPUT o = result.color;`\nMOV o, 1;\nEND\n" },
	{ "color-8", FP OPT "`MOV result.kbuffer[0], fragment.color[8];`\nEND\n" },
	{ "color-primary",
	  FP OPT "`MOV result.kbuffer[0], fragment.color.primary;`\nEND\n" },
	{ "color-secondary",
	  FP OPT "`MOV result.kbuffer[0], fragment.color.secondary;`\nEND\n" },
	{ "texcoord", FP OPT "`MOV result.kbuffer[0], fragment.texcoord[0];`\nEND\n" },
	{ "fogcoord", FP OPT "`MOV result.kbuffer[0], fragment.fogcoord;`\nEND\n" },
	{ "undeclared", FP OPT "`MOV result.kbuffer[0], nobody;`\nEND\n" },
	{ "unknown-instruction", FP OPT "`FOO result.kbuffer[0], 1;`\nEND\n" },
	{ "missing-operand", FP OPT "`ADD result.kbuffer[0], 1;`\nEND\n" },
	{ "write-parameter",
	  FP OPT "PARAM p = program.local[0];\n`MOV p, 1;`\nEND\n" },
	{ "pk4ub-sat",
	  FP OPT "`PK4UB_SAT result.kbuffer[0].x, fragment.color;`\nEND\n" },
	{ "up4ub-vector", FP OPT "`UP4UB result.kbuffer[0], kbuffer[0];`\nEND\n" },
	{ "non-ascii", FP OPT "`MOV result.kbuffer[0], \xc3\xa9t\xc3\xa9;`\nEND\n" },
	{ "control-byte", FP OPT "`MOV\x01 result.kbuffer[0], 1;`\nEND\n" },
	{ "fragment-target-option",
	  FP "`" OPT "MOV` result.color, 1;\nEND\n", GL_FRAGMENT_PROGRAM_ARB },
	{ "fragment-target-result",
	  FP "`MOV result.kbuffer[0], 1;`\nEND\n", GL_FRAGMENT_PROGRAM_ARB },
	{ "fragment-target-input",
	  FP "`MOV result.color, kbuffer[0];`\nEND\n", GL_FRAGMENT_PROGRAM_ARB },
	/* Where Mesa sees an unknown word after the header is not exact. */
	{ "fragment-target-pk4ub",
	  "`" FP "PK4UB result.color, fragment.color;`\nEND\n",
	  GL_FRAGMENT_PROGRAM_ARB },
	{ "fragment-target-color-n",
	  FP "`MOV result.color, fragment.color[0];`\nEND\n",
	  GL_FRAGMENT_PROGRAM_ARB },
	{ "vertex-target", "!!ARBvp1.0\n`" OPT "`MOV result.position, 0;\nEND\n",
	  GL_VERTEX_PROGRAM_ARB },
};

/**
 * A failed load says why and where; \p last is -1 for "anywhere".  The end is
 * one after the string for Mesa's parser, which adds a line end to it.
 */
static bool
check_refused(GLenum target, const char *string, int length, int first,
	      int last)
{
	GLint position = -2;
	GLenum error = kb_load(target, string, length);
	const char *message;

	glGetIntegerv(GL_PROGRAM_ERROR_POSITION_ARB, &position);
	message = (const char *)glGetString(GL_PROGRAM_ERROR_STRING_ARB);
	if (last < 0 || last == length)
		last = length + 1;
	if (error == GL_INVALID_OPERATION && position >= first &&
	    position <= last && message && *message)
		return true;
	printf("%.*s\n%s, position %d (expected %d to %d), message \"%s\"\n",
	       length, string, piglit_get_gl_error_name(error), position,
	       first, last, message ? message : "(null)");
	return false;
}

/** The valid program of kb_program() is as it was. */
static bool
check_unharmed(const struct kb *kb)
{
	char got[sizeof(GOOD)] = "";
	GLint length = -1;

	glGetProgramivARB(GL_KBUFFER_PROGRAM_MESA, GL_PROGRAM_LENGTH_ARB,
			  &length);
	if (length == strlen(GOOD))
		glGetProgramStringARB(GL_KBUFFER_PROGRAM_MESA,
				      GL_PROGRAM_STRING_ARB, got);
	if (strcmp(got, GOOD)) {
		printf("the program's string has changed (%d bytes)\n", length);
		return false;
	}
	kb_fill(kb, 0, 1, 2, 3, 4);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(kb);
	return kb_expect(kb, 0, 0, 2, 3, 4, 5) &&
		piglit_check_gl_error(GL_NO_ERROR);
}

static bool
load_good(void)
{
	GLint position = -2;

	kb_program("");
	if (kb_load(GL_KBUFFER_PROGRAM_MESA, GOOD, strlen(GOOD)))
		return false;
	glGetIntegerv(GL_PROGRAM_ERROR_POSITION_ARB, &position);
	return position == -1 && !*glGetString(GL_PROGRAM_ERROR_STRING_ARB);
}

static enum piglit_result
strings(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, 8, 8);
	bool all = load_good();

	for (int i = 0; i < ARRAY_SIZE(bad_strings); i++) {
		const struct bad *bad = bad_strings + i;
		char *string = strdup(bad->string);
		char *first = strchr(string, '`'), *last;
		bool pass;

		memmove(first, first + 1, strlen(first));
		last = strchr(first, '`');
		memmove(last, last + 1, strlen(last));
		pass = check_refused(bad->target ? bad->target :
				     GL_KBUFFER_PROGRAM_MESA, string,
				     strlen(string), first - string,
				     last - string);
		pass = check_unharmed(&kb) && pass;
		if (!pass)
			load_good();
		piglit_report_subtest_result(pass ? PIGLIT_PASS : PIGLIT_FAIL,
					     "%s", bad->name);
		all = pass && all;
		free(string);
	}
	return all ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Every part of a valid program that ends before its END does is refused. */
static enum piglit_result
truncated(void *data)
{
	static const char whole[] = FP OPT
		"# a comment\nPARAM p[2] = { program.env[0..1] };\n"
		"ATTRIB z = fragment.position;\nTEMP t, u;\n"
		"OUTPUT o = result.kbuffer[1];\nALIAS v = t;\n"
		"TEX t, z, texture[0], 2D;\nSLT u.x, kbuffer[1].w, z.z;\n"
		"KIL -v;\nPK4UB t.y, fragment.color[2];\n"
		"CMP o.xz, -u.x, kbuffer[0], t;\nEND";
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, 8, 8);
	bool pass = load_good();

	for (int length = 0; length < strlen(whole) && pass; length++) {
		/* A copy, so that a read past the end is seen by tools. */
		char *part = malloc(length + 1);

		memcpy(part, whole, length);
		pass = check_refused(GL_KBUFFER_PROGRAM_MESA, part, length,
				     0, -1) && pass;
		free(part);
	}
	pass = check_unharmed(&kb) && pass;
	pass = kb_load(GL_KBUFFER_PROGRAM_MESA, whole, strlen(whole)) ==
		GL_NO_ERROR && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
zero_byte(void *data)
{
	static const char inside[] =
		FP OPT "MOV result.kbuffer[0]\0, 1;\nEND\n";
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, 8, 8);
	bool pass = load_good();

	pass = check_refused(GL_KBUFFER_PROGRAM_MESA, inside,
			     sizeof(inside) - 1, 0, -1) && pass;
	pass = check_unharmed(&kb) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Zero bytes that end the string may be counted in its length. */
static enum piglit_result
final_zeros(void *data)
{
	static const char one[] = GOOD, three[] = GOOD "\0\0";
	static const char comment[] = FP OPT
		"ADD result.kbuffer[0], kbuffer[0], 1;\nEND # comment";
	static const char fragment[] = FP "MOV result.color, 1;\nEND\n";
	static const char behind[] = GOOD "\0 ", zeros[4] = { 0 };
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, 8, 8);
	GLint length = 0;
	bool pass;

	kb_program("");
	kb_fragment_value(0, 0, 0, 0);
	pass = kb_load(GL_FRAGMENT_PROGRAM_ARB, fragment, sizeof(fragment)) ==
		GL_NO_ERROR;
	pass = kb_load(GL_KBUFFER_PROGRAM_MESA, comment, sizeof(comment)) ==
		GL_NO_ERROR && pass;
	glGetProgramivARB(GL_KBUFFER_PROGRAM_MESA, GL_PROGRAM_LENGTH_ARB,
			  &length);
	pass = length == strlen(comment) && pass;
	pass = kb_load(GL_KBUFFER_PROGRAM_MESA, one, sizeof(one)) ==
		GL_NO_ERROR && check_unharmed(&kb) && pass;
	pass = kb_load(GL_KBUFFER_PROGRAM_MESA, three, sizeof(three)) ==
		GL_NO_ERROR && check_unharmed(&kb) && pass;

	/* What is not at the end is an error, and so is nothing else. */
	pass = check_refused(GL_KBUFFER_PROGRAM_MESA, behind,
			     sizeof(behind) - 1, strlen(GOOD), -1) && pass;
	pass = check_refused(GL_KBUFFER_PROGRAM_MESA, zeros, sizeof(zeros), 0,
			     -1) && pass;
	return check_unharmed(&kb) && pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Other targets are as exact about strings, if they are valid otherwise. */
static enum piglit_result
fragment_programs(void *data)
{
#define MOV FP "MOV result.color, "
	static const struct {
		const char *string;
		int length;
		int first, last;
	} bad[] = {
#define BAD(before, token, after) \
	{ MOV before token after, sizeof(MOV before token after) - 1, \
	  sizeof(MOV before) - 1, sizeof(MOV before token) - 1 }
		BAD("1", "\0", ";\nEND\n"),
		BAD("1", "\303", "\244;\nEND\n"),
		BAD("1;", "\n", "\0# comment\nEND\n"),
		BAD("1; #", " ", "comment\0\nEND\n"),
		BAD("program.env[", "4294967296", "];\nEND\n"),
		BAD("1      ", ",", " 1;\nEND\n"),
#undef BAD
	};
	static const char good[] = MOV "1; # \303\244\nEND\n\0\0";
#undef MOV
	bool pass;

	kb_program("");
	pass = kb_load(GL_FRAGMENT_PROGRAM_ARB, good, sizeof(good)) ==
		GL_NO_ERROR;
	for (int i = 0; i < ARRAY_SIZE(bad); i++) {
		pass = check_refused(GL_FRAGMENT_PROGRAM_ARB, bad[i].string,
				     bad[i].length, i == 2 || i == 3 ? 0 :
				     bad[i].first, i == 2 || i == 3 ? -1 :
				     bad[i].last) && pass;
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** The options that mean something where there is neither fog nor color. */
static enum piglit_result
other_options(void *data)
{
	static const char *const options[] = {
		"ARB_precision_hint_fastest", "ARB_precision_hint_nicest",
		"ARB_fragment_program_shadow",
		"ARB_fragment_coord_origin_upper_left",
		"ARB_fragment_coord_pixel_center_integer",
	};
	bool pass = true;

	kb_program("");
	for (int i = 0; i < ARRAY_SIZE(options); i++) {
		for (int before = 0; before < 2; before++) {
			char string[256];

			snprintf(string, sizeof(string), FP "%sOPTION %s;\n%s"
				 "MOV result.kbuffer[0], 1;\nEND\n",
				 before ? "" : OPT, options[i],
				 before ? OPT : "");
			if (kb_load(GL_KBUFFER_PROGRAM_MESA, string,
				    strlen(string)) == GL_NO_ERROR)
				continue;
			printf("%s\n", string);
			pass = false;
		}
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
negative_length(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, 8, 8);
	bool pass = load_good();

	pass = kb_load(GL_KBUFFER_PROGRAM_MESA, GOOD, -1) ==
		GL_INVALID_VALUE && pass;
	pass = kb_load(GL_KBUFFER_PROGRAM_MESA, GOOD, INT_MIN) ==
		GL_INVALID_VALUE && pass;
	return check_unharmed(&kb) && pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
wrong_format(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, 8, 8);
	bool pass = load_good();

	glProgramStringARB(GL_KBUFFER_PROGRAM_MESA, GL_RGBA, strlen(GOOD),
			   GOOD);
	pass = piglit_check_gl_error(GL_INVALID_ENUM) && pass;
	return check_unharmed(&kb) && pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** The length counts, not what stands behind it. */
static enum piglit_result
length_counts(void *data)
{
	static const char more[] = GOOD "rubbish";
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, 8, 8);

	kb_program("");
	return kb_load(GL_KBUFFER_PROGRAM_MESA, more, strlen(GOOD)) ==
		GL_NO_ERROR && check_unharmed(&kb) ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("strings", strings, NULL),
	KB_SUBTEST("truncated", truncated, NULL),
	KB_SUBTEST("zero-byte", zero_byte, NULL),
	KB_SUBTEST("final-zeros", final_zeros, NULL),
	KB_SUBTEST("fragment-programs", fragment_programs, NULL),
	KB_SUBTEST("other-options", other_options, NULL),
	KB_SUBTEST("negative-length", negative_length, NULL),
	KB_SUBTEST("wrong-format", wrong_format, NULL),
	KB_SUBTEST("length-counts", length_counts, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(30)
