/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-position.c
 * fragment.position is window x, y, z, 1/w: x and y of the pixel's center with
 * the origin at the bottom also in the window system's framebuffer, z the
 * depth that the depth test uses.
 */

#include "kbuffer-common.h"

#define W 64

static const char store_position[] =
	"MOV result.kbuffer[0], fragment.position;";

static struct kb
make(GLenum depth)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);

	if (depth) {
		kb_attach_depth(&kb, depth);
		glClearDepth(1);
		glClear(GL_DEPTH_BUFFER_BIT);
		glEnable(GL_DEPTH_TEST);
		glDepthFunc(GL_ALWAYS);
	}
	kb_program(store_position);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	return kb;
}

static enum piglit_result
x_and_y(void *data)
{
	struct kb kb = make(GL_NONE);
	float *got;
	bool pass = true;

	kb_draw(&kb);
	got = kb_read(&kb, 0);
	for (int i = 0; i < W * W && pass; i++) {
		pass = got[4 * i] == i % W + .5f &&
			got[4 * i + 1] == i / W + .5f &&
			got[4 * i + 2] == .5f && got[4 * i + 3] == 1;
		if (!pass)
			printf("(%d, %d): %g %g %g %g\n", i % W, i / W,
			       got[4 * i], got[4 * i + 1], got[4 * i + 2],
			       got[4 * i + 3]);
	}
	free(got);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** The conventions of ARB_fragment_coord_conventions are options. */
static enum piglit_result
upper_left_and_integer(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	float *got;
	bool pass = true;

	kb_program("OPTION ARB_fragment_coord_origin_upper_left;\n"
		   "OPTION ARB_fragment_coord_pixel_center_integer;\n"
		   "MOV result.kbuffer[0], fragment.position;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	got = kb_read(&kb, 0);
	for (int i = 0; i < W * W && pass; i++) {
		pass = got[4 * i] == i % W && got[4 * i + 1] == W - 1 - i / W;
		if (!pass)
			printf("(%d, %d): %g %g\n", i % W, i / W, got[4 * i],
			       got[4 * i + 1]);
	}
	free(got);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** A plane in perspective: z and 1/w of window space are linear in x. */
static enum piglit_result
perspective(void *data)
{
	struct kb kb = make(GL_NONE);
	float *got;
	bool pass = true;

	glBegin(GL_QUADS);
	/* w = 1, z = -1 on the left; w = 4, z = 3 of 4 on the right */
	glVertex4f(-1, -1, -1, 1);
	glVertex4f(4, -4, 3, 4);
	glVertex4f(4, 4, 3, 4);
	glVertex4f(-1, 1, -1, 1);
	glEnd();
	got = kb_read(&kb, 0);
	for (int i = 0; i < W * W && pass; i++) {
		const double t = (i % W + .5) / W;
		const double z = .875 * t, w = 1 + (.25 - 1) * t;

		/* A plane equation in single precision. */
		pass = fabs(got[4 * i + 2] - z) <= 1e-6 &&
			fabs(got[4 * i + 3] - w) <= 1e-6;
		if (!pass)
			printf("(%d, %d): z %.9g, expected %.9g, 1/w %.9g, "
			       "expected %.9g\n", i % W, i / W,
			       got[4 * i + 2], z, got[4 * i + 3], w);
	}
	free(got);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Every pixel's z is the value in the 32-bit float depth buffer. */
static bool
equals_depth_buffer(const struct kb *kb)
{
	float *got = kb_read(kb, 0), *z = malloc(W * W * 4);
	bool pass = true;

	glReadPixels(0, 0, W, W, GL_DEPTH_COMPONENT, GL_FLOAT, z);
	for (int i = 0; i < W * W && pass; i++) {
		pass = z[i] == got[4 * i + 2];
		if (!pass)
			printf("(%d, %d): z %.9g, depth buffer %.9g\n", i % W,
			       i / W, got[4 * i + 2], z[i]);
	}
	free(got);
	free(z);
	return pass;
}

static void
slanted(float z0, float z1)
{
	glBegin(GL_QUADS);
	glVertex3f(-1, -1, z0);
	glVertex3f(1, -1, z1);
	glVertex3f(1, 1, z1);
	glVertex3f(-1, 1, z0);
	glEnd();
}

static enum piglit_result
interpolated(void *data)
{
	struct kb kb = make(GL_DEPTH_COMPONENT32F);

	slanted(-.9, .7);
	return equals_depth_buffer(&kb) ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
depth_range(void *data)
{
	struct kb kb = make(GL_DEPTH_COMPONENT32F);
	bool pass;

	glDepthRange(.75, .25);
	slanted(-1, 1);
	pass = equals_depth_buffer(&kb);
	/* .75 - .5 * .5/64 at the first pixel's center */
	pass = kb_expect_rect(&kb, 0, 0, 0, 1, 1, 1e-6, .5, .5, .74609375, 1)
		&& pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
polygon_offset(void *data)
{
	struct kb kb = make(GL_DEPTH_COMPONENT32F);
	float *got;
	bool pass;

	glEnable(GL_POLYGON_OFFSET_FILL);
	/* The slope is .5 of depth in 64 pixels: 16 of it are .125. */
	glPolygonOffset(16, 0);
	slanted(-1, 0);
	pass = equals_depth_buffer(&kb);
	got = kb_read(&kb, 0);
	pass = fabsf(got[2] - (.125f + .00390625f)) < 1e-6 && pass;
	if (!pass)
		printf("first pixel's z %.9g\n", got[2]);
	free(got);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Clamped into the depth range, as it is stored. */
static enum piglit_result
depth_clamp(void *data)
{
	struct kb kb = make(GL_DEPTH_COMPONENT32F);
	bool pass;

	glEnable(GL_DEPTH_CLAMP);
	slanted(-3, 3);
	pass = equals_depth_buffer(&kb);
	pass = kb_expect_rect(&kb, 0, 0, 0, 1, 1, 0, .5, .5, 0, 1) && pass;
	pass = kb_expect_rect(&kb, 0, W - 1, 0, 1, 1, 0, W - .5, .5, 1, 1) &&
		pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** The fragment stage writes depth: that one counts. */
static enum piglit_result
written_depth(void *data)
{
	static const char fp[] = "!!ARBfp1.0\n"
		"MUL result.depth.z, fragment.position.x, 0.015625;\n"
		"MOV result.color, 0;\nEND\n";
	struct kb kb = make((GLenum)(intptr_t)data);
	float *got;
	bool pass = true;

	kb_fragment_value(0, 0, 0, 0);
	if (kb_load(GL_FRAGMENT_PROGRAM_ARB, fp, strlen(fp)))
		return PIGLIT_FAIL;
	kb_draw(&kb);
	if (data)
		pass = equals_depth_buffer(&kb);
	got = kb_read(&kb, 0);
	for (int i = 0; i < W * W && pass; i++) {
		pass = got[4 * i + 2] == (i % W + .5f) / W;
		if (!pass)
			printf("(%d, %d): z %.9g, written was %.9g\n", i % W,
			       i / W, got[4 * i + 2], (i % W + .5f) / W);
	}
	free(got);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** With early tests the shader's depth is ignored, here as in the buffer. */
static enum piglit_result
early_tests(void *data)
{
	struct kb kb = make(GL_DEPTH_COMPONENT32F);
	bool pass;

	if (!piglit_is_extension_supported(
			"GL_ARB_shader_image_load_store")) {
		printf("no early fragment tests here\n");
		return PIGLIT_SKIP;
	}
	kb_use_glsl("#version 130\nvoid main() { gl_Position = gl_Vertex; }\n",
		    NULL, "#version 150 compatibility\n"
		    "#extension GL_ARB_shader_image_load_store: require\n"
		    "layout(early_fragment_tests) in;\nvoid main() { "
		    "gl_FragDepth = 0.125; gl_FragColor = vec4(1); }\n");
	slanted(-.9, .7);
	pass = equals_depth_buffer(&kb);
	glDisable(GL_DEPTH_TEST);
	slanted(-1, 1);
	pass = kb_expect_rect(&kb, 0, 31, 0, 1, 1, 1e-6, 31.5, .5, 31.5 / W,
			      1) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Without a depth test z is that which the test would use. */
static enum piglit_result
no_depth_test(void *data)
{
	struct kb kb = make((GLenum)(intptr_t)data);
	float *got;
	bool pass = true;

	glDisable(GL_DEPTH_TEST);
	slanted(-1, 1);
	got = kb_read(&kb, 0);
	for (int i = 0; i < W * W && pass; i++) {
		/* A plane equation in single precision. */
		pass = fabs(got[4 * i + 2] - (i % W + .5) / W) <= 1e-6;
		if (!pass)
			printf("(%d, %d): z %.9g\n", i % W, i / W,
			       got[4 * i + 2]);
	}
	free(got);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/**
 * z is not converted to the format of the depth buffer: fragments that are
 * closer than one step of it have different ones, with the depth test or not.
 */
static enum piglit_result
not_converted(void *data)
{
	struct kb kb = make((GLenum)(intptr_t)data);
	/* Less than a step of 16 bits over all, of 24 bits from pixel to pixel. */
	const double range = 1 / 33554432. * W / 2;
	bool pass = true;

	glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
	for (int test = 0; test < 2 && pass; test++) {
		float *got;

		if (test)
			glEnable(GL_DEPTH_TEST);
		else
			glDisable(GL_DEPTH_TEST);
		slanted(0, range);
		got = kb_read(&kb, 0);
		for (int i = 0; i < W * W && pass; i++) {
			const double z = (i % W + .5) / W * range;

			pass = fabs(got[4 * i + 2] - z) <= range / W / 16;
			if (!pass)
				printf("(%d, %d): z %.9g, expected %.9g\n",
				       i % W, i / W, got[4 * i + 2], z);
		}
		free(got);
	}
	glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("x-and-y", x_and_y, NULL),
	KB_SUBTEST("upper-left-and-integer", upper_left_and_integer, NULL),
	KB_SUBTEST("perspective", perspective, NULL),
	KB_SUBTEST("interpolated", interpolated, NULL),
	KB_SUBTEST("depth-range", depth_range, NULL),
	KB_SUBTEST("polygon-offset", polygon_offset, NULL),
	KB_SUBTEST("depth-clamp", depth_clamp, NULL),
	KB_SUBTEST("written-depth", written_depth, GL_DEPTH_COMPONENT32F),
	KB_SUBTEST("written-depth-without-buffer", written_depth, NULL),
	KB_SUBTEST("early-tests", early_tests, NULL),
	KB_SUBTEST("no-depth-buffer", no_depth_test, NULL),
	KB_SUBTEST("no-depth-test-32f", no_depth_test, GL_DEPTH_COMPONENT32F),
	KB_SUBTEST("no-depth-test-24", no_depth_test, GL_DEPTH_COMPONENT24),
	KB_SUBTEST("no-depth-test-16", no_depth_test, GL_DEPTH_COMPONENT16),
	KB_SUBTEST("not-converted-24", not_converted, GL_DEPTH_COMPONENT24),
	KB_SUBTEST("not-converted-16", not_converted, GL_DEPTH_COMPONENT16),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
