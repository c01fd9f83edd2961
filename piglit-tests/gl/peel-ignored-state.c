/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-ignored-state.c
 * State that means nothing while fragments are inserted by rank: the enable of
 * the depth test, depth bounds, blending, the logic op, gl_Layer.
 */

#include "peel-common.h"

#define K 5
#define NUM 12

static struct peel
make(GLenum format)
{
	return peel_create(&(struct peel_shape) {
		K, 16, 12, 0, GL_DEPTH_COMPONENT24, { format } });
}

/** All in random rectangles, the later half in front of the first. */
static enum piglit_result
draw_and_check(struct peel *p)
{
	struct peel_quad quads[NUM];

	peel_seed(21);
	for (int i = 0; i < NUM; i++)
		quads[i] = (struct peel_quad) {
			peel_random(6), peel_random(6), 16 - peel_random(6),
			12 - peel_random(6), (NUM - i / 2) / 16., i
		};
	peel_draw(p, quads, NUM);
	return peel_end(p, peel_check_ranks(p, quads, NUM) && peel_check(p));
}

static enum piglit_result
depth_test(void *data)
{
	struct peel p = make(GL_RGBA8);

	glEnable(GL_DEPTH_TEST);
	return draw_and_check(&p);
}

static enum piglit_result
depth_bounds(void *data)
{
	struct peel p = make(GL_RGBA8);

	if (!piglit_is_extension_supported("GL_EXT_depth_bounds_test")) {
		printf("no depth bounds here\n");
		return peel_end(&p, true) == PIGLIT_PASS ? PIGLIT_SKIP :
			PIGLIT_FAIL;
	}
	glEnable(GL_DEPTH_BOUNDS_TEST_EXT);
	glDepthBoundsEXT(.4, .5);
	return draw_and_check(&p);
}

static enum piglit_result
blend(void *data)
{
	struct peel p = make(*(const GLenum *)data);

	glEnable(GL_BLEND);
	glBlendFunc(GL_SRC_ALPHA, GL_ONE);
	glBlendEquation(GL_FUNC_REVERSE_SUBTRACT);
	return draw_and_check(&p);
}

static enum piglit_result
dual_source(void *data)
{
	struct peel p = make(GL_RGBA8);

	/* The second color is of no output that is peeled. */
	peel_use_program(&p, "layout(location = 0, index = 1) out vec4 second;\n",
			 "second = vec4(.125, .25, .5, .75);\n");
	glEnable(GL_BLEND);
	glBlendFunc(GL_SRC1_COLOR, GL_ONE_MINUS_SRC1_COLOR);
	return draw_and_check(&p);
}

/** With two draw buffers, which dual-source blending itself cannot have. */
static enum piglit_result
dual_source_two_buffers(void *data)
{
	struct peel p = peel_create(&(struct peel_shape) {
		K, 16, 12, 0, GL_DEPTH_COMPONENT24, { GL_RGBA8, GL_R32UI } });

	piglit_require_extension("GL_ARB_blend_func_extended");
	glEnable(GL_BLEND);
	glBlendFunc(GL_SRC1_COLOR, GL_ONE_MINUS_SRC1_COLOR);
	return draw_and_check(&p);
}

/** Where there is a second draw buffer, the second color is not its color. */
static enum piglit_result
second_source_is_no_output(void *data)
{
	struct peel p = peel_create(&(struct peel_shape) {
		K, 16, 12, 0, GL_DEPTH_COMPONENT24, { GL_RGBA8, GL_RGBA8 } });
	uint32_t *color;
	bool pass = true;

	piglit_require_extension("GL_ARB_blend_func_extended");
	kb_use_glsl("#version 150 compatibility\n"
		    "void main() { gl_Position = gl_Vertex; }\n", NULL,
		    "#version 150 compatibility\n"
		    "#extension GL_ARB_explicit_attrib_location: require\n"
		    "layout(location = 0, index = 0) out vec4 a;\n"
		    "layout(location = 0, index = 1) out vec4 b;\n"
		    "void main() { a = vec4(1, 1, 0, 0); b = vec4(.2); }\n");
	glRectf(-1, -1, 1, 1);
	for (int a = 0; a < 2; a++) {
		const uint32_t expected[2][4] = { { 255, 255, 0, 0 },
						  { 0, 0, 0, 255 } };

		color = peel_read_color(&p, a);
		for (int i = 0; i < 16 * 12 && pass; i++) {
			pass = memcmp(color + 4 * i, expected[a], 16) == 0;
			if (!pass)
				printf("attachment %d: %u %u %u %u\n", a,
				       color[4 * i], color[4 * i + 1],
				       color[4 * i + 2], color[4 * i + 3]);
		}
		free(color);
	}
	return peel_end(&p, pass);
}

