/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-multisample.c
 * Multisample framebuffers, and a look at their samples.
 */

#include "kbuffer-common.h"

#define W KB_MS_SIZE

struct kb_ms
kb_ms_create(int attachments, int layers)
{
	struct kb_ms ms = { .kb = kb_create(GL_RGBA32F, 0, 0, W, W) };
	const GLenum target = layers ? GL_TEXTURE_2D_MULTISAMPLE_ARRAY :
		GL_TEXTURE_2D_MULTISAMPLE;
	GLenum buffers[2];
	GLint max_samples = 0;

	glGetIntegerv(GL_MAX_SAMPLES, &max_samples);
	if (max_samples < KB_SAMPLES) {
		printf("there are no %d samples here\n", KB_SAMPLES);
		piglit_report_result(PIGLIT_SKIP);
	}
	ms.depth = kb_new_texture();
	for (int i = 0; i < attachments; i++) {
		ms.tex[i] = kb_new_texture();
		glBindTexture(target, ms.tex[i]);
		if (layers)
			glTexImage3DMultisample(target, KB_SAMPLES, GL_RGBA32F,
						W, W, layers, GL_TRUE);
		else
			glTexImage2DMultisample(target, KB_SAMPLES, GL_RGBA32F,
						W, W, GL_TRUE);
		buffers[i] = GL_COLOR_ATTACHMENT0 + i;
		glFramebufferTexture(GL_FRAMEBUFFER, buffers[i], ms.tex[i], 0);
	}
	glBindTexture(target, ms.depth);
	if (layers)
		glTexImage3DMultisample(target, KB_SAMPLES, GL_DEPTH_COMPONENT32F,
					W, W, layers, GL_TRUE);
	else
		glTexImage2DMultisample(target, KB_SAMPLES, GL_DEPTH_COMPONENT32F,
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

float *
kb_ms_read(const struct kb_ms *ms, GLuint tex, int layer)
{
	static const char fs[] =
		"#version 150 compatibility\n"
		"uniform sampler2DMS t2;\nuniform sampler2DMSArray t3;\n"
		"uniform int layer, s;\nout vec4 o;\n"
		"void main() { ivec2 p = ivec2(gl_FragCoord.xy);\n"
		"  o = layer < 0 ? texelFetch(t2, p, s) :\n"
		"      texelFetch(t3, ivec3(p, layer), s); }\n";
	struct kb out = kb_create(GL_RGBA32F, 1, 0, W, W);
	float *got = malloc(KB_SAMPLES * W * W * 16);
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
	for (int s = 0; s < KB_SAMPLES; s++) {
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
