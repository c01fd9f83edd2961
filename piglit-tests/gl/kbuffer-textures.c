/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-textures.c
 * Texture instructions of a k-buffer program: every target of
 * ARB_fragment_program, on units that only the program uses and on units that
 * the fragment stage uses, too; filters, wrap modes, bias, projection; a
 * changed binding counts from the next draw on.
 */

#include "kbuffer-common.h"

#define W 16

/** Make, bind and fill a texture whose level 0 holds \p texels. */
static GLuint
make_texture(GLenum target, int w, int h, int d, const float *texels)
{
	GLuint tex;

	glGenTextures(1, &tex);
	glBindTexture(target, tex);
	glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
	if (target == GL_TEXTURE_1D)
		glTexImage1D(target, 0, GL_RGBA32F, w, 0, GL_RGBA, GL_FLOAT,
			     texels);
	else if (target == GL_TEXTURE_3D)
		glTexImage3D(target, 0, GL_RGBA32F, w, h, d, 0, GL_RGBA,
			     GL_FLOAT, texels);
	else if (target == GL_TEXTURE_CUBE_MAP)
		for (int f = 0; f < 6; f++)
			glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + f, 0,
				     GL_RGBA32F, w, h, 0, GL_RGBA, GL_FLOAT,
				     texels + 4 * w * h * f);
	else
		glTexImage2D(target, 0, GL_RGBA32F, w, h, 0, GL_RGBA, GL_FLOAT,
			     texels);
	return tex;
}

struct lookup {
	GLenum target;
	const char *name;       /**< in programs */
	float coord[4];
	int texel;              /**< the one that is to be found */
};

