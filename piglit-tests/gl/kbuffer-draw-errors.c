/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-draw-errors.c
 * Each state in which drawing with GL_KBUFFER_PROGRAM_MESA enabled is an
 * error, by each kind of draw command: the right error, the framebuffer
 * untouched, and drawing works again when the state is repaired or the stage
 * is disabled.
 */

#include "kbuffer-common.h"

/** All draw commands give the error and leave 1, 2, 3, 4 in entry 0. */
static bool
check_refused(const struct kb *kb)
{
	const GLenum error = GL_INVALID_OPERATION;
	bool pass = true;

	glEnable(GL_KBUFFER_PROGRAM_MESA);
	for (int i = 0; i < ARRAY_SIZE(kb_commands); i++) {
		kb_commands[i].draw();
		if (!piglit_check_gl_error(error)) {
			printf("by %s\n", kb_commands[i].name);
			pass = false;
		}
		if (kb && !kb_expect(kb, 0, 0, 1, 2, 3, 4)) {
			printf("%s has drawn\n", kb_commands[i].name);
			kb_fill(kb, 0, 1, 2, 3, 4);
			pass = false;
		}
	}
	return pass;
}

/** With the stage disabled the same state draws. */
static bool
check_disabled_draws(const struct kb *kb)
{
	glDisable(GL_KBUFFER_PROGRAM_MESA);
	glColor4f(1, 0, 1, 0);
	glRectf(-1, -1, 1, 1);
	return kb_expect(kb, 0, 0, 1, 0, 1, 0);
}

static struct kb
make(void)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, KB_COMMAND_SIZE,
				 KB_COMMAND_SIZE);

	kb_fill(&kb, 0, 1, 2, 3, 4);
	return kb;
}

