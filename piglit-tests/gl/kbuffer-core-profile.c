/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-core-profile.c
 * The extension belongs to the compatibility profile: a core context does not
 * advertise it and does not know its tokens.
 */

#include "piglit-util-gl.h"
#include <GL/mesa_kbuffer.h>

PIGLIT_GL_TEST_CONFIG_BEGIN
	config.supports_gl_core_version = 32;
	config.window_visual = PIGLIT_GL_VISUAL_RGBA | PIGLIT_GL_VISUAL_DOUBLE;
	config.khr_no_error_support = PIGLIT_HAS_ERRORS;
PIGLIT_GL_TEST_CONFIG_END

enum piglit_result
piglit_display(void)
{
	GLint i;
	bool pass = !piglit_is_extension_supported("GL_MESA_kbuffer_program");

	glEnable(GL_KBUFFER_PROGRAM_MESA);
	pass = piglit_check_gl_error(GL_INVALID_ENUM) && pass;
	glIsEnabled(GL_KBUFFER_PROGRAM_MESA);
	pass = piglit_check_gl_error(GL_INVALID_ENUM) && pass;
	glGetIntegerv(GL_MAX_KBUFFER_ENTRIES_MESA, &i);
	pass = piglit_check_gl_error(GL_INVALID_ENUM) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

void
piglit_init(int argc, char **argv)
{
}