/** Texel i is { i, i + .25, -i, i * i }. */
static enum piglit_result
target(void *data)
{
	const struct lookup *t = data;
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	float texels[6 * 4 * 4 * 4][4];
	char body[256];
	const float i = t->texel;
	bool pass = true;

	for (int n = 0; n < ARRAY_SIZE(texels); n++) {
		texels[n][0] = n;
		texels[n][1] = n + .25f;
		texels[n][2] = -n;
		texels[n][3] = n * n;
	}
	/* On the first unit and on one that nothing else uses. */
	for (int unit = 0; unit < 8; unit += 5) {
		GLuint tex;

		glActiveTexture(GL_TEXTURE0 + unit);
		tex = make_texture(t->target, 4, 4, 4, texels[0]);
		snprintf(body, sizeof(body),
			 "TEMP t;\nTEX t, { %g, %g, %g, %g }, texture[%d], "
			 "%s;\nMOV result.kbuffer[0], t;", t->coord[0],
			 t->coord[1], t->coord[2], t->coord[3], unit, t->name);
		kb_program(body);
		glEnable(GL_KBUFFER_PROGRAM_MESA);
		kb_draw(&kb);
		pass = kb_expect(&kb, 0, 0, i, i + .25f, -i, i * i) && pass;
		glDeleteTextures(1, &tex);
		glActiveTexture(GL_TEXTURE0);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Texel (2, 1) of 4 x 4 is 6; layer 3 of 4 x 4 x 4 adds 48. */
static const struct lookup
t1d = { GL_TEXTURE_1D, "1D", { .6, 0, 0, 0 }, 2 },
t2d = { GL_TEXTURE_2D, "2D", { .6, .3, 0, 0 }, 6 },
t3d = { GL_TEXTURE_3D, "3D", { .6, .3, .9, 0 }, 54 },
rectangle = { GL_TEXTURE_RECTANGLE, "RECT", { 2.5, 1.5, 0, 0 }, 6 },
/* -z: face 5; s = (-x / |z| + 1) / 2 = .6, t = (-y / |z| + 1) / 2 = .3 */
cube = { GL_TEXTURE_CUBE_MAP, "CUBE", { -.2, .4, -1, 0 }, 5 * 16 + 6 };

/** Compare a depth texture of { .25, .75 }. */
static enum piglit_result
shadow(void *data)
{
	const GLenum target = (GLenum)(intptr_t)data;
	const bool rect = target == GL_TEXTURE_RECTANGLE;
	static const float depths[2] = { .25, .75 };
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	GLuint tex;
	char body[512];
	bool pass;

	glGenTextures(1, &tex);
	glActiveTexture(GL_TEXTURE3);
	glBindTexture(target, tex);
	glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
	glTexParameteri(target, GL_TEXTURE_COMPARE_MODE,
			GL_COMPARE_REF_TO_TEXTURE);
	glTexParameteri(target, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
	if (target == GL_TEXTURE_1D)
		glTexImage1D(target, 0, GL_DEPTH_COMPONENT32F, 2, 0,
			     GL_DEPTH_COMPONENT, GL_FLOAT, depths);
	else
		glTexImage2D(target, 0, GL_DEPTH_COMPONENT32F, 2, 1, 0,
			     GL_DEPTH_COMPONENT, GL_FLOAT, depths);
	snprintf(body, sizeof(body),
		 "OPTION ARB_fragment_program_shadow;\nTEMP t;\n"
		 "TEX t.x, { %g, %g, 0.5, 0 }, texture[3], SHADOW%s;\n"
		 "TEX t.y, { %g, %g, 0.5, 0 }, texture[3], SHADOW%s;\n"
		 "MOV result.kbuffer[0].x, t.x;\n"
		 "MOV result.kbuffer[0].y, t.y;",
		 rect ? .5 : .25, .5, rect ? "RECT" :
		 target == GL_TEXTURE_1D ? "1D" : "2D",
		 rect ? 1.5 : .75, .5, rect ? "RECT" :
		 target == GL_TEXTURE_1D ? "1D" : "2D");
	kb_program(body);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	/* .5 <= .25 is false, .5 <= .75 is true. */
	pass = kb_expect(&kb, 0, 0, 0, 1, 0, 0);
	glActiveTexture(GL_TEXTURE0);
	glDeleteTextures(1, &tex);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** The fragment stage and the program look up different textures, and one. */
static enum piglit_result
with_fragment_stage(void *data)
{
	static const float a[4] = { 1, 2, 3, 4 }, b[4] = { 10, 20, 30, 40 };
	static const char fp[] = "!!ARBfp1.0\n"
		"TEX result.color, 0, texture[0], 2D;\nEND\n";
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	GLuint tex[2];
	bool pass;

	tex[0] = make_texture(GL_TEXTURE_2D, 1, 1, 1, a);
	glActiveTexture(GL_TEXTURE7);
	tex[1] = make_texture(GL_TEXTURE_2D, 1, 1, 1, b);
	kb_fragment_value(0, 0, 0, 0);
	pass = kb_load(GL_FRAGMENT_PROGRAM_ARB, fp, strlen(fp)) == GL_NO_ERROR;
	kb_program("TEMP s, t;\nTEX s, 0, texture[0], 2D;\n"
		   "TEX t, 0, texture[7], 2D;\n"
		   "MAD t, s, 100, t;\nMAD result.kbuffer[0], "
		   "fragment.color, 1000, t;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 1110, 2220, 3330, 4440) && pass;

	/* Another binding, contents and sampler state, one by one. */
	glBindTexture(GL_TEXTURE_2D, tex[0]);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 1101, 2202, 3303, 4404) && pass;
	glBindTexture(GL_TEXTURE_2D, tex[1]);
	glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 1, 1, GL_RGBA, GL_FLOAT, a);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 1101, 2202, 3303, 4404) && pass;
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_R, GL_ALPHA);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 1104, 2202, 3303, 4404) && pass;

	/* The program alone, and the fragment stage alone. */
	glDisable(GL_FRAGMENT_PROGRAM_ARB);
	glColor4f(0, 0, 0, 0);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 104, 202, 303, 404) && pass;
	glEnable(GL_FRAGMENT_PROGRAM_ARB);
	glDisable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 1, 2, 3, 4) && pass;
	glDeleteTextures(2, tex);
	glActiveTexture(GL_TEXTURE0);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static const char two_targets[] = "!!ARBfp1.0\n"
	"OPTION MESA_kbuffer_program;\nTEMP t;\n"
	"TEX t, 0, texture[0], 2D;\nTEX t, t, texture[0], 3D;\nEND\n";

