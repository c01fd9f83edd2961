/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "kbuffer-common.h"

/** What the running subtest has made. */
#define MAX_OBJECTS 256
static GLuint textures[MAX_OBJECTS], fbos[MAX_OBJECTS], programs[MAX_OBJECTS];
static int num_textures, num_fbos, num_programs;

static GLuint
own(GLuint *list, int *num, GLuint name)
{
	if (*num == MAX_OBJECTS) {
		printf("a subtest makes more than %d objects\n", MAX_OBJECTS);
		piglit_report_result(PIGLIT_FAIL);
	}
	return list[(*num)++] = name;
}

static GLuint
new_texture(void)
{
	GLuint name;

	glGenTextures(1, &name);
	return own(textures, &num_textures, name);
}

struct kb
kb_create(GLenum format, int attachments, int layers, int width, int height)
{
	struct kb kb = {
		.target = layers ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D,
		.format = format, .attachments = attachments,
		.layers = layers, .width = width, .height = height,
	};
	GLenum buffers[KB_MAX_ATTACHMENTS];
	static const float zero[4];

	glGenFramebuffers(1, &kb.fbo);
	own(fbos, &num_fbos, kb.fbo);
	glBindFramebuffer(GL_FRAMEBUFFER, kb.fbo);

	for (int i = 0; i < attachments; i++) {
		kb.tex[i] = new_texture();
		glBindTexture(kb.target, kb.tex[i]);
		glTexParameteri(kb.target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
		glTexParameteri(kb.target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
		if (layers)
			glTexImage3D(kb.target, 0, format, width, height,
				     layers, 0, GL_RGBA, GL_FLOAT, NULL);
		else
			glTexImage2D(kb.target, 0, format, width, height,
				     0, GL_RGBA, GL_FLOAT, NULL);
		buffers[i] = GL_COLOR_ATTACHMENT0 + i;
		glFramebufferTexture(GL_FRAMEBUFFER, buffers[i], kb.tex[i], 0);
	}
	glBindTexture(kb.target, 0);
	glDrawBuffers(attachments, buffers);
	glViewport(0, 0, width, height);

	if (attachments) {
		GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);

		if (status != GL_FRAMEBUFFER_COMPLETE) {
			printf("%s x %d x %d layers: framebuffer is %s\n",
			       piglit_get_gl_enum_name(format), attachments,
			       layers, piglit_get_gl_enum_name(status));
			piglit_report_result(PIGLIT_FAIL);
		}
		for (int i = 0; i < attachments; i++)
			glClearBufferfv(GL_COLOR, i, zero);
	}
	return kb;
}

void
kb_attach_depth(const struct kb *kb, GLenum format)
{
	GLuint tex = new_texture();

	glBindTexture(kb->target, tex);
	if (kb->layers)
		glTexImage3D(kb->target, 0, format, kb->width, kb->height,
			     kb->layers, 0, GL_DEPTH_COMPONENT, GL_FLOAT, NULL);
	else
		glTexImage2D(kb->target, 0, format, kb->width, kb->height,
			     0, GL_DEPTH_COMPONENT, GL_FLOAT, NULL);
	glBindTexture(kb->target, 0);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, tex, 0);
}

int
kb_entries(const struct kb *kb)
{
	return kb->attachments * MAX2(kb->layers, 1);
}

/** Bind a color texture of the framebuffer; returns what was bound. */
static GLuint
bind(const struct kb *kb, GLuint tex)
{
	GLint bound;

	glGetIntegerv(kb->layers ? GL_TEXTURE_BINDING_2D_ARRAY :
		      GL_TEXTURE_BINDING_2D, &bound);
	glBindTexture(kb->target, tex);
	return bound;
}

void
kb_upload(const struct kb *kb, int entry, const void *pixels)
{
	GLuint bound = bind(kb, kb->tex[entry % kb->attachments]);

	if (kb->layers)
		glTexSubImage3D(kb->target, 0, 0, 0, entry / kb->attachments,
				kb->width, kb->height, 1, GL_RGBA, GL_FLOAT,
				pixels);
	else
		glTexSubImage2D(kb->target, 0, 0, 0, kb->width, kb->height,
				GL_RGBA, GL_FLOAT, pixels);
	bind(kb, bound);
}

void
kb_fill_bits(const struct kb *kb, int entry, const uint32_t bits[4])
{
	const int n = kb->width * kb->height;
	uint32_t *pixels = malloc(n * 16);

	for (int i = 0; i < n; i++)
		memcpy(pixels + 4 * i, bits, 16);
	kb_upload(kb, entry, pixels);
	free(pixels);
}

