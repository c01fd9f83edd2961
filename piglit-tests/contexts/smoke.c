/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "smoke.h"

#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/mesa_kbuffer.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define FUNCTIONS(F) \
	F(const GLubyte *, GetString, (GLenum)) \
	F(const GLubyte *, GetStringi, (GLenum, GLuint)) \
	F(GLenum, GetError, (void)) \
	F(void, GetIntegerv, (GLenum, GLint *)) \
	F(void, Finish, (void)) \
	F(void, Enable, (GLenum)) \
	F(void, Disable, (GLenum)) \
	F(void, Viewport, (GLint, GLint, GLsizei, GLsizei)) \
	F(void, ClearColor, (GLfloat, GLfloat, GLfloat, GLfloat)) \
	F(void, Clear, (GLbitfield)) \
	F(void, Color4f, (GLfloat, GLfloat, GLfloat, GLfloat)) \
	F(void, Rectf, (GLfloat, GLfloat, GLfloat, GLfloat)) \
	F(void, ReadBuffer, (GLenum)) \
	F(void, ReadPixels, (GLint, GLint, GLsizei, GLsizei, GLenum, GLenum, \
			     void *)) \
	F(void, GenProgramsARB, (GLsizei, GLuint *)) \
	F(void, BindProgramARB, (GLenum, GLuint)) \
	F(void, ProgramStringARB, (GLenum, GLenum, GLsizei, const void *)) \
	F(void, GenTextures, (GLsizei, GLuint *)) \
	F(void, BindTexture, (GLenum, GLuint)) \
	F(void, TexImage2D, (GLenum, GLint, GLint, GLsizei, GLsizei, GLint, \
			     GLenum, GLenum, const void *)) \
	F(void, TexParameteri, (GLenum, GLenum, GLint)) \
	F(void, GenFramebuffers, (GLsizei, GLuint *)) \
	F(void, BindFramebuffer, (GLenum, GLuint)) \
	F(void, FramebufferTexture2D, (GLenum, GLenum, GLenum, GLuint, GLint)) \
	F(void, DrawBuffers, (GLsizei, const GLenum *))

static struct {
#define MEMBER(ret, name, args) ret (*name) args;
	FUNCTIONS(MEMBER)
} gl;

