/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-hidden.c
 * MESA_EXTENSION_OVERRIDE=-GL_MESA_kbuffer_program hides the extension: it is
 * not advertised, its tokens are GL_INVALID_ENUM, its option is unknown.
 */

#include "piglit-util-gl.h"
#include <GL/mesa_kbuffer.h>

PIGLIT_GL_TEST_CONFIG_BEGIN
	config.supports_gl_compat_version = 20;
	config.window_visual = PIGLIT_GL_VISUAL_RGBA | PIGLIT_GL_VISUAL_DOUBLE;
	config.khr_no_error_support = PIGLIT_HAS_ERRORS;
	setenv("MESA_EXTENSION_OVERRIDE", "-GL_MESA_kbuffer_program", 1);
PIGLIT_GL_TEST_CONFIG_END

static bool all = true;

static void
report(const char *name, GLenum wanted)
{
	bool pass = piglit_check_gl_error(wanted);

	piglit_report_subtest_result(pass ? PIGLIT_PASS : PIGLIT_FAIL, "%s",
				     name);
	all = all && pass;
}

enum piglit_result
piglit_display(void)
{
	static const float green[4] = { 0, 1, 0, 1 };
	static const char option[] = "!!ARBfp1.0\n"
		"OPTION MESA_kbuffer_program;\nTEMP t;\nMOV t, 1;\nEND\n";
	static const char identifier[] = "!!ARBfp1.0\nTEMP kbuffer;\n"
		"MOV kbuffer, fragment.color;\nMOV result.color, kbuffer;\n"
		"END\n";
	GLint i;
	GLfloat f[4];
	bool pass;

	pass = !piglit_is_extension_supported("GL_MESA_kbuffer_program");
	piglit_report_subtest_result(pass ? PIGLIT_PASS : PIGLIT_FAIL,
				     "advertised");
	all = all && pass;

	glEnable(GL_KBUFFER_PROGRAM_MESA);
	report("Enable", GL_INVALID_ENUM);
	glDisable(GL_KBUFFER_PROGRAM_MESA);
	report("Disable", GL_INVALID_ENUM);
	glIsEnabled(GL_KBUFFER_PROGRAM_MESA);
	report("IsEnabled", GL_INVALID_ENUM);
	glGetIntegerv(GL_KBUFFER_PROGRAM_MESA, &i);
	report("GetIntegerv-enable", GL_INVALID_ENUM);
	glGetIntegerv(GL_MAX_KBUFFER_ENTRIES_MESA, &i);
	report("GetIntegerv-max", GL_INVALID_ENUM);
	glBindProgramARB(GL_KBUFFER_PROGRAM_MESA, 1);
	report("BindProgram", GL_INVALID_ENUM);
	glProgramStringARB(GL_KBUFFER_PROGRAM_MESA,
			   GL_PROGRAM_FORMAT_ASCII_ARB, strlen(option), option);
	report("ProgramString", GL_INVALID_ENUM);
	glGetProgramivARB(GL_KBUFFER_PROGRAM_MESA, GL_PROGRAM_BINDING_ARB, &i);
	report("GetProgramiv", GL_INVALID_ENUM);
	glProgramEnvParameter4fARB(GL_KBUFFER_PROGRAM_MESA, 0, 1, 2, 3, 4);
	report("ProgramEnvParameter", GL_INVALID_ENUM);
	glGetProgramEnvParameterfvARB(GL_KBUFFER_PROGRAM_MESA, 0, f);
	report("GetProgramEnvParameter", GL_INVALID_ENUM);
	glProgramLocalParameter4fARB(GL_KBUFFER_PROGRAM_MESA, 0, 1, 2, 3, 4);
	report("ProgramLocalParameter", GL_INVALID_ENUM);
	glGetProgramLocalParameterfvARB(GL_KBUFFER_PROGRAM_MESA, 0, f);
	report("GetProgramLocalParameter", GL_INVALID_ENUM);

	glBindProgramARB(GL_FRAGMENT_PROGRAM_ARB, 1);
	glProgramStringARB(GL_FRAGMENT_PROGRAM_ARB,
			   GL_PROGRAM_FORMAT_ASCII_ARB, strlen(option), option);
	report("option", GL_INVALID_OPERATION);

	/* The word is an identifier then, and drawing is as ever. */
	glProgramStringARB(GL_FRAGMENT_PROGRAM_ARB,
			   GL_PROGRAM_FORMAT_ASCII_ARB, strlen(identifier),
			   identifier);
	report("identifier", GL_NO_ERROR);
	glEnable(GL_FRAGMENT_PROGRAM_ARB);
	glColor4fv(green);
	piglit_draw_rect(-1, -1, 2, 2);
	pass = piglit_probe_rect_rgba(0, 0, piglit_width, piglit_height,
				      green);
	piglit_report_subtest_result(pass ? PIGLIT_PASS : PIGLIT_FAIL, "draw");
	return all && pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

void
piglit_init(int argc, char **argv)
{
}
