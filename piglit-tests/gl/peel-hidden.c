/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-hidden.c
 * MESA_EXTENSION_OVERRIDE=-GL_MESA_depth_peeling hides the extension: it is
 * not advertised, its tokens are GL_INVALID_ENUM, drawing is as ever.
 */

#include "piglit-util-gl.h"
#include <GL/mesa_kbuffer.h>

PIGLIT_GL_TEST_CONFIG_BEGIN
	config.supports_gl_compat_version = 30;
	config.window_visual = PIGLIT_GL_VISUAL_RGBA | PIGLIT_GL_VISUAL_DOUBLE;
	config.khr_no_error_support = PIGLIT_HAS_ERRORS;
	setenv("MESA_EXTENSION_OVERRIDE", "-GL_MESA_depth_peeling", 1);
PIGLIT_GL_TEST_CONFIG_END

static bool all = true;

static void
report_result(const char *name, bool pass)
{
	piglit_report_subtest_result(pass ? PIGLIT_PASS : PIGLIT_FAIL, "%s",
				     name);
	all = all && pass;
}

static void
report(const char *name)
{
	report_result(name, piglit_check_gl_error(GL_INVALID_ENUM));
}

enum piglit_result
piglit_display(void)
{
	static const float green[4] = { 0, 1, 0, 1 };
	GLint i = 7;
	GLuint fbo;

	report_result("advertised", !piglit_is_extension_supported(
			      "GL_MESA_depth_peeling"));

	glEnable(GL_DEPTH_PEELING_MESA);
	report("Enable");
	glDisable(GL_DEPTH_PEELING_MESA);
	report("Disable");
	glIsEnabled(GL_DEPTH_PEELING_MESA);
	report("IsEnabled");
	glGetIntegerv(GL_DEPTH_PEELING_MESA, &i);
	report("GetIntegerv-enable");
	glGetIntegerv(GL_MAX_DEPTH_PEELING_LAYERS_MESA, &i);
	report("GetIntegerv-max");

	glGenFramebuffers(1, &fbo);
	glBindFramebuffer(GL_FRAMEBUFFER, fbo);
	glFramebufferParameteri(GL_FRAMEBUFFER,
				GL_DEPTH_PEELING_FIRST_LAYER_MESA, 0);
	report("FramebufferParameteri");
	glGetFramebufferParameteriv(GL_FRAMEBUFFER,
				    GL_DEPTH_PEELING_FIRST_LAYER_MESA, &i);
	report("GetFramebufferParameteriv-first-layer");
	glGetFramebufferParameteriv(GL_FRAMEBUFFER,
				    GL_DEPTH_PEELING_OVERFLOW_MESA, &i);
	report("GetFramebufferParameteriv-overflow");
	report_result("value", i == 7);
	glBindFramebuffer(GL_FRAMEBUFFER, piglit_winsys_fbo);
	glDeleteFramebuffers(1, &fbo);

	glColor4fv(green);
	piglit_draw_rect(-1, -1, 2, 2);
	report_result("draw", piglit_probe_rect_rgba(0, 0, piglit_width,
						     piglit_height, green));
	return all ? PIGLIT_PASS : PIGLIT_FAIL;
}

void
piglit_init(int argc, char **argv)
{
}