static enum piglit_result
no_program(void *data)
{
	struct kb kb = make();

	return check_refused(&kb) &&
		check_disabled_draws(&kb) ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** RasterPos makes no fragments: no error. */
static enum piglit_result
raster_pos(void *data)
{
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	glRasterPos2f(0, 0);
	glWindowPos2i(3, 3);
	return piglit_check_gl_error(GL_NO_ERROR) ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
empty_program(void *data)
{
	struct kb kb = make();
	GLuint name;
	bool pass;

	glGenProgramsARB(1, &name);
	glBindProgramARB(GL_KBUFFER_PROGRAM_MESA, name);
	pass = check_refused(&kb) &&
		check_disabled_draws(&kb);
	glDeleteProgramsARB(1, &name);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
failed_program(void *data)
{
	static const char bad[] = "!!ARBfp1.0\nOPTION MESA_kbuffer_program;\n"
		"MOV result.color, 1;\nEND\n";
	struct kb kb = make();
	GLuint name;
	bool pass;

	glGenProgramsARB(1, &name);
	glBindProgramARB(GL_KBUFFER_PROGRAM_MESA, name);
	pass = kb_load(GL_KBUFFER_PROGRAM_MESA, bad, strlen(bad)) ==
		GL_INVALID_OPERATION;
	pass = check_refused(&kb) &&
		check_disabled_draws(&kb) && pass;
	glDeleteProgramsARB(1, &name);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
missing_entry(void *data)
{
	struct kb kb = make();
	bool pass;

	glColor4f(0, 0, 0, 0);
	kb_program((const char *)data);
	pass = check_refused(&kb);
	kb_program("MOV result.kbuffer[0], 7;");
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 7, 7, 7, 7) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Two attachments of which the second is no draw buffer: entry 1 is gone. */
static enum piglit_result
draw_buffers(void *data)
{
	static const GLenum none[2] = { GL_COLOR_ATTACHMENT0, GL_NONE };
	static const GLenum all[2] = { GL_COLOR_ATTACHMENT0,
				       GL_COLOR_ATTACHMENT1 };
	struct kb kb = kb_create(GL_RGBA32F, 2, 0, 8, 8);
	bool pass;

	kb_fill(&kb, 0, 1, 2, 3, 4);
	kb_program("MOV result.kbuffer[0], kbuffer[1];");
	glDrawBuffers(1, all);
	pass = check_refused(&kb);
	glDrawBuffers(2, none);
	pass = check_refused(&kb) && pass;
	glDrawBuffers(2, all);
	kb_fill(&kb, 1, 5, 5, 5, 5);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 5, 5, 5, 5) && pass;

	/* Entry 0 itself may not be missing either. */
	kb_fill(&kb, 0, 1, 2, 3, 4);
	glDrawBuffers(2, (GLenum[]) { GL_NONE, GL_COLOR_ATTACHMENT1 });
	pass = check_refused(&kb) && pass;
	/* And a hole that the program does not name does no harm. */
	kb_program("MOV result.kbuffer[1], 6;");
	kb_draw(&kb);
	pass = kb_expect(&kb, 1, 0, 6, 6, 6, 6) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
no_draw_buffer(void *data)
{
	struct kb kb = make();
	bool pass;

	kb_program("MOV result.kbuffer[0], 7;");
	glDrawBuffer(GL_NONE);
	pass = check_refused(&kb);
	/* Nor of a program that names no entry. */
	kb_program("TEMP t;\nMOV t, fragment.color;");
	pass = check_refused(&kb) && pass;
	glDrawBuffer(GL_COLOR_ATTACHMENT0);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 1, 2, 3, 4) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** A framebuffer without any attachment, made complete by its parameters. */
static enum piglit_result
no_attachments(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 0, 0, 8, 8);

	piglit_require_extension("GL_ARB_framebuffer_no_attachments");
	glFramebufferParameteri(GL_FRAMEBUFFER,
				GL_FRAMEBUFFER_DEFAULT_WIDTH, 8);
	glFramebufferParameteri(GL_FRAMEBUFFER,
				GL_FRAMEBUFFER_DEFAULT_HEIGHT, 8);
	(void)kb;
	kb_program("TEMP t;\nMOV t, fragment.color;");
	return check_refused(NULL) ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

/** The same errors as without the stage (Mesa's DrawPixels has its own). */
static enum piglit_result
incomplete(void *data)
{
	struct kb kb = make();
	GLuint bad;
	bool pass = true;

	kb_program("MOV result.kbuffer[0], 7;");
	glGenRenderbuffers(1, &bad);
	glBindRenderbuffer(GL_RENDERBUFFER, bad);
	glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, 8, 8);
	/* A depth format at a color attachment. */
	glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1,
				  GL_RENDERBUFFER, bad);
	for (int i = 0; i < ARRAY_SIZE(kb_commands); i++) {
		GLenum error;

		glDisable(GL_KBUFFER_PROGRAM_MESA);
		kb_commands[i].draw();
		error = glGetError();
		glEnable(GL_KBUFFER_PROGRAM_MESA);
		kb_commands[i].draw();
		pass = error != GL_NO_ERROR && piglit_check_gl_error(error) &&
			pass;
	}
	pass = kb_expect(&kb, 0, 0, 1, 2, 3, 4) && pass;
	glDeleteRenderbuffers(1, &bad);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** With a shader that could draw to it. */
static enum piglit_result
integer(void *data)
{
	static const char vs[] = "#version 130\n"
		"void main() { gl_Position = gl_Vertex; }\n";
	static const char fs[] = "#version 130\n"
		"#extension GL_ARB_explicit_attrib_location: require\n"
		"layout(location = 0) out vec4 a;\n"
		"layout(location = 1) out %s b;\n"
		"void main() { a = vec4(1, 0, 1, 0); b = %s(5); }\n";
	const GLenum format = (GLenum)(intptr_t)data;
	const char *type = format == GL_RGBA32I ? "ivec4" : "uvec4";
	char source[sizeof(fs) + 10];
	struct kb kb = make();
	static const int fill[4] = { 9, 9, 9, 9 };
	int got[8 * 8 * 4];
	GLuint tex;
	bool pass;

	kb_program("MOV result.kbuffer[0], 7;");
	glGenTextures(1, &tex);
	glBindTexture(GL_TEXTURE_2D, tex);
	glTexImage2D(GL_TEXTURE_2D, 0, format, 8, 8, 0, GL_RGBA_INTEGER,
		     GL_INT, NULL);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, tex, 0);
	glDrawBuffers(2, (GLenum[]) { GL_COLOR_ATTACHMENT0,
				      GL_COLOR_ATTACHMENT1 });
	glClearBufferiv(GL_COLOR, 1, fill);
	/* The integer buffer is not named by the program, but is there. */
	sprintf(source, fs, type, type);
	kb_use_glsl(vs, NULL, source);
	pass = check_refused(&kb);
	glBindTexture(GL_TEXTURE_2D, tex);
	glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA_INTEGER, GL_INT, got);
	for (int i = 0; i < 8 * 8; i++)
		pass = got[4 * i] == 9 && pass;
	pass = check_disabled_draws(&kb) && pass;
	glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA_INTEGER, GL_INT, got);
	for (int i = 0; i < 8 * 8; i++)
		pass = got[4 * i] == 5 && pass;
	glUseProgram(0);
	glDrawBuffer(GL_COLOR_ATTACHMENT0);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 7, 7, 7, 7) && pass;
	glDeleteTextures(1, &tex);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("no-program", no_program, NULL),
	KB_SUBTEST("raster-pos", raster_pos, NULL),
	KB_SUBTEST("empty-program", empty_program, NULL),
	KB_SUBTEST("failed-program", failed_program, NULL),
	KB_SUBTEST("missing-entry-read", missing_entry,
		   "MOV result.kbuffer[0], kbuffer[1];"),
	KB_SUBTEST("missing-entry-written", missing_entry,
		   "MOV result.kbuffer[0], 0;\nMOV result.kbuffer[63], 1;"),
	KB_SUBTEST("draw-buffers", draw_buffers, NULL),
	KB_SUBTEST("no-draw-buffer", no_draw_buffer, NULL),
	KB_SUBTEST("no-attachments", no_attachments, NULL),
	KB_SUBTEST("incomplete-framebuffer", incomplete, NULL),
	KB_SUBTEST("signed-integer", integer, GL_RGBA32I),
	KB_SUBTEST("unsigned-integer", integer, GL_RGBA8UI),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
