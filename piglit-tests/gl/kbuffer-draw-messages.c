/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-draw-messages.c
 * A draw that is an error with GL_KBUFFER_PROGRAM_MESA enabled says by
 * KHR_debug which rule it breaks, whatever kind of draw it is.
 */

#include "kbuffer-messages.h"

static struct kb
make(int attachments)
{
	const struct kb kb = kb_create(GL_RGBA32F, attachments, 0,
				       KB_COMMAND_SIZE, KB_COMMAND_SIZE);

	glEnable(GL_KBUFFER_PROGRAM_MESA);
	return kb;
}

/** Of all draws, in the state as it is; \p program is 0: not named. */
static enum piglit_result
check(const char *format, GLuint program)
{
	char text[256];
	bool pass;

	snprintf(text, sizeof(text), format, program);
	kb_collect_messages();
	pass = kb_expect_message_of_draws(text);
	kb_stop_messages();
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
no_program(void *data)
{
	make(1);
	return check("(k-buffer program 0 is not valid)", 0);
}

static enum piglit_result
failed_program(void *data)
{
	const GLuint name = 777;
	enum piglit_result result;

	make(1);
	glBindProgramARB(GL_KBUFFER_PROGRAM_MESA, name);
	if (kb_load(GL_KBUFFER_PROGRAM_MESA, "!!", 2) != GL_INVALID_OPERATION)
		return PIGLIT_FAIL;
	result = check("(k-buffer program %u is not valid)", name);
	glDeleteProgramsARB(1, &name);
	return result;
}

/** The first entry that is missing, and what the program does with it. */
static enum piglit_result
missing_read(void *data)
{
	make(2);
	return check("(k-buffer program %u reads entry 3, the k-buffer has 2)",
		     kb_program("ADD result.kbuffer[1], kbuffer[3], kbuffer[7];"));
}

static enum piglit_result
missing_written(void *data)
{
	make(2);
	return check("(k-buffer program %u writes entry 2, the k-buffer has 2)",
		     kb_program("MOV result.kbuffer[2], kbuffer[5];"));
}

static enum piglit_result
hole(void *data)
{
	make(2);
	glDrawBuffers(2, (GLenum[]) { GL_NONE, GL_COLOR_ATTACHMENT1 });
	return check("(k-buffer program %u writes entry 0, which has no buffer: "
		     "draw buffer 0 is GL_NONE)",
		     kb_program("MOV result.kbuffer[0], kbuffer[1];"));
}

static enum piglit_result
no_attachment(void *data)
{
	make(1);
	glDrawBuffers(2, (GLenum[]) { GL_COLOR_ATTACHMENT0,
				      GL_COLOR_ATTACHMENT3 });
	return check("(k-buffer program %u reads entry 1, which has no buffer: "
		     "draw buffer 1 is GL_COLOR_ATTACHMENT3)",
		     kb_program("MOV result.kbuffer[0], kbuffer[1];"));
}

static enum piglit_result
no_draw_buffer(void *data)
{
	make(1);
	glDrawBuffer(GL_NONE);
	return check("(no color draw buffer is a k-buffer)",
		     kb_program("MOV result.kbuffer[0], 7;"));
}

/** Of a shader, without which integers are an error of their own. */
static enum piglit_result
integer(void *data)
{
	const GLuint tex = kb_new_texture();
	GLuint program;
	char text[100];
	bool pass;

	make(1);
	program = kb_program("MOV result.kbuffer[0], 7;");
	glBindTexture(GL_TEXTURE_2D, tex);
	glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8UI, KB_COMMAND_SIZE,
		     KB_COMMAND_SIZE, 0, GL_RGBA_INTEGER, GL_UNSIGNED_BYTE,
		     NULL);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, tex, 0);
	glDrawBuffers(2, (GLenum[]) { GL_COLOR_ATTACHMENT0,
				      GL_COLOR_ATTACHMENT1 });
	kb_use_glsl("#version 130\n"
		    "void main() { gl_Position = gl_Vertex; }\n", NULL,
		    "#version 130\nvoid main() { gl_FragColor = vec4(1); }\n");
	snprintf(text, sizeof(text),
		 "(k-buffer program %u with integers in draw buffer 1)",
		 program);
	kb_collect_messages();
	glRectf(-1, -1, 1, 1);
	pass = kb_expect_message(GL_INVALID_OPERATION, text);
	kb_stop_messages();
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** The name of the command is in the message that there has always been. */
static enum piglit_result
names_command(void *data)
{
	bool pass;

	make(1);
	kb_collect_messages();
	glRectf(-1, -1, 1, 1);
	pass = kb_expect_message(GL_INVALID_OPERATION, "in glBegin");
	glDrawArrays(GL_QUADS, 0, 4);
	pass = kb_expect_message(GL_INVALID_OPERATION, "in glDrawArrays") &&
		pass;
	glWindowPos2i(0, 0);
	glCopyPixels(0, 0, 1, 1, GL_COLOR);
	pass = kb_expect_message(GL_INVALID_OPERATION, "glCopyPixels(k-buffer")
		&& pass;
	kb_stop_messages();
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Other errors are not explained by rules that hold. */
static enum piglit_result
other_errors(void *data)
{
	const struct kb kb = make(1);
	bool pass;

	/* An invalid mode is that, also where the program is missing. */
	kb_collect_messages();
	glDrawArrays(0x1234, 0, 4);
	pass = kb_expect_message(GL_INVALID_ENUM, "glDrawArrays");
	kb_program("MOV result.kbuffer[0], 7;");
	glEnable(GL_FRAGMENT_PROGRAM_ARB);
	glDrawArrays(GL_QUADS, 0, 4);
	pass = kb_expect_message(GL_INVALID_OPERATION, "GL_INVALID") && pass;
	glDisable(GL_FRAGMENT_PROGRAM_ARB);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 7, 7, 7, 7) && pass;
	kb_stop_messages();
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("no-program", no_program, NULL),
	KB_SUBTEST("failed-program", failed_program, NULL),
	KB_SUBTEST("missing-entry-read", missing_read, NULL),
	KB_SUBTEST("missing-entry-written", missing_written, NULL),
	KB_SUBTEST("hole", hole, NULL),
	KB_SUBTEST("no-attachment", no_attachment, NULL),
	KB_SUBTEST("no-draw-buffer", no_draw_buffer, NULL),
	KB_SUBTEST("integer", integer, NULL),
	KB_SUBTEST("names-command", names_command, NULL),
	KB_SUBTEST("other-errors", other_errors, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