void
kb_fill(const struct kb *kb, int entry, float r, float g, float b, float a)
{
	const float value[4] = { r, g, b, a };
	uint32_t bits[4];

	memcpy(bits, value, sizeof(bits));
	kb_fill_bits(kb, entry, bits);
}

float *
kb_read(const struct kb *kb, int entry)
{
	const size_t layer_size = kb->width * kb->height * 4;
	float *all = malloc(layer_size * MAX2(kb->layers, 1) * sizeof(float));
	GLuint bound = bind(kb, kb->tex[entry % kb->attachments]);

	glGetTexImage(kb->target, 0, GL_RGBA, GL_FLOAT, all);
	bind(kb, bound);
	memmove(all, all + layer_size * (entry / kb->attachments),
		layer_size * sizeof(float));
	return all;
}

static bool
expect(const struct kb *kb, int entry, int x0, int y0, int x1, int y1,
       const float value[4], const float *tolerance)
{
	float *pixels = kb_read(kb, entry);
	bool pass = true;

	for (int y = y0; y < y1 && pass; y++) {
		for (int x = x0; x < x1 && pass; x++) {
			const float *p = pixels + 4 * (y * kb->width + x);

			for (int c = 0; c < 4; c++) {
				if (tolerance ?
				    !(fabsf(p[c] - value[c]) <= *tolerance) :
				    memcmp(p + c, value + c, 4) != 0)
					pass = false;
			}
			if (pass)
				continue;

			uint32_t e[4], o[4];
			memcpy(e, value, sizeof(e));
			memcpy(o, p, sizeof(o));
			printf("entry %d at (%d, %d)\n"
			       "  expected %.9g %.9g %.9g %.9g (%08x %08x %08x %08x)\n"
			       "  observed %.9g %.9g %.9g %.9g (%08x %08x %08x %08x)\n",
			       entry, x, y, value[0], value[1], value[2],
			       value[3], e[0], e[1], e[2], e[3], p[0], p[1],
			       p[2], p[3], o[0], o[1], o[2], o[3]);
		}
	}
	free(pixels);
	return pass;
}

bool
kb_expect(const struct kb *kb, int entry, float tolerance,
	  float r, float g, float b, float a)
{
	const float value[4] = { r, g, b, a };

	return expect(kb, entry, 0, 0, kb->width, kb->height, value,
		      &tolerance);
}

bool
kb_expect_rect(const struct kb *kb, int entry, int x, int y, int w, int h,
	       float tolerance, float r, float g, float b, float a)
{
	const float value[4] = { r, g, b, a };

	return expect(kb, entry, x, y, x + w, y + h, value, &tolerance);
}

bool
kb_expect_only_rect(const struct kb *kb, int entry, int x, int y, int w, int h,
		    const float inside[4], const float outside[4])
{
	return expect(kb, entry, x, y, x + w, y + h, inside, NULL) &&
	       expect(kb, entry, 0, 0, x, kb->height, outside, NULL) &&
	       expect(kb, entry, x + w, 0, kb->width, kb->height, outside,
		      NULL) &&
	       expect(kb, entry, x, 0, x + w, y, outside, NULL) &&
	       expect(kb, entry, x, y + h, x + w, kb->height, outside, NULL);
}

bool
kb_expect_bits(const struct kb *kb, int entry, const uint32_t bits[4])
{
	float value[4];

	memcpy(value, bits, sizeof(value));
	return expect(kb, entry, 0, 0, kb->width, kb->height, value, NULL);
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
	GLuint program = glCreateProgram();
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
	/* It goes when it is no longer in use. */
	glDeleteProgram(program);
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
	num_programs = num_fbos = num_textures = 0;

	glClampColor(GL_CLAMP_FRAGMENT_COLOR, GL_FIXED_ONLY);
	glViewport(0, 0, piglit_width, piglit_height);
	glPopAttrib();
	glPushAttrib(GL_ALL_ATTRIB_BITS);
}

void
piglit_init(int argc, char **argv)
{
	piglit_require_extension("GL_MESA_kbuffer_program");
	printf("renderer: %s, %s\n", glGetString(GL_RENDERER),
	       glGetString(GL_VERSION));
	glPushAttrib(GL_ALL_ATTRIB_BITS);
}

enum piglit_result
piglit_display(void)
{
	enum piglit_result result = PIGLIT_SKIP;
	const char **selected;
	size_t num_selected = piglit_get_selected_tests(&selected);

	for (const struct piglit_subtest *t = kbuffer_subtests;
	     !PIGLIT_SUBTEST_END(t); t++) {
		enum piglit_result r;
		bool wanted = num_selected == 0;

		for (size_t i = 0; i < num_selected; i++)
			wanted |= strcmp(selected[i], t->option) == 0;
		if (!wanted)
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