/** By a shader that was not made for it, and one that was. */
static enum piglit_result
advanced(void *data)
{
	struct peel p = peel_create(&(struct peel_shape) {
		K, 16, 12, 0, GL_DEPTH_COMPONENT24, { GL_RGBA8, GL_RGBA8 } });
	static const int one[1] = { 0 };
	enum piglit_result result;

	if (!piglit_is_extension_supported("GL_KHR_blend_equation_advanced")) {
		printf("no advanced blending here\n");
		return peel_end(&p, true) == PIGLIT_PASS ? PIGLIT_SKIP :
			PIGLIT_FAIL;
	}
	glEnable(GL_BLEND);
	glBlendEquation(GL_MULTIPLY_KHR);
	result = draw_and_check(&p);

	p = make(GL_RGBA8);
	peel_draw_buffers(&p, 1, one);
	peel_use_program(&p, "#extension GL_KHR_blend_equation_advanced: "
			 "require\nlayout(blend_support_multiply) out;\n", "");
	return draw_and_check(&p) == PIGLIT_PASS ? result : PIGLIT_FAIL;
}

static enum piglit_result
logic_op(void *data)
{
	struct peel p = make(GL_RGBA8);

	glEnable(GL_COLOR_LOGIC_OP);
	glLogicOp(GL_XOR);
	return draw_and_check(&p);
}

static enum piglit_result
stencil_state(void *data)
{
	struct peel p = peel_create(&(struct peel_shape) {
		K, 16, 12, 0, GL_DEPTH24_STENCIL8, { GL_RGBA8 } });

	glStencilFunc(GL_NEVER, 3, ~0);
	glStencilOp(GL_INVERT, GL_INVERT, GL_INVERT);
	return draw_and_check(&p);
}

/** A geometry shader sends the fragments to layers; they go by rank. */
static enum piglit_result
layer(void *data)
{
	struct peel p = make(GL_R32UI);
	struct peel_quad quads[NUM];
	bool pass;

	kb_use_glsl("#version 150 compatibility\n"
		    "void main() { gl_Position = gl_Vertex; }\n",
		    "#version 150 compatibility\n"
		    "layout(triangles) in;\n"
		    "layout(triangle_strip, max_vertices = 3) out;\n"
		    "uniform int layer;\n"
		    "void main() {\n"
		    "  for (int i = 0; i < 3; i++) {\n"
		    "    gl_Layer = layer;\n"
		    "    gl_Position = gl_in[i].gl_Position;\n"
		    "    EmitVertex();\n"
		    "  }\n"
		    "}\n",
		    "#version 150 compatibility\n"
		    "uniform uint code;\nout uvec4 o;\n"
		    "void main() { o = uvec4(code); }\n");
	GLint program;
	glGetIntegerv(GL_CURRENT_PROGRAM, &program);
	for (int i = 0; i < NUM; i++) {
		quads[i] = peel_full(&p, peel_depth(p.depth, 1 + i * 7 % NUM),
				     i);
		glUniform1i(glGetUniformLocation(program, "layer"), i % K);
		glUniform1ui(glGetUniformLocation(program, "code"),
			     peel_color_code(p.color[0], 0, 0, i));
		glBegin(GL_TRIANGLES);
		glVertex3f(-1, -1, quads[i].z);
		glVertex3f(3, -1, quads[i].z);
		glVertex3f(-1, 3, quads[i].z);
		glEnd();
		peel_draw_model(&p, &quads[i], 1);
	}
	pass = peel_check_ranks(&p, quads, NUM) && peel_check(&p);
	return peel_end(&p, pass);
}

static const GLenum rgba8 = GL_RGBA8, rgba32f = GL_RGBA32F;

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("depth-test", depth_test, NULL),
	KB_SUBTEST("depth-bounds", depth_bounds, NULL),
	KB_SUBTEST("blend", blend, &rgba8),
	KB_SUBTEST("blend-float", blend, &rgba32f),
	KB_SUBTEST("dual-source", dual_source, NULL),
	KB_SUBTEST("dual-source-two-buffers", dual_source_two_buffers, NULL),
	KB_SUBTEST("second-source-is-no-output", second_source_is_no_output,
		   NULL),
	KB_SUBTEST("advanced", advanced, NULL),
	KB_SUBTEST("logic-op", logic_op, NULL),
	KB_SUBTEST("stencil-state", stencil_state, NULL),
	KB_SUBTEST("layer", layer, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
