/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-common.c
 * Drawing for the tests of depth peeling.
 */

#include "peel-common.h"

/** The statement that gives an output the color of the fragment's id. */
static void
output_text(const struct peel_format *format, int output, char *declaration,
	    char *statement)
{
	const char *type = format->kind == PEEL_UINT ? "uvec4" :
		format->kind == PEEL_INT ? "ivec4" : "vec4";

	sprintf(declaration, "layout(location = %d) out %s c%d;\n", output,
		type, output);
	statement += sprintf(statement, "c%d = %s(", output, type);
	for (int c = 0; c < 4; c++) {
		const int bits = format->bits[c] ? format->bits[c] : 1;
		const uint32_t mask = bits == 32 ? ~0u : (1u << bits) - 1;
		char v[32];

		sprintf(v, "hash(id, %du)", 4 * output + c);
		switch (format->kind) {
		case PEEL_UNORM:
			statement += sprintf(statement,
				"float(%s & %uu) / %u.0", v, mask, mask);
			break;
		case PEEL_SNORM:
			statement += sprintf(statement,
				"float(int(%s %% %uu) - %u) / %u.0", v,
				mask / 2 * 2 + 1, mask / 2, mask / 2);
			break;
		case PEEL_FLOAT:
			statement += sprintf(statement, "float(%s & 31u)", v);
			break;
		case PEEL_INT:
			/* With the sign that the highest bit is. */
			statement += sprintf(statement,
				"int(%s << %du) >> %d", v, 32 - bits,
				32 - bits);
			break;
		default:
			statement += sprintf(statement, "%s & %uu", v, mask);
		}
		statement += sprintf(statement, c < 3 ? ", " : ");\n");
	}
}

/** A program of the fragment shader, made once for all subtests. */
static GLuint
find_program(char *fs)
{
	static const char vs[] =
		"#version 150 compatibility\n"
		"in vec4 position;\nin uint vertex_id;\n"
		"flat out uint id;\n"
		"void main() { gl_Position = position; id = vertex_id; }\n";
	static struct { char *fs; GLuint program; } known[256];
	GLuint shaders[2], program;
	int i = 0;

	while (i < ARRAY_SIZE(known) && known[i].fs) {
		if (strcmp(known[i].fs, fs) == 0) {
			free(fs);
			return known[i].program;
		}
		i++;
	}
	if (i == ARRAY_SIZE(known)) {
		printf("more than %d programs\n", i);
		piglit_report_result(PIGLIT_FAIL);
	}
	program = glCreateProgram();
	shaders[0] = piglit_compile_shader_text(GL_VERTEX_SHADER, vs);
	shaders[1] = piglit_compile_shader_text(GL_FRAGMENT_SHADER, fs);
	for (int j = 0; j < 2; j++) {
		glAttachShader(program, shaders[j]);
		glDeleteShader(shaders[j]);
	}
	glBindAttribLocation(program, 0, "position");
	glBindAttribLocation(program, 1, "vertex_id");
	glLinkProgram(program);
	if (!piglit_link_check_status(program))
		piglit_report_result(PIGLIT_FAIL);
	known[i].fs = fs;
	return known[i].program = program;
}

GLuint
peel_use_program(struct peel *p, const char *declarations,
		 const char *statements)
{
	/* As in peel-formats.c. */
	static const char head[] =
		"#version 150 compatibility\n"
		"#extension GL_ARB_explicit_attrib_location: require\n"
		"%s"
		"flat in uint id;\n"
		"uint hash(uint id, uint slot) {\n"
		"  uint v = (id * 64u + slot) * 2654435761u;\n"
		"  v = (v ^ (v >> 15u)) * 2246822519u;\n"
		"  return v ^ (v >> 13u);\n"
		"}\n";
	char outputs[PEEL_MAX_COLORS * 48] = "", body[8192] = "";
	char *fs = NULL, *top = NULL;

	for (int o = 0; o < PEEL_MAX_COLORS; o++) {
		if (p->buffers[o] >= 0)
			output_text(p->color[p->buffers[o]], o,
				    outputs + strlen(outputs),
				    body + strlen(body));
	}
	if (asprintf(&top, head, declarations) < 0 ||
	    asprintf(&fs, "%s%svoid main() {\n%s\n%s}\n", top, outputs,
		     statements, body) < 0)
		abort();
	free(top);
	p->program = find_program(fs);
	glUseProgram(p->program);
	return p->program;
}

void
peel_draw_vertices(GLenum mode, const struct peel_vertex *vertices, int n)
{
	glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(*vertices),
			      &vertices->x);
	glVertexAttribIPointer(1, 1, GL_UNSIGNED_INT, sizeof(*vertices),
			       &vertices->id);
	glEnableVertexAttribArray(0);
	glEnableVertexAttribArray(1);
	glDrawArrays(mode, 0, n);
	glDisableVertexAttribArray(0);
	glDisableVertexAttribArray(1);
}

void
peel_draw_gl(const struct peel *p, const struct peel_quad *quads, int n)
{
	/* Two triangles, by their corners' x and y. */
	static const int corners[6][2] = {
		{ 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 0 }, { 1, 1 }, { 0, 1 }
	};
	struct peel_vertex *vertices = malloc(n * 6 * sizeof(*vertices));

	for (int i = 0; i < n * 6; i++) {
		const struct peel_quad *q = &quads[i / 6];
		const float z = p->depth->bits[0] == 32 ? q->z : peel_depth(
			p->depth, peel_depth_code(p->depth, q->z));
		/*
		 * Not for GL to clip: where softpipe divides a clipped polygon
		 * a pixel may get two fragments.
		 */
		const float x = corners[i % 6][0] ? MIN2(q->x1, p->width) :
			MAX2(q->x0, 0);
		const float y = corners[i % 6][1] ? MIN2(q->y1, p->height) :
			MAX2(q->y0, 0);

		vertices[i] = (struct peel_vertex) {
			2 * x / p->width - 1, 2 * y / p->height - 1, z, 1,
			q->id
		};
	}
	peel_draw_vertices(GL_TRIANGLES, vertices, n * 6);
	free(vertices);
}

void
peel_draw(struct peel *p, const struct peel_quad *quads, int n)
{
	peel_draw_gl(p, quads, n);
	peel_draw_model(p, quads, n);
}

struct peel_quad
peel_full(const struct peel *p, float z, uint32_t id)
{
	return (struct peel_quad) { 0, 0, p->width, p->height, z, id };
}

static uint32_t state;

void
peel_seed(uint32_t seed)
{
	state = seed * 2654435761u + 1;
}

int
peel_random(int below)
{
	state = state * 1664525 + 1013904223;
	return (state >> 8) % below;
}

void
peel_shuffle(struct peel_quad *quads, int n)
{
	for (int i = n - 1; i > 0; i--) {
		const int j = peel_random(i + 1);
		const struct peel_quad q = quads[i];

		quads[i] = quads[j];
		quads[j] = q;
	}
}

void
peel_random_triangles(struct peel_vertex *vertices, int n, uint32_t first)
{
	for (int i = 0; i < 3 * n; i++) {
		const float w = 1 + peel_random(1000) / 1000.;

		/* Some reach out of the depth range and are clipped. */
		vertices[i] = (struct peel_vertex) {
			(peel_random(2400) - 1200) / 1000. * w,
			(peel_random(2400) - 1200) / 1000. * w,
			(peel_random(1100) - 50) / 1000. * w, w, first + i / 3
		};
	}
}
