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

#define W 32
#define SAMPLES 4

/** A multisample framebuffer and a plain one to look at its samples. */
struct ms {
	struct kb kb;           /**< RGBA32F, four samples, bound */
	GLuint tex[2], depth;
};

static struct ms
make(int attachments, int layers)
{
	struct ms ms = { .kb = kb_create(GL_RGBA32F, 0, 0, W, W) };
	const GLenum target = layers ? GL_TEXTURE_2D_MULTISAMPLE_ARRAY :
		GL_TEXTURE_2D_MULTISAMPLE;
	GLenum buffers[2];
	GLint max_samples = 0;

	glGetIntegerv(GL_MAX_SAMPLES, &max_samples);
	if (max_samples < SAMPLES) {
		printf("there are no %d samples here\n", SAMPLES);
		piglit_report_result(PIGLIT_SKIP);
	}
	glGenTextures(2, ms.tex);
	glGenTextures(1, &ms.depth);
	for (int i = 0; i < attachments; i++) {
		glBindTexture(target, ms.tex[i]);
		if (layers)
			glTexImage3DMultisample(target, SAMPLES, GL_RGBA32F,
						W, W, layers, GL_TRUE);
		else
			glTexImage2DMultisample(target, SAMPLES, GL_RGBA32F,
						W, W, GL_TRUE);
		buffers[i] = GL_COLOR_ATTACHMENT0 + i;
		glFramebufferTexture(GL_FRAMEBUFFER, buffers[i], ms.tex[i], 0);
	}
	glBindTexture(target, ms.depth);
	if (layers)
		glTexImage3DMultisample(target, SAMPLES, GL_DEPTH_COMPONENT32F,
					W, W, layers, GL_TRUE);
	else
		glTexImage2DMultisample(target, SAMPLES, GL_DEPTH_COMPONENT32F,
					W, W, GL_TRUE);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, ms.depth, 0);
	glDrawBuffers(attachments, buffers);
	if (glCheckFramebufferStatus(GL_FRAMEBUFFER) !=
	    GL_FRAMEBUFFER_COMPLETE) {
		printf("incomplete multisample framebuffer\n");
		piglit_report_result(PIGLIT_FAIL);
	}
	ms.kb.attachments = attachments;
	ms.kb.layers = layers;
	glClearColor(0, 0, 0, 0);
	glClearDepth(1);
	glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
	return ms;
}

static void
destroy(struct ms *ms)
{
	glDeleteTextures(2, ms->tex);
	glDeleteTextures(1, &ms->depth);
}

/** All samples of a texture (or of a layer): SAMPLES W x W images. */
static float *
read_samples(const struct ms *ms, GLuint tex, int layer)
{
	static const char fs[] =
		"#version 150 compatibility\n"
		"uniform sampler2DMS t2;\nuniform sampler2DMSArray t3;\n"
		"uniform int layer, s;\nout vec4 o;\n"
		"void main() { ivec2 p = ivec2(gl_FragCoord.xy);\n"
		"  o = layer < 0 ? texelFetch(t2, p, s) :\n"
		"      texelFetch(t3, ivec3(p, layer), s); }\n";
	struct kb out = kb_create(GL_RGBA32F, 1, 0, W, W);
	float *got = malloc(SAMPLES * W * W * 16);
	GLuint program;

	glPushAttrib(GL_ENABLE_BIT | GL_CURRENT_BIT);
	glDisable(GL_KBUFFER_PROGRAM_MESA);
	glDisable(GL_DEPTH_TEST);
	glDisable(GL_FRAGMENT_PROGRAM_ARB);
	program = kb_use_glsl("#version 150 compatibility\n"
			      "void main() { gl_Position = gl_Vertex; }\n",
			      NULL, fs);
	glUniform1i(glGetUniformLocation(program, "t2"), 0);
	glUniform1i(glGetUniformLocation(program, "t3"), 1);
	glUniform1i(glGetUniformLocation(program, "layer"),
		    ms->kb.layers ? layer : -1);
	glActiveTexture(ms->kb.layers ? GL_TEXTURE1 : GL_TEXTURE0);
	glBindTexture(ms->kb.layers ? GL_TEXTURE_2D_MULTISAMPLE_ARRAY :
		      GL_TEXTURE_2D_MULTISAMPLE, tex);
	for (int s = 0; s < SAMPLES; s++) {
		glUniform1i(glGetUniformLocation(program, "s"), s);
		kb_draw(&out);
		glReadPixels(0, 0, W, W, GL_RGBA, GL_FLOAT,
			     got + s * W * W * 4);
	}
	glActiveTexture(GL_TEXTURE0);
	glUseProgram(0);
	glPopAttrib();
	glBindFramebuffer(GL_FRAMEBUFFER, ms->kb.fbo);
	return got;
}

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
	struct ms ms = make(2, (int)(intptr_t)data);
	float *plain, *counted;
	int partial = 0;
	bool pass = true;

	kb_fragment_values((const float[2][4]) { { 0 }, { 1, 1, 1, 1 } }, 2);
	triangle(0, 0);
	plain = read_samples(&ms, ms.tex[1], 0);
	kb_program("ADD result.kbuffer[0], kbuffer[0], 1;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	triangle(0, 0);
	triangle(0, 0);
	counted = read_samples(&ms, ms.tex[0], 0);
	for (int i = 0; i < W * W * SAMPLES && pass; i++) {
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
	destroy(&ms);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** fragment.position.z is what the depth buffer gets for the sample. */
static enum piglit_result
depth_of_sample(void *data)
{
	struct ms ms = make(1, 0);
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
	z = read_samples(&ms, ms.tex[0], 0);
	depth = read_samples(&ms, ms.depth, 0);
	for (int i = 0; i < W * W * SAMPLES && pass; i++) {
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
	destroy(&ms);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Two crossing planes: each sample passes or fails by its own depth. */
static enum piglit_result
depth_test_of_sample(void *data)
{
	struct ms ms = make(1, 0);
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
	got = read_samples(&ms, ms.tex[0], 0);
	depth = read_samples(&ms, ms.depth, 0);
	for (int i = 0; i < W * W * SAMPLES && pass; i++) {
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
	destroy(&ms);
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
	struct ms ms = make(1, 0);
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
	got = read_samples(&ms, ms.tex[0], 0);
	for (int i = 0; i < W * W * SAMPLES; i++)
		pass = got[4 * i] == 2 && pass;
	free(got);
	glDeleteBuffers(1, &buffer);
	destroy(&ms);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** KIL and glSampleMaski work by sample; alpha to coverage is before. */
static enum piglit_result
masks(void *data)
{
	struct ms ms = make(1, 0);
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
	got = read_samples(&ms, ms.tex[0], 0);
	for (int i = 0; i < W * W * SAMPLES && pass; i++) {
		static const float wanted[SAMPLES] = { 2, 3, 3, 0 };

		pass = got[4 * i] == wanted[i / (W * W)];
		if (!pass)
			printf("sample %d: %g\n", i / (W * W), got[4 * i]);
	}
	free(got);
	destroy(&ms);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("per-covered-sample", per_covered_sample, 0),
	KB_SUBTEST("per-covered-sample-in-layers", per_covered_sample, 2),
	KB_SUBTEST("depth-of-sample", depth_of_sample, NULL),
	KB_SUBTEST("depth-of-sample-with-offset", depth_of_sample, "offset"),
	KB_SUBTEST("depth-test-of-sample", depth_test_of_sample, NULL),
	KB_SUBTEST("shader-once", shader_once, NULL),
	KB_SUBTEST("masks", masks, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
