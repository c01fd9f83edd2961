/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "kbuffer-messages.h"

/** The collected messages, a line each. */
static char collected[8192];

static void
collect(GLenum source, GLenum type, GLuint id, GLenum severity,
	GLsizei length, const GLchar *message, const void *data)
{
	const size_t used = strlen(collected);

	if (type == GL_DEBUG_TYPE_ERROR)
		snprintf(collected + used, sizeof(collected) - used, "%.*s\n",
			 (int)length, message);
}

void
kb_collect_messages(void)
{
	piglit_require_extension("GL_KHR_debug");
	glEnable(GL_DEBUG_OUTPUT);
	glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
	glDebugMessageCallback((GLDEBUGPROC)collect, NULL);
	collected[0] = '\0';
}

void
kb_stop_messages(void)
{
	glDebugMessageCallback(NULL, NULL);
	glDisable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
	glDisable(GL_DEBUG_OUTPUT);
}

bool
kb_expect_message(GLenum error, const char *text)
{
	bool pass = piglit_check_gl_error(error);
	const char *found = strstr(collected, text);

	if (!found || strstr(found + 1, text)) {
		printf("expected one message with \"%s\", not:\n%s", text,
		       collected);
		pass = false;
	}
	collected[0] = '\0';
	return pass;
}

bool
kb_expect_message_of_draws(const char *text)
{
	bool pass = true;

	for (int i = 0; i < ARRAY_SIZE(kb_commands); i++) {
		kb_commands[i].draw();
		if (!kb_expect_message(GL_INVALID_OPERATION, text)) {
			printf("by %s\n", kb_commands[i].name);
			pass = false;
		}
	}
	return pass;
}
