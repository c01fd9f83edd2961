/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-formats-as-blending.c
 * Formats convert as blending does: the sum of entry and color, by a program
 * and by blending, is the same but for one step of the format.  This covers
 * the formats that have no meaning of their own in kbuffer-formats.c: alpha,
 * luminance, intensity and sizes that Mesa chooses.
 */

#include "kbuffer-common.h"

#define W 16

/** One step of the least precise component, and of rounding to half. */
struct format { const char *name; GLenum format; float step; };

static const struct format formats[] = {
	{ "alpha8", GL_ALPHA8, 1 / 255. },
	{ "alpha16", GL_ALPHA16, 1 / 65535. },
	{ "alpha16f", GL_ALPHA16F_ARB, 1 / 1024. },
	{ "alpha32f", GL_ALPHA32F_ARB, 1e-6 },
	{ "luminance8", GL_LUMINANCE8, 1 / 255. },
	{ "luminance16", GL_LUMINANCE16, 1 / 65535. },
	{ "luminance16f", GL_LUMINANCE16F_ARB, 1 / 1024. },
	{ "luminance32f", GL_LUMINANCE32F_ARB, 1e-6 },
	{ "luminance8-alpha8", GL_LUMINANCE8_ALPHA8, 1 / 255. },
	{ "luminance-alpha16f", GL_LUMINANCE_ALPHA16F_ARB, 1 / 1024. },
	{ "luminance-alpha32f", GL_LUMINANCE_ALPHA32F_ARB, 1e-6 },
	{ "intensity8", GL_INTENSITY8, 1 / 255. },
	{ "intensity16f", GL_INTENSITY16F_ARB, 1 / 1024. },
	{ "intensity32f", GL_INTENSITY32F_ARB, 1e-6 },
	{ "r3-g3-b2", GL_R3_G3_B2, 1 / 3. },
	{ "rgb4", GL_RGB4, 1 / 15. },
	{ "rgb5", GL_RGB5, 1 / 31. },
	{ "rgb10", GL_RGB10, 1 / 255. },
	{ "rgb12", GL_RGB12, 1 / 255. },
	{ "rgba2", GL_RGBA2, 1 / 3. },
	{ "rgba12", GL_RGBA12, 1 / 255. },
	{ "rgba8", GL_RGBA8, 1 / 255. },
	{ "rgb8", GL_RGB8, 1 / 255. },
	{ "rgba16f", GL_RGBA16F, 1 / 1024. },
	{ "rgb565", GL_RGB565, 1 / 31. },
};

static bool
renderable(GLenum format)
{
	GLuint tex, fbo;
	GLenum status;

	glGenTextures(1, &tex);
	glBindTexture(GL_TEXTURE_2D, tex);
	glTexImage2D(GL_TEXTURE_2D, 0, format, W, W, 0, GL_RGBA, GL_FLOAT,
		     NULL);
	glGenFramebuffers(1, &fbo);
	glBindFramebuffer(GL_FRAMEBUFFER, fbo);
	glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
			       GL_TEXTURE_2D, tex, 0);
	status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
	glDeleteFramebuffers(1, &fbo);
	glDeleteTextures(1, &tex);
	return status == GL_FRAMEBUFFER_COMPLETE;
}

/** Clear, add the color once, read as the framebuffer's values. */
static void
add(const struct kb *kb, float *got)
{
	glClearColor(.6, .2, .8, .4);
	glClear(GL_COLOR_BUFFER_BIT);
	kb_draw(kb);
	glReadPixels(0, 0, W, W, GL_RGBA, GL_FLOAT, got);
}

static bool
test_format(const struct format *f)
{
	float blended[W * W * 4], got[W * W * 4];
	struct kb kb;

	if (!renderable(f->format)) {
		printf("%s cannot be rendered to\n", f->name);
		return true;
	}
	kb = kb_create(f->format, 1, 0, W, W);
	/* More than a step of any of the formats is added to. */
	kb_fragment_value(.4, .5, .2, .6);
	glEnable(GL_BLEND);
	glBlendFunc(GL_ONE, GL_ONE);
	glDisable(GL_KBUFFER_PROGRAM_MESA);
	add(&kb, blended);
	glDisable(GL_BLEND);
	kb_program("ADD result.kbuffer[0], kbuffer[0], fragment.color;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	add(&kb, got);
	for (int i = 0; i < W * W * 4; i++) {
		if (fabsf(got[i] - blended[i]) <= f->step * 1.01f)
			continue;
		printf("%s, component %d: blending gives %g, the program %g\n",
		       f->name, i % 4, blended[i], got[i]);
		return false;
	}
	return true;
}

static enum piglit_result
all(void *data)
{
	bool pass = true;

	for (int i = 0; i < ARRAY_SIZE(formats); i++) {
		const bool one = test_format(formats + i);

		piglit_report_subtest_result(one ? PIGLIT_PASS : PIGLIT_FAIL,
					     "%s", formats[i].name);
		pass = one && pass;
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("all", all, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
