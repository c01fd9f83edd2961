/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-fragment-stage.c
 * fragment.color[n] is color output n of the fragment stage: fixed function,
 * an ARB program or GLSL, with or without a draw buffer n; a single color is
 * the value of every output; clamping comes before.
 */

#include "kbuffer-common.h"

#define W 16

static const char vs[] =
	"#version 130\n"
	"void main() { gl_Position = gl_Vertex; }\n";

/** Sums all eight inputs with weights that tell them apart. */
static const char weigh[] =
	"TEMP t;\n"
	"MAD t, fragment.color[1], 2, fragment.color[0];\n"
	"MAD t, fragment.color[2], 4, t;\nMAD t, fragment.color[3], 8, t;\n"
	"MAD t, fragment.color[4], 16, t;\nMAD t, fragment.color[5], 32, t;\n"
	"MAD t, fragment.color[6], 64, t;\n"
	"MAD result.kbuffer[0], fragment.color[7], 128, t;";

static struct kb
make(const char *program)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);

	kb_program(program);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	return kb;
}

static enum piglit_result
check(const struct kb *kb, float r, float g, float b, float a)
{
	return kb_expect(kb, 0, 0, r, g, b, a) ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
fixed_function(void *data)
{
	struct kb kb = make((const char *)data);

	glColor4f(.25, .5, .75, 1);
	kb_draw(&kb);
	return data == weigh ? check(&kb, 63.75, 127.5, 191.25, 255) :
		check(&kb, .5, 1, 1.5, 2);
}

/** Texturing, color sum and fog are before. */
static enum piglit_result
fixed_function_fog(void *data)
{
	static const float texel[4] = { .5, .5, 1, 1 };
	static const float fog[4] = { 1, 0, 0, 0 };
	struct kb kb = make("MUL result.kbuffer[0], fragment.color, 2;");
	GLuint tex;
	bool pass;

	glGenTextures(1, &tex);
	glBindTexture(GL_TEXTURE_2D, tex);
	glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, 1, 1, 0, GL_RGBA, GL_FLOAT,
		     texel);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	glEnable(GL_TEXTURE_2D);
	glEnable(GL_FOG);
	glFogi(GL_FOG_MODE, GL_LINEAR);
	glFogi(GL_FOG_COORD_SRC, GL_FOG_COORD);
	glFogf(GL_FOG_START, 0);
	glFogf(GL_FOG_END, 1);
	glFogfv(GL_FOG_COLOR, fog);
	glFogCoordf(.5);
	glColor4f(.5, 1, .25, 1);
	kb_draw(&kb);
	/* (.25, .5, .25, 1) half way to (1, 0, 0) */
	pass = kb_expect(&kb, 0, 1e-6, 1.25, .5, .25, 2);
	glDeleteTextures(1, &tex);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
arb_single_color(void *data)
{
	struct kb kb = make(weigh);

	kb_fragment_value(1, 2, 3, -4);
	kb_draw(&kb);
	return check(&kb, 255, 510, 765, -1020);
}

/** Eight outputs and one draw buffer. */
static enum piglit_result
arb_eight_colors(void *data)
{
	struct kb kb = make(weigh);
	float values[8][4];

	for (int i = 0; i < 8; i++) {
		for (int c = 0; c < 4; c++)
			values[i][c] = c == i % 4 ? i + 1 : 0;
	}
	kb_fragment_values(values, 8);
	kb_draw(&kb);
	return check(&kb, 1 + 5 * 16, 2 * 2 + 6 * 32, 3 * 4 + 7 * 64,
		     4 * 8 + 8 * 128);
}

static enum piglit_result
glsl_frag_color(void *data)
{
	struct kb kb = make(weigh);

	kb_use_glsl(vs, NULL, "#version 130\nvoid main() { "
		    "gl_FragColor = vec4(1, 2, 3, -4); }\n");
	kb_draw(&kb);
	return check(&kb, 255, 510, 765, -1020);
}

static enum piglit_result
glsl_frag_data(void *data)
{
	struct kb kb = make(weigh);

	kb_use_glsl(vs, NULL, "#version 130\nvoid main() { "
		    "for (int i = 0; i < 8; i++) "
		    "gl_FragData[i] = vec4(i, 1, -i, 0.5); }\n");
	kb_draw(&kb);
	/* sum of i 2^i, i < 8, is 1538. */
	return check(&kb, 1538, 255, -1538, 127.5);
}

/** Locations out of order, some unused: those that are not read. */
static enum piglit_result
glsl_locations(void *data)
{
	struct kb kb = make("MAD result.kbuffer[0], fragment.color[6], 10, "
			    "fragment.color[3];");

	piglit_require_extension("GL_ARB_explicit_attrib_location");
	kb_use_glsl(vs, NULL, "#version 130\n"
		    "#extension GL_ARB_explicit_attrib_location: require\n"
		    "layout(location = 6) out vec4 a;\n"
		    "layout(location = 3) out vec4 b;\n"
		    "void main() { a = vec4(1, 2, 3, 4); b = vec4(5); }\n");
	kb_draw(&kb);
	return check(&kb, 15, 25, 35, 45);
}

/** An output of fewer components: those it has. */
static enum piglit_result
glsl_small_output(void *data)
{
	struct kb kb = make("MOV result.kbuffer[0].xy, fragment.color;");

	kb_use_glsl(vs, NULL, "#version 130\nout vec2 a;\n"
		    "void main() { a = vec2(7, 8); }\n");
	kb_draw(&kb);
	return check(&kb, 7, 8, 0, 0);
}

/** The second source color of dual-source blending is not an input. */
static enum piglit_result
dual_source(void *data)
{
	struct kb kb = make("ADD result.kbuffer[0], kbuffer[0], "
			    "fragment.color[0];");
	bool pass;

	if (!piglit_is_extension_supported("GL_ARB_blend_func_extended")) {
		printf("no dual-source blending here\n");
		return PIGLIT_SKIP;
	}
	kb_use_glsl(vs, NULL, "#version 130\n"
		    "#extension GL_ARB_explicit_attrib_location: require\n"
		    "layout(location = 0, index = 0) out vec4 a;\n"
		    "layout(location = 0, index = 1) out vec4 b;\n"
		    "void main() { a = vec4(1, 2, 3, 4); b = vec4(50); }\n");
	glEnable(GL_BLEND);
	glBlendFunc(GL_SRC1_COLOR, GL_ONE_MINUS_SRC1_COLOR);
	kb_draw(&kb);
	pass = check(&kb, 1, 2, 3, 4) == PIGLIT_PASS;
	/* Nor is it that of another output. */
	kb_program("MOV result.kbuffer[0], fragment.color[1];");
	kb_draw(&kb);
	return check(&kb, 0, 0, 0, 1) == PIGLIT_PASS && pass ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

/** Integer outputs keep nothing to read, but must do no harm. */
static enum piglit_result
no_output(void *data)
{
	struct kb kb = make("MOV result.kbuffer[0], 7;");

	kb_use_glsl(vs, NULL, "#version 130\nvoid main() { }\n");
	kb_draw(&kb);
	return check(&kb, 7, 7, 7, 7);
}

/** Color outputs that the fragment stage does not write are (0, 0, 0, 1). */
static enum piglit_result
unwritten(void *data)
{
	static const char *const fragment_shaders[] = {
		"#version 150 compatibility\n"
		"#extension GL_ARB_explicit_attrib_location: require\n"
		"layout(location = 1) out vec4 a;\n"
		"void main() { a = vec4(5, 6, 7, 8); }\n",
		"#version 150 compatibility\nvoid main() { }\n",
	};
	struct kb kb = kb_create(GL_RGBA32F, 3, 0, W, W);
	bool pass = true;

	kb_program("MOV result.kbuffer[0], fragment.color[0];\n"
		   "MOV result.kbuffer[1], fragment.color[1];\n"
		   "MOV result.kbuffer[2], fragment.color[7];");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	for (int i = 0; i < ARRAY_SIZE(fragment_shaders); i++) {
		kb_use_glsl(vs, NULL, fragment_shaders[i]);
		for (int e = 0; e < 3; e++)
			kb_fill(&kb, e, 9, 9, 9, 9);
		kb_draw(&kb);
		pass = kb_expect(&kb, 0, 0, 0, 0, 0, 1) && pass;
		pass = (i == 0 ? kb_expect(&kb, 1, 0, 5, 6, 7, 8) :
			kb_expect(&kb, 1, 0, 0, 0, 0, 1)) && pass;
		pass = kb_expect(&kb, 2, 0, 0, 0, 0, 1) && pass;
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** The same of an ARB program that has another result only. */
static enum piglit_result
arb_unwritten(void *data)
{
	static const char fp[] = "!!ARBfp1.0\nOPTION ARB_draw_buffers;\n"
		"MOV result.color[1], { 5, 6, 7, 8 };\nEND\n";
	struct kb kb = kb_create(GL_RGBA32F, 2, 0, W, W);

	kb_fragment_value(0, 0, 0, 0);
	if (kb_load(GL_FRAGMENT_PROGRAM_ARB, fp, strlen(fp)))
		return PIGLIT_FAIL;
	kb_program("MOV result.kbuffer[0], fragment.color[0];\n"
		   "MOV result.kbuffer[1], fragment.color[1];");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	return kb_expect(&kb, 0, 0, 0, 0, 0, 1) &&
		kb_expect(&kb, 1, 0, 5, 6, 7, 8) ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Two triangles: the left half faces the viewer, the right half does not. */
static void
draw_both_faces(void)
{
	static const float corners[12][2] = {
		{ -1, -1 }, { 0, -1 }, { 0, 1 }, { -1, -1 }, { 0, 1 }, { -1, 1 },
		{ 0, -1 }, { 1, 1 }, { 1, -1 }, { 0, -1 }, { 0, 1 }, { 1, 1 },
	};

	glBegin(GL_TRIANGLES);
	for (int i = 0; i < 12; i++)
		glVertex2fv(corners[i]);
	glEnd();
}

/** gl_FrontFacing in expressions. */
static enum piglit_result
front_facing(void *data)
{
	struct kb kb = make("MOV result.kbuffer[0], fragment.color;");
	GLuint program = kb_use_glsl(vs, NULL, "#version 130\n"
		"uniform float yes;\nout vec4 o;\n"
		"void main() {\n"
		"  o = vec4(gl_FrontFacing, yes > 0.0 && !gl_FrontFacing,\n"
		"           yes < 0.0 || !gl_FrontFacing,\n"
		"           gl_FrontFacing == (yes > 0.0));\n}\n");

	glUniform1f(glGetUniformLocation(program, "yes"), 1);
	draw_both_faces();
	return kb_expect_rect(&kb, 0, 0, 0, W / 2, W, 0, 1, 0, 0, 1) &&
		kb_expect_rect(&kb, 0, W / 2, 0, W / 2, W, 0, 0, 1, 1, 0) ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

/** gl_PrimitiveID counts from 0 in each draw, without a geometry shader. */
static enum piglit_result
primitive_id(void *data)
{
	const GLenum mode = *(const GLenum *)data;
	const int n = mode == GL_TRIANGLES ? 3 : mode == GL_LINES ? 2 : 1;
	struct kb kb = make("MOV result.kbuffer[0], fragment.color;");
	float vertices[3 * W][2];
	GLushort elements[3 * W];

	/* A primitive over each row of pixels, all but points with clipped ends. */
	for (int i = 0; i < W; i++) {
		const float y = 2 * (i + .5f) / W - 1, half = 1.f / W - .001f;
		const float all[3][2] = {
			{ n == 1 ? 1.f / W : -2, n == 3 ? y - half : y },
			{ 1e4, y }, { -2, y + half }
		};

		memcpy(vertices[n * i], all, n * sizeof *all);
	}
	for (int i = 0; i < n * W; i++)
		elements[i] = i;
	kb_use_glsl("#version 150 compatibility\n"
		    "void main() { gl_Position = gl_Vertex; }\n", NULL,
		    "#version 150 compatibility\nout vec4 o;\n"
		    "void main() { o = vec4(gl_PrimitiveID, 1, 2, 3); }\n");
	glVertexPointer(2, GL_FLOAT, 0, vertices);
	glEnableClientState(GL_VERTEX_ARRAY);
	glDrawArrays(mode, 0, n * W);
	glDrawElements(mode, n * W, GL_UNSIGNED_SHORT, elements);
	glDisableClientState(GL_VERTEX_ARRAY);
	for (int i = 0; i < W; i++) {
		if (!kb_expect_rect(&kb, 0, n == 1 ? W / 2 : 0, i,
				    n == 1 ? 1 : W, 1, 0, i, 1, 2, 3))
			return PIGLIT_FAIL;
	}
	return PIGLIT_PASS;
}

/** Sprites take another way through softpipe. */
static enum piglit_result
primitive_id_of_sprites(void *data)
{
	glEnable(GL_POINT_SPRITE);
	return primitive_id(data);
}

static const GLenum points = GL_POINTS, lines = GL_LINES,
	triangles = GL_TRIANGLES;

struct clamp { GLenum mode, format; bool clamped; };

static enum piglit_result
clamp(void *data)
{
	const struct clamp *t = data;
	struct kb kb = kb_create(t->format, 1, 0, W, W);
	/* Half a step of RGBA8. */
	const float tolerance = t->format == GL_RGBA8 ? .5 / 255 + 1e-6 : 1e-6;

	kb_program("MUL result.kbuffer[0], fragment.color, 0.2;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_fragment_value(2, -5, .5, 5);
	glClampColor(GL_CLAMP_FRAGMENT_COLOR, t->mode);
	kb_draw(&kb);
	return (t->clamped ? kb_expect(&kb, 0, tolerance, .2, 0, .1, .2) :
		kb_expect(&kb, 0, tolerance, .4, -1, .1, 1)) ?
		PIGLIT_PASS : PIGLIT_FAIL;
}

static const struct clamp
on = { GL_TRUE, GL_RGBA32F, true },
off = { GL_FALSE, GL_RGBA32F, false },
fixed_only_float = { GL_FIXED_ONLY, GL_RGBA32F, false },
fixed_only_fixed = { GL_FIXED_ONLY, GL_RGBA8, true },
on_fixed = { GL_TRUE, GL_RGBA8, true };

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("fixed-function", fixed_function,
		   "MUL result.kbuffer[0], fragment.color, 2;"),
	KB_SUBTEST("fixed-function-every-output", fixed_function, weigh),
	KB_SUBTEST("fixed-function-texture-and-fog", fixed_function_fog, NULL),
	KB_SUBTEST("arb-single-color", arb_single_color, NULL),
	KB_SUBTEST("arb-eight-colors", arb_eight_colors, NULL),
	KB_SUBTEST("glsl-frag-color", glsl_frag_color, NULL),
	KB_SUBTEST("glsl-frag-data", glsl_frag_data, NULL),
	KB_SUBTEST("glsl-locations", glsl_locations, NULL),
	KB_SUBTEST("glsl-small-output", glsl_small_output, NULL),
	KB_SUBTEST("dual-source", dual_source, NULL),
	KB_SUBTEST("no-output", no_output, NULL),
	KB_SUBTEST("unwritten-is-black", unwritten, NULL),
	KB_SUBTEST("arb-unwritten-is-black", arb_unwritten, NULL),
	KB_SUBTEST("front-facing", front_facing, NULL),
	KB_SUBTEST("primitive-id-points", primitive_id, &points),
	KB_SUBTEST("primitive-id-sprites", primitive_id_of_sprites, &points),
	KB_SUBTEST("primitive-id-lines", primitive_id, &lines),
	KB_SUBTEST("primitive-id-triangles", primitive_id, &triangles),
	KB_SUBTEST("clamp-on", clamp, &on),
	KB_SUBTEST("clamp-on-fixed", clamp, &on_fixed),
	KB_SUBTEST("clamp-off", clamp, &off),
	KB_SUBTEST("clamp-fixed-only-float", clamp, &fixed_only_float),
	KB_SUBTEST("clamp-fixed-only-fixed", clamp, &fixed_only_fixed),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