/** The two stages sample different targets of one unit. */
static enum piglit_result
other_target(void *data)
{
	static const float a[4] = { 1, 2, 3, 4 }, b[4] = { 10, 20, 30, 40 };
	static const char fp[] = "!!ARBfp1.0\n"
		"TEX result.color, 0, texture[0], 2D;\nEND\n";
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	GLuint tex[2];
	bool pass;

	tex[0] = make_texture(GL_TEXTURE_2D, 1, 1, 1, a);
	tex[1] = make_texture(GL_TEXTURE_3D, 1, 1, 1, b);
	kb_program("TEMP t;\nTEX t, 0, texture[0], 3D;\n"
		   "MAD result.kbuffer[0], fragment.color, 100, t;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_fragment_value(0, 0, 0, 0);
	pass = kb_load(GL_FRAGMENT_PROGRAM_ARB, fp, strlen(fp)) == GL_NO_ERROR;
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 110, 220, 330, 440) && pass;

	/* Nor is it an error of GLSL, whose own samplers may not do that. */
	kb_use_glsl("#version 130\n"
		    "void main() { gl_Position = gl_Vertex; }\n", NULL,
		    "#version 130\nuniform sampler2D s;\n"
		    "void main() { gl_FragColor = texture(s, vec2(0)); }\n");
	kb_fill(&kb, 0, 0, 0, 0, 0);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 110, 220, 330, 440) && pass;

	/* One program may not, as in a fragment program. */
	pass = kb_load(GL_KBUFFER_PROGRAM_MESA, two_targets,
		       strlen(two_targets)) == GL_INVALID_OPERATION && pass;
	glDeleteTextures(2, tex);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** All image units, by the fragment stage and by the program at once. */
static enum piglit_result
all_units(void *data)
{
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	char fp[4096] = "!!ARBfp1.0\nTEMP s, t;\nMOV s, 0;\n";
	char body[4096] = "TEMP s, t;\nMOV s, 0;\n", line[100];
	GLuint tex[64];
	GLint units = 0;
	float sum = 0;
	bool pass;

	glGetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &units);
	units = MIN2(units, ARRAY_SIZE(tex));
	for (int i = 0; i < units; i++) {
		const float texel[4] = { i + 1, 0, 0, 0 };

		glActiveTexture(GL_TEXTURE0 + i);
		tex[i] = make_texture(GL_TEXTURE_2D, 1, 1, 1, texel);
		snprintf(line, sizeof(line), "TEX t, 0, texture[%d], 2D;\n"
			 "MAD s, t, %d, s;\n", i, i + 1);
		strcat(fp, line);
		strcat(body, line);
		sum += (i + 1) * (i + 1);
	}
	strcat(fp, "MOV result.color, s;\nEND\n");
	strcat(body, "MAD result.kbuffer[0], fragment.color, 100, s;");
	kb_fragment_value(0, 0, 0, 0);
	pass = kb_load(GL_FRAGMENT_PROGRAM_ARB, fp, strlen(fp)) == GL_NO_ERROR;
	kb_program(body);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 101 * sum, 0, 0, 0) && pass;

	/* One more is no unit of either. */
	snprintf(body, sizeof(body), "!!ARBfp1.0\n"
		 "OPTION MESA_kbuffer_program;\nTEMP t;\n"
		 "TEX t, 0, texture[%d], 2D;\nEND\n", units);
	pass = (units == ARRAY_SIZE(tex) ||
		kb_load(GL_KBUFFER_PROGRAM_MESA, body, strlen(body)) ==
		GL_INVALID_OPERATION) && pass;
	glActiveTexture(GL_TEXTURE0);
	glDeleteTextures(units, tex);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** A lookup whose coordinate is an entry; linear filter; clamping. */
