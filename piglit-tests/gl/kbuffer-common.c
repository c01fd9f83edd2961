/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "kbuffer-common.h"

/** What the running subtest has made. */
#define MAX_OBJECTS 256
static GLuint textures[MAX_OBJECTS], fbos[MAX_OBJECTS], programs[MAX_OBJECTS];
static GLuint glsl_programs[MAX_OBJECTS];
static int num_textures, num_fbos, num_programs, num_glsl_programs;

static GLuint
own(GLuint *list, int *num, GLuint name)
{
	if (*num == MAX_OBJECTS) {
		printf("a subtest makes more than %d objects\n", MAX_OBJECTS);
		piglit_report_result(PIGLIT_FAIL);
	}
	return list[(*num)++] = name;
}

GLuint
kb_new_texture(void)
{
	GLuint name;

	glGenTextures(1, &name);
	return own(textures, &num_textures, name);
}

GLuint
kb_new_framebuffer(void)
{
	GLuint name;

	glGenFramebuffers(1, &name);
	return own(fbos, &num_fbos, name);
}

GLuint
kb_new_glsl_program(void)
{
	return own(glsl_programs, &num_glsl_programs, glCreateProgram());
}

GLenum
kb_load(GLenum target, const char *string, int length)
{
	glProgramStringARB(target, GL_PROGRAM_FORMAT_ASCII_ARB, length, string);
	return glGetError();
}

/** Load a string that must be accepted into a new program, and bind it. */
static GLuint
load_valid(GLenum target, const char *string)
{
	GLuint name;

	glGenProgramsARB(1, &name);
	own(programs, &num_programs, name);
	glBindProgramARB(target, name);
	if (kb_load(target, string, strlen(string)) != GL_NO_ERROR) {
		GLint position;

		glGetIntegerv(GL_PROGRAM_ERROR_POSITION_ARB, &position);
		printf("a valid program was refused at %d: %s\n%s", position,
		       glGetString(GL_PROGRAM_ERROR_STRING_ARB), string);
		piglit_report_result(PIGLIT_FAIL);
	}
	return name;
}

GLuint
kb_program(const char *body)
{
	char *string;
	GLuint name;

	if (asprintf(&string, "!!ARBfp1.0\nOPTION MESA_kbuffer_program;\n"
		     "%s\nEND\n", body) < 0)
		abort();
	name = load_valid(GL_KBUFFER_PROGRAM_MESA, string);
	free(string);
	return name;
}

void
kb_fragment_values(const float (*values)[4], int n)
{
	char string[1024] = "!!ARBfp1.0\nOPTION ARB_draw_buffers;\n";

	for (int i = 0; i < n; i++) {
		char line[64];

		snprintf(line, sizeof(line),
			 "MOV result.color[%d], program.local[%d];\n", i, i);
		strcat(string, line);
	}
	strcat(string, "END\n");
	load_valid(GL_FRAGMENT_PROGRAM_ARB, string);
	for (int i = 0; i < n; i++)
		glProgramLocalParameter4fvARB(GL_FRAGMENT_PROGRAM_ARB, i,
					      values[i]);
	glEnable(GL_FRAGMENT_PROGRAM_ARB);
	glClampColor(GL_CLAMP_FRAGMENT_COLOR, GL_FALSE);
}

void
kb_fragment_value(float r, float g, float b, float a)
{
	load_valid(GL_FRAGMENT_PROGRAM_ARB, "!!ARBfp1.0\n"
		   "MOV result.color, program.local[0];\nEND\n");
	glProgramLocalParameter4fARB(GL_FRAGMENT_PROGRAM_ARB, 0, r, g, b, a);
	glEnable(GL_FRAGMENT_PROGRAM_ARB);
	glClampColor(GL_CLAMP_FRAGMENT_COLOR, GL_FALSE);
}

