/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-msaa.c
 * With four samples a pixel the program runs for each covered sample that has
 * passed the tests, with the sample's depth and the sample's entries, while
 * the fragment shader runs once for the pixel.
 */

#include "kbuffer-common.h"

#define W KB_MS_SIZE

/** A slanted edge through the pixels: a triangle that leaves half free. */
static void
triangle(float z0, float z1)
{
	glBegin(GL_TRIANGLES);
	glVertex3f(-1, -1, z0);
	glVertex3f(1, -.83, z1);
	glVertex3f(-.71, 1, z0);
	glEnd();
}

/**
 * Coverage: where the plain draw of a constant covers a sample, the program
 * has run once, and nowhere else.
 */
static enum piglit_result
per_covered_sample(void *data)
{
	struct kb_ms ms = kb_ms_create(2, (int)(intptr_t)data);
	float *plain, *counted;
	int partial = 0;
	bool pass = true;

	kb_fragment_values((const float[2][4]) { { 0 }, { 1, 1, 1, 1 } }, 2);
	triangle(0, 0);
	plain = kb_ms_read(&ms, ms.tex[1], 0);
	kb_program("ADD result.kbuffer[0], kbuffer[0], 1;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	triangle(0, 0);
	triangle(0, 0);
	counted = kb_ms_read(&ms, ms.tex[0], 0);
	for (int i = 0; i < W * W * KB_SAMPLES && pass; i++) {
		pass = counted[4 * i] == 2 * plain[4 * i];
		if (!pass)
			printf("pixel %d, sample %d: covered %g, counted %g\n",
			       i % (W * W), i / (W * W), plain[4 * i],
			       counted[4 * i]);
		partial += plain[4 * i] != plain[4 * (i % (W * W))];
	}
	if (!partial) {
		printf("no pixel is partly covered\n");
		pass = false;
	}
	free(plain);
	free(counted);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Samples of pixels outside of the scissor box are not covered. */
static enum piglit_result
scissor(void *data)
{
	static const int boxes[][4] = {
		{ 5, 3, 9, 8 }, { 1, 1, 30, 30 }, { 8, 8, 8, 8 },
		{ 13, 0, 1, W }, { 0, 17, W, 2 },
	};
	const GLenum mode = *(const GLenum *)data;
	bool pass = true;

	kb_fragment_value(1, 1, 1, 1);
	kb_program("ADD result.kbuffer[0], kbuffer[0], fragment.color;");
	glPointSize(60);
	glLineWidth(50);
	for (int i = 0; i < ARRAY_SIZE(boxes) && pass; i++) {
		const int *box = boxes[i];
		struct kb_ms ms = kb_ms_create(1, 0);
		float *got;

		glEnable(GL_SCISSOR_TEST);
		glScissor(box[0], box[1], box[2], box[3]);
		glEnable(GL_KBUFFER_PROGRAM_MESA);
		glBegin(mode);
		if (mode == GL_POINTS) {
			glVertex2f(0, 0);
		} else if (mode == GL_LINES) {
			glVertex2f(-2, 0);
			glVertex2f(2, 0);
		} else {
			glVertex2f(-1, -1);
			glVertex2f(4, -1);
			glVertex2f(-1, 4);
		}
		glEnd();
		glDisable(GL_SCISSOR_TEST);
		glDisable(GL_KBUFFER_PROGRAM_MESA);
		got = kb_ms_read(&ms, ms.tex[0], 0);
		for (int j = 0; j < W * W * KB_SAMPLES && pass; j++) {
			const int x = j % W, y = j / W % W;
			const bool inside = x >= box[0] && y >= box[1] &&
				x < box[0] + box[2] && y < box[1] + box[3];

			pass = got[4 * j] == inside;
			if (!pass)
				printf("box %d, %d, %d x %d: pixel (%d, %d), "
				       "sample %d: %g\n", box[0], box[1],
				       box[2], box[3], x, y, j / (W * W),
				       got[4 * j]);
		}
		free(got);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** fragment.position.z is what the depth buffer gets for the sample. */
static enum piglit_result
depth_of_sample(void *data)
{
	struct kb_ms ms = kb_ms_create(1, 0);
	float *z, *depth;
	bool pass = true, differs = false;

	kb_program("MOV result.kbuffer[0], fragment.position;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	glEnable(GL_DEPTH_TEST);
	if (data) {
		glEnable(GL_POLYGON_OFFSET_FILL);
		glPolygonOffset(1, 0);
	}
	triangle(-.9, .8);
	z = kb_ms_read(&ms, ms.tex[0], 0);
	depth = kb_ms_read(&ms, ms.depth, 0);
	for (int i = 0; i < W * W * KB_SAMPLES && pass; i++) {
		const int pixel = i % (W * W);

		/* Where nothing was drawn: 0 and 1. */
		if (z[4 * i] == 0 && depth[4 * i] == 1)
			continue;
		pass = z[4 * i + 2] == depth[4 * i] &&
			z[4 * i] == pixel % W + .5f &&
			z[4 * i + 1] == pixel / W + .5f;
		if (!pass)
			printf("pixel %d, sample %d: position %g %g %.9g, "
			       "depth %.9g\n", pixel, i / (W * W), z[4 * i],
			       z[4 * i + 1], z[4 * i + 2], depth[4 * i]);
		differs |= z[4 * i + 2] != z[4 * pixel + 2];
	}
	if (!differs) {
		printf("all samples have the same depth\n");
		pass = false;
	}
	free(z);
	free(depth);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Two crossing planes: each sample passes or fails by its own depth. */
static enum piglit_result
depth_test_of_sample(void *data)
{
	struct kb_ms ms = kb_ms_create(1, 0);
	float *got, *depth;
	bool pass = true;
	int mixed = 0;

	glEnable(GL_DEPTH_TEST);
	glDepthFunc(GL_LESS);
	kb_program("ADD result.kbuffer[0], kbuffer[0], fragment.color;\n");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_fragment_value(1, 0, 0, 0);
	kb_draw(&ms.kb);
	kb_fragment_value(0, 1, 0, 0);
	glBegin(GL_QUADS);
	glVertex3f(-1, -1, -.9);
	glVertex3f(1, -1, .8);
	glVertex3f(1, 1, .9);
	glVertex3f(-1, 1, -.8);
	glEnd();
	got = kb_ms_read(&ms, ms.tex[0], 0);
	depth = kb_ms_read(&ms, ms.depth, 0);
	for (int i = 0; i < W * W * KB_SAMPLES && pass; i++) {
		const float passed = depth[4 * i] < .5f;

		pass = got[4 * i] == 1 && got[4 * i + 1] == passed;
		if (!pass)
			printf("pixel %d, sample %d: %g %g, depth %g\n",
			       i % (W * W), i / (W * W), got[4 * i],
			       got[4 * i + 1], depth[4 * i]);
		mixed += passed != (depth[4 * (i % (W * W))] < .5f);
	}
	if (!mixed) {
		printf("the planes cross in no pixel\n");
		pass = false;
	}
	free(got);
	free(depth);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** The fragment shader runs once a pixel: counted by an atomic counter. */
static enum piglit_result
shader_once(void *data)
{
	static const char fs[] =
		"#version 420 compatibility\n"
		"layout(binding = 0, offset = 0) uniform atomic_uint n;\n"
		"layout(early_fragment_tests) in;\n"
		"out vec4 o;\n"
		"void main() { atomicCounterIncrement(n); o = vec4(1); }\n";
	struct kb_ms ms = kb_ms_create(1, 0);
	const GLuint zero = 0;
	GLuint buffer, counts[2];
	float *got;
	bool pass = true;

	piglit_require_extension("GL_ARB_shader_atomic_counters");
	glGenBuffers(1, &buffer);
	glBindBuffer(GL_ATOMIC_COUNTER_BUFFER, buffer);
	glBufferData(GL_ATOMIC_COUNTER_BUFFER, 4, NULL, GL_DYNAMIC_READ);
	glBindBufferBase(GL_ATOMIC_COUNTER_BUFFER, 0, buffer);
	kb_program("ADD result.kbuffer[0], kbuffer[0], fragment.color;");
	kb_use_glsl("#version 130\nvoid main() { gl_Position = gl_Vertex; }\n",
		    NULL, fs);
	for (int i = 0; i < 2; i++) {
		glBufferSubData(GL_ATOMIC_COUNTER_BUFFER, 0, 4, &zero);
		if (i)
			glEnable(GL_KBUFFER_PROGRAM_MESA);
		kb_draw(&ms.kb);
		glFinish();
		glGetBufferSubData(GL_ATOMIC_COUNTER_BUFFER, 0, 4, &counts[i]);
	}
	/* Both triangles of the quad run in the pixels of the diagonal. */
	if (counts[0] != counts[1] || counts[1] < W * W ||
	    counts[1] > W * W + 2 * W) {
		printf("the shader ran %u times without and %u times with the "
		       "program\n", counts[0], counts[1]);
		pass = false;
	}
	got = kb_ms_read(&ms, ms.tex[0], 0);
	for (int i = 0; i < W * W * KB_SAMPLES; i++)
		pass = got[4 * i] == 2 && pass;
	free(got);
	glDeleteBuffers(1, &buffer);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/**
 * A fragment shader that runs for each sample gives each its own color; the
 * program runs no more often, and its position stays that of the pixel.
 */
static enum piglit_result
sample_shading(void *data)
{
	static const char by_sample_id[] =
		"#version 150 compatibility\n"
		"#extension GL_ARB_sample_shading: require\n"
		"out vec4 o;\n"
		"void main() { o = vec4(gl_SampleID + 1, 0, 0, 0); }\n";
	/* One that looks at what differs only if it runs for each sample. */
	static const char by_position[] =
		"#version 150 compatibility\nout vec4 o;\n"
		"void main() { o = vec4(fract(gl_FragCoord.xy), 0, 0); }\n";
	struct kb_ms ms = kb_ms_create(2, 0);
	bool pass = true;

	piglit_require_extension("GL_ARB_sample_shading");
	kb_program("ADD result.kbuffer[0], kbuffer[0], fragment.color;\n"
		   "MOV result.kbuffer[1], fragment.position;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	for (int min = 0; min < 2 && pass; min++) {
		float *got, *position;
		int different = 0;

		glClear(GL_COLOR_BUFFER_BIT);
		kb_use_glsl("#version 130\n"
			    "void main() { gl_Position = gl_Vertex; }\n",
			    NULL, min ? by_position : by_sample_id);
		if (min) {
			glEnable(GL_SAMPLE_SHADING);
			glMinSampleShading(1);
		}
		kb_draw(&ms.kb);
		kb_draw(&ms.kb);
		/* Mesa's PopAttrib does not. */
		glDisable(GL_SAMPLE_SHADING);
		got = kb_ms_read(&ms, ms.tex[0], 0);
		position = kb_ms_read(&ms, ms.tex[1], 0);
		for (int i = 0; i < W * W * KB_SAMPLES && pass; i++) {
			const int pixel = i % (W * W), s = i / (W * W);

			pass = position[4 * i] == pixel % W + .5f &&
				position[4 * i + 1] == pixel / W + .5f &&
				(min || got[4 * i] == 2 * (s + 1));
			if (!pass)
				printf("pixel %d, sample %d: color %g, "
				       "position %g %g\n", pixel, s,
				       got[4 * i], position[4 * i],
				       position[4 * i + 1]);
			different += got[4 * i] != got[4 * pixel];
		}
		if (!different) {
			printf("all samples have the same color\n");
			pass = false;
		}
		free(got);
		free(position);
	}
	glMinSampleShading(0);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** KIL and glSampleMaski work by sample; alpha to coverage is before. */
static enum piglit_result
masks(void *data)
{
	struct kb_ms ms = kb_ms_create(1, 0);
	float *got;
	bool pass = true;

	kb_program("TEMP t;\nSUB t, 2, kbuffer[0];\nKIL t;\n"
		   "ADD result.kbuffer[0], kbuffer[0], 1;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	glEnable(GL_SAMPLE_MASK);
	for (int i = 0; i < 6; i++) {
		/* Sample s gets i's whose bit is set: 2, 4, 6, 0. */
		glSampleMaski(0, (i < 2) | (i < 4) << 1 | 1 << 2);
		kb_draw(&ms.kb);
	}
	/* Mesa's PopAttrib does not. */
	glDisable(GL_SAMPLE_MASK);
	got = kb_ms_read(&ms, ms.tex[0], 0);
	for (int i = 0; i < W * W * KB_SAMPLES && pass; i++) {
		static const float wanted[KB_SAMPLES] = { 2, 3, 3, 0 };

		pass = got[4 * i] == wanted[i / (W * W)];
		if (!pass)
			printf("sample %d: %g\n", i / (W * W), got[4 * i]);
	}
	free(got);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Alpha decides over coverage and becomes one before the program runs. */
static enum piglit_result
alpha_to_coverage(void *data)
{
	struct kb_ms ms = kb_ms_create(2, 0);
	float *plain, *got;
	int covered = 0;
	bool pass = true;

	glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
	kb_fragment_values((const float[2][4]) { { 1, 2, 3, .5 },
						 { 1, 1, 1, 1 } }, 2);
	kb_draw(&ms.kb);
	plain = kb_ms_read(&ms, ms.tex[1], 0);
	glClear(GL_COLOR_BUFFER_BIT);
	glEnable(GL_SAMPLE_ALPHA_TO_ONE);
	kb_program("MOV result.kbuffer[0], fragment.color;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&ms.kb);
	got = kb_ms_read(&ms, ms.tex[0], 0);
	for (int i = 0; i < W * W * KB_SAMPLES && pass; i++) {
		pass = got[4 * i] == plain[4 * i] &&
			got[4 * i + 3] == plain[4 * i];
		covered += plain[4 * i] == 1;
		if (!pass)
			printf("sample %d: covered %g, got %g, alpha %g\n",
			       i / (W * W), plain[4 * i], got[4 * i],
			       got[4 * i + 3]);
	}
	if (covered == 0 || covered == W * W * KB_SAMPLES) {
		printf("%d samples are covered\n", covered);
		pass = false;
	}
	free(plain);
	free(got);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static const GLenum points = GL_POINTS, lines = GL_LINES,
	triangles = GL_TRIANGLES;

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("per-covered-sample", per_covered_sample, 0),
	KB_SUBTEST("per-covered-sample-in-layers", per_covered_sample, 2),
	KB_SUBTEST("scissored-triangles", scissor, &triangles),
	KB_SUBTEST("scissored-lines", scissor, &lines),
	KB_SUBTEST("scissored-points", scissor, &points),
	KB_SUBTEST("depth-of-sample", depth_of_sample, NULL),
	KB_SUBTEST("depth-of-sample-with-offset", depth_of_sample, "offset"),
	KB_SUBTEST("depth-test-of-sample", depth_test_of_sample, NULL),
	KB_SUBTEST("shader-once", shader_once, NULL),
	KB_SUBTEST("sample-shading", sample_shading, NULL),
	KB_SUBTEST("masks", masks, NULL),
	KB_SUBTEST("alpha-to-coverage", alpha_to_coverage, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