static enum piglit_result
table(void *data)
{
	static const float texels[4][4] = {
		{ 0, 8, 0, 0 }, { 1, 4, 0, 0 }, { 2, 2, 0, 0 }, { 3, 1, 0, 0 }
	};
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	GLuint tex = make_texture(GL_TEXTURE_1D, 4, 1, 1, texels[0]);
	bool pass;

	glTexParameteri(GL_TEXTURE_1D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
	glTexParameteri(GL_TEXTURE_1D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
	glTexParameteri(GL_TEXTURE_1D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
	kb_program("TEMP t;\nTEX t, kbuffer[0], texture[0], 1D;\n"
		   "MOV result.kbuffer[0].xy, t;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_fill(&kb, 0, .5, 0, 0, 0);
	kb_draw(&kb);
	/* Half way between the texels 1 and 2; weights have 8 bits at least. */
	pass = kb_expect(&kb, 0, 2 / 256., 1.5, 3, 0, 0);
	kb_draw(&kb);
	/* 1.5: beyond the end. */
	pass = kb_expect(&kb, 0, 0, 3, 1, 0, 0) && pass;
	glDeleteTextures(1, &tex);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** TXP divides by q; TXB shifts the level of detail, which is 0 before. */
static enum piglit_result
projection_and_bias(void *data)
{
	static const float base[4][4] = {
		{ 1, 1, 1, 1 }, { 2, 2, 2, 2 }, { 3, 3, 3, 3 }, { 4, 4, 4, 4 }
	}, small[4] = { 9, 9, 9, 9 };
	struct kb kb = kb_create(GL_RGBA32F, 2, 0, W, W);
	GLuint tex = make_texture(GL_TEXTURE_2D, 2, 2, 1, base[0]);
	bool pass;

	glTexImage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, 1, 1, 0, GL_RGBA, GL_FLOAT,
		     small);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER,
			GL_NEAREST_MIPMAP_NEAREST);
	kb_program("TEMP t;\nTXP t, { 3, 1, 0, 4 }, texture[0], 2D;\n"
		   "MOV result.kbuffer[0], t;\n"
		   "MUL t, fragment.position, 0.5;\nMOV t.w, 10;\n"
		   "TXB t, t, texture[0], 2D;\n"
		   "MOV result.kbuffer[1], t;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, 2, 2, 2, 2);
	pass = kb_expect(&kb, 1, 0, 9, 9, 9, 9) && pass;
	glDeleteTextures(1, &tex);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Minification by the derivatives of window coordinates: one level a step. */
static enum piglit_result
derivatives(void *data)
{
	const float scale = ldexp(1, (int)(intptr_t)data);
	const float level = (int)(intptr_t)data;
	struct kb kb = kb_create(GL_RGBA32F, 1, 0, W, W);
	float texels[16 * 16][4];
	char body[256];
	GLuint tex;
	bool pass;

	glGenTextures(1, &tex);
	glBindTexture(GL_TEXTURE_2D, tex);
	for (int l = 0; l < 5; l++) {
		for (int i = 0; i < 16 * 16 * 4; i++)
			texels[i / 4][i % 4] = l;
		glTexImage2D(GL_TEXTURE_2D, l, GL_RGBA32F, 16 >> l, 16 >> l, 0,
			     GL_RGBA, GL_FLOAT, texels);
	}
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER,
			GL_NEAREST_MIPMAP_NEAREST);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
	/* scale texels a pixel */
	snprintf(body, sizeof(body),
		 "TEMP t;\nMUL t, fragment.position, %g;\n"
		 "TEX t, t, texture[0], 2D;\nMOV result.kbuffer[0], t;",
		 scale / 16);
	kb_program(body);
	glColor4f(9, 9, 9, 9);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	pass = kb_expect(&kb, 0, 0, level, level, level, level);
	glDeleteTextures(1, &tex);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("1d", target, &t1d),
	KB_SUBTEST("2d", target, &t2d),
	KB_SUBTEST("3d", target, &t3d),
	KB_SUBTEST("rect", target, &rectangle),
	KB_SUBTEST("cube", target, &cube),
	KB_SUBTEST("shadow-1d", shadow, GL_TEXTURE_1D),
	KB_SUBTEST("shadow-2d", shadow, GL_TEXTURE_2D),
	KB_SUBTEST("shadow-rect", shadow, GL_TEXTURE_RECTANGLE),
	KB_SUBTEST("with-fragment-stage", with_fragment_stage, NULL),
	KB_SUBTEST("other-target-than-fragment-stage", other_target, NULL),
	KB_SUBTEST("all-units", all_units, NULL),
	KB_SUBTEST("table", table, NULL),
	KB_SUBTEST("projection-and-bias", projection_and_bias, NULL),
	KB_SUBTEST("derivatives-level-0", derivatives, 0),
	KB_SUBTEST("derivatives-level-1", derivatives, 1),
	KB_SUBTEST("derivatives-level-3", derivatives, 3),
	KB_SUBTEST_END
};

KBUFFER_TEST(32)