static bool
load(smoke_proc (*get)(const char *))
{
	bool all = true;
#define LOAD(ret, name, args) \
	gl.name = (ret (*) args)get("gl" #name); \
	if (!gl.name) { \
		printf("no gl" #name "\n"); \
		all = false; \
	}
	FUNCTIONS(LOAD)
	return all;
}

static bool
advertised(void)
{
	static const char name[] = "GL_MESA_kbuffer_program";
	const char *all = (const char *)gl.GetString(GL_EXTENSIONS);
	GLint n = 0;

	if (!all || !strstr(all, name))
		return false;
	gl.GetIntegerv(GL_NUM_EXTENSIONS, &n);
	for (GLint i = 0; i < n; i++) {
		if (!strcmp((const char *)gl.GetStringi(GL_EXTENSIONS, i),
			    name))
			return true;
	}
	return false;
}

static bool
use_program(const char *string)
{
	GLuint name;

	gl.GenProgramsARB(1, &name);
	gl.BindProgramARB(GL_KBUFFER_PROGRAM_MESA, name);
	gl.ProgramStringARB(GL_KBUFFER_PROGRAM_MESA,
			    GL_PROGRAM_FORMAT_ASCII_ARB, strlen(string),
			    string);
	if (gl.GetError() == GL_NO_ERROR)
		return true;
	printf("refused: %s\n%s", gl.GetString(GL_PROGRAM_ERROR_STRING_ARB),
	       string);
	return false;
}

/** Red counts three draws, green is y with the origin at the bottom. */
static bool
default_framebuffer(void)
{
	float got[SMOKE_SIZE][SMOKE_SIZE][4];

	gl.ClearColor(0, 0, 0, 1);
	gl.Clear(GL_COLOR_BUFFER_BIT);
	if (!use_program("!!ARBfp1.0\nOPTION MESA_kbuffer_program;\n"
			 "ADD result.kbuffer[0].x, kbuffer[0], "
			 "fragment.color;\n"
			 "MUL result.kbuffer[0].y, fragment.position, "
			 "0.03125;\nEND\n"))
		return false;
	gl.Enable(GL_KBUFFER_PROGRAM_MESA);
	gl.Color4f(.2f, 1, 1, 1);
	for (int i = 0; i < 3; i++)
		gl.Rectf(-1, -1, 1, 1);
	gl.ReadPixels(0, 0, SMOKE_SIZE, SMOKE_SIZE, GL_RGBA, GL_FLOAT, got);
	gl.Disable(GL_KBUFFER_PROGRAM_MESA);
	for (int y = 0; y < SMOKE_SIZE; y++) {
		for (int x = 0; x < SMOKE_SIZE; x++) {
			const float *p = got[y][x];

			/* .6 is exact in 8 bits, and 1/852 off after three
			 * roundings in 10; y is the nearest of 8 bits. */
			if (fabsf(p[0] - .6f) < 1 / 850.0f && p[2] == 0 &&
			    fabsf(p[1] - (y + .5f) / SMOKE_SIZE) <
			    .51f / 255)
				continue;
			printf("default framebuffer at (%d, %d): %g %g %g %g\n",
			       x, y, p[0], p[1], p[2], p[3]);
			return false;
		}
	}
	return true;
}

/** Each draw shifts 8 entries by one and puts its color in front. */
static bool
framebuffer_object(void)
{
	float got[SMOKE_SIZE][SMOKE_SIZE][4];
	char program[1024] = "!!ARBfp1.0\nOPTION MESA_kbuffer_program;\n"
		"MUL result.kbuffer[0], fragment.color, 100;\n";
	GLenum buffers[8];
	GLuint fbo, tex[8];

	gl.GenFramebuffers(1, &fbo);
	gl.BindFramebuffer(GL_FRAMEBUFFER, fbo);
	gl.GenTextures(8, tex);
	for (int i = 0; i < 8; i++) {
		char *end = program + strlen(program);

		gl.BindTexture(GL_TEXTURE_2D, tex[i]);
		gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, SMOKE_SIZE,
			      SMOKE_SIZE, 0, GL_RGBA, GL_FLOAT, NULL);
		buffers[i] = GL_COLOR_ATTACHMENT0 + i;
		gl.FramebufferTexture2D(GL_FRAMEBUFFER, buffers[i],
					GL_TEXTURE_2D, tex[i], 0);
		if (i)
			sprintf(end, "MOV result.kbuffer[%d], kbuffer[%d];\n",
				i, i - 1);
	}
	strcat(program, "END\n");
	gl.DrawBuffers(8, buffers);
	gl.Clear(GL_COLOR_BUFFER_BIT);
	if (!use_program(program))
		return false;
	gl.Enable(GL_KBUFFER_PROGRAM_MESA);
	for (int i = 1; i <= 10; i++) {
		gl.Color4f(i / 16.0f, 0, 0, 1);
		gl.Rectf(-1, -1, 1, 1);
	}
	gl.Disable(GL_KBUFFER_PROGRAM_MESA);
	for (int i = 0; i < 8; i++) {
		const float wanted = 100 * (10 - i) / 16.0f;

		gl.ReadBuffer(buffers[i]);
		gl.ReadPixels(0, 0, SMOKE_SIZE, SMOKE_SIZE, GL_RGBA, GL_FLOAT,
			      got);
		for (int p = 0; p < SMOKE_SIZE * SMOKE_SIZE; p++) {
			if (fabsf(got[p / SMOKE_SIZE][p % SMOKE_SIZE][0] - wanted) < 1e-4f)
				continue;
			printf("entry %d: %g, expected %g\n", i, got[p / SMOKE_SIZE][p % SMOKE_SIZE][0],
			       wanted);
			return false;
		}
	}
	return true;
}

int
smoke(smoke_proc (*get_proc_address)(const char *), const char *driver)
{
	const char *renderer;
	GLint entries = 0;

	if (!load(get_proc_address))
		return 1;
	renderer = (const char *)gl.GetString(GL_RENDERER);
	if (!renderer || strncmp(renderer, driver, strlen(driver))) {
		printf("asked for %s, got %s\n", driver, renderer);
		return 1;
	}
	if (!advertised()) {
		printf("GL_MESA_kbuffer_program is not advertised\n");
		return 1;
	}
	gl.GetIntegerv(GL_MAX_KBUFFER_ENTRIES_MESA, &entries);
	if (entries != 64) {
		printf("%d entries\n", entries);
		return 1;
	}
	gl.Viewport(0, 0, SMOKE_SIZE, SMOKE_SIZE);
	if (!default_framebuffer() || !framebuffer_object())
		return 1;
	gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
	gl.Finish();
	if (gl.GetError() != GL_NO_ERROR) {
		printf("a GL error was left\n");
		return 1;
	}
	return 0;
}