GLuint
kb_use_glsl(const char *vs, const char *gs, const char *fs)
{
	GLuint program = kb_new_glsl_program();
	const char *const sources[3] = { vs, gs, fs };
	static const GLenum stages[3] = {
		GL_VERTEX_SHADER, GL_GEOMETRY_SHADER, GL_FRAGMENT_SHADER
	};

	for (int i = 0; i < 3; i++) {
		if (sources[i]) {
			GLuint shader = piglit_compile_shader_text(stages[i],
								   sources[i]);
			glAttachShader(program, shader);
			glDeleteShader(shader);
		}
	}
	glLinkProgram(program);
	if (!piglit_link_check_status(program))
		piglit_report_result(PIGLIT_FAIL);
	glUseProgram(program);
	return program;
}

void
kb_draw_rect(const struct kb *kb, float x, float y, float w, float h, float z)
{
	const float x0 = 2 * x / kb->width - 1, y0 = 2 * y / kb->height - 1;
	const float x1 = 2 * (x + w) / kb->width - 1;
	const float y1 = 2 * (y + h) / kb->height - 1;

	z = 2 * z - 1;
	glBegin(GL_QUADS);
	glVertex3f(x0, y0, z);
	glVertex3f(x1, y0, z);
	glVertex3f(x1, y1, z);
	glVertex3f(x0, y1, z);
	glEnd();
}

void
kb_draw(const struct kb *kb)
{
	kb_draw_rect(kb, 0, 0, kb->width, kb->height, 0.5f);
}

bool
kb_is_softpipe(void)
{
	return strstr((const char *)glGetString(GL_RENDERER), "softpipe");
}

/** The context as a subtest finds it. */
static void
reset_context(void)
{
	glUseProgram(0);
	glDisable(GL_FRAGMENT_PROGRAM_ARB);
	glDisable(GL_KBUFFER_PROGRAM_MESA);
	glBindProgramARB(GL_FRAGMENT_PROGRAM_ARB, 0);
	glBindProgramARB(GL_KBUFFER_PROGRAM_MESA, 0);
	glDeleteProgramsARB(num_programs, programs);
	glBindFramebuffer(GL_FRAMEBUFFER, piglit_winsys_fbo);
	glDeleteFramebuffers(num_fbos, fbos);
	glDeleteTextures(num_textures, textures);
	while (num_glsl_programs > 0)
		glDeleteProgram(glsl_programs[--num_glsl_programs]);
	num_programs = num_fbos = num_textures = 0;

	glClampColor(GL_CLAMP_FRAGMENT_COLOR, GL_FIXED_ONLY);
	glViewport(0, 0, piglit_width, piglit_height);
	glPopAttrib();
	glPushAttrib(GL_ALL_ATTRIB_BITS);
}

void
piglit_init(int argc, char **argv)
{
	piglit_require_extension(kb_extension);
	printf("renderer: %s, %s\n", glGetString(GL_RENDERER),
	       glGetString(GL_VERSION));
	glPushAttrib(GL_ALL_ATTRIB_BITS);
}

static bool
is_selected(const struct piglit_subtest *subtest)
{
	const char **selected;
	const size_t n = piglit_get_selected_tests(&selected);

	for (size_t i = 0; i < n; i++) {
		if (strcmp(selected[i], subtest->option) == 0)
			return true;
	}
	return n == 0;
}

/** To piglit: those of which no result follows have not been run. */
static void
announce_subtests(void)
{
	const char *names[256];
	int n = 0;

	for (const struct piglit_subtest *t = kbuffer_subtests;
	     !PIGLIT_SUBTEST_END(t); t++) {
		if (is_selected(t) && n < ARRAY_SIZE(names) - 1)
			names[n++] = t->name;
	}
	names[n] = NULL;
	if (n > 0)
		piglit_register_subtests(names);
}

enum piglit_result
piglit_display(void)
{
	enum piglit_result result = PIGLIT_SKIP;

	announce_subtests();
	for (const struct piglit_subtest *t = kbuffer_subtests;
	     !PIGLIT_SUBTEST_END(t); t++) {
		enum piglit_result r;

		if (!is_selected(t))
			continue;
		r = t->subtest_func(t->data);
		if (!piglit_check_gl_error(GL_NO_ERROR))
			r = PIGLIT_FAIL;
		reset_context();
		piglit_report_subtest_result(r, "%s", t->name);
		piglit_merge_result(&result, r);
	}
	return result;
}
