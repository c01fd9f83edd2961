/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-draw-messages.c
 * A draw that is an error with GL_DEPTH_PEELING_MESA enabled says by KHR_debug
 * which rule it breaks, whatever kind of draw it is, and so does
 * FramebufferParameteri.
 */

#include "kbuffer-messages.h"
#include "peel-common.h"

#define W KB_COMMAND_SIZE
#define LAYERS 4

static struct peel
make(int layers)
{
	return peel_create(&(struct peel_shape) {
		layers, W, W, 0, GL_DEPTH_COMPONENT32F, { GL_RGBA8 } });
}

static void
set_first_layer(int layer)
{
	glFramebufferParameteri(GL_FRAMEBUFFER,
				GL_DEPTH_PEELING_FIRST_LAYER_MESA, layer);
}

/** A state in which all draws are the error of the text. */
struct bad {
	const char *text;
	void (*change)(const struct peel *p);
};

static enum piglit_result
state(void *data)
{
	const struct bad *bad = data;
	struct peel p = make(LAYERS);
	bool pass;

	bad->change(&p);
	glUseProgram(0);
	kb_collect_messages();
	pass = kb_expect_message_of_draws(bad->text);
	kb_stop_messages();
	return peel_end(&p, pass);
}

/** Attach the textures of another framebuffer, which stay alive. */
static void
attach_color(const struct peel *from)
{
	glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
			     from->color_tex[0], 0);
}

static void
attach_depth(const struct peel *from)
{
	glFramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT,
			     from->depth_tex, 0);
}

static void
no_depth(const struct peel *p)
{
	glFramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, 0, 0);
}

static void
color_3d(const struct peel *p)
{
	const GLuint tex = kb_new_texture();

	glBindTexture(GL_TEXTURE_3D, tex);
	glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA8, W, W, LAYERS, 0, GL_RGBA,
		     GL_FLOAT, NULL);
	glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	no_depth(p);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, tex, 0);
}

static void
more_layers(const struct peel *p)
{
	struct peel other = make(LAYERS + 1);

	glBindFramebuffer(GL_FRAMEBUFFER, p->fbo);
	attach_color(&other);
	peel_end(&other, true);
}

static void
always(const struct peel *p)
{
	glDepthFunc(GL_ALWAYS);
}

static void
stencil_test(const struct peel *p)
{
	glEnable(GL_STENCIL_TEST);
}

static void
kbuffer_program(const struct peel *p)
{
	piglit_require_extension("GL_MESA_kbuffer_program");
	kb_program("MOV result.kbuffer[0], 1;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
}

static void
continued_lequal(const struct peel *p)
{
	glDepthFunc(GL_LEQUAL);
	set_first_layer(LAYERS);
}

static void
other_func(const struct peel *p)
{
	set_first_layer(LAYERS);
	glDepthFunc(GL_GREATER);
}

static void
attach_other(const struct peel *p, const struct peel_shape *shape)
{
	struct peel other;

	set_first_layer(LAYERS);
	other = peel_create(shape);
	glBindFramebuffer(GL_FRAMEBUFFER, p->fbo);
	attach_color(&other);
	attach_depth(&other);
	peel_end(&other, true);
}

static void
other_size(const struct peel *p)
{
	attach_other(p, &(struct peel_shape) {
		LAYERS, 2 * W, W, 0, GL_DEPTH_COMPONENT32F, { GL_RGBA8 } });
}

static void
other_format(const struct peel *p)
{
	attach_other(p, &(struct peel_shape) {
		LAYERS, W, W, 0, GL_DEPTH_COMPONENT16, { GL_RGBA8 } });
}

static void
other_layers(const struct peel *p)
{
	attach_other(p, &(struct peel_shape) {
		LAYERS - 1, W, W, 0, GL_DEPTH_COMPONENT32F, { GL_RGBA8 } });
}

/** Setting FIRST_LAYER says as much. */
static enum piglit_result
first_layer(void *data)
{
	struct peel p = make(LAYERS);
	bool pass;

	kb_collect_messages();
	set_first_layer(3);
	pass = kb_expect_message(GL_INVALID_VALUE, "layer=3, 4 layers at 0");
	set_first_layer(LAYERS);
	glDepthFunc(GL_GREATER);
	set_first_layer(2 * LAYERS);
	pass = kb_expect_message(GL_INVALID_OPERATION,
				 "(depth peeling from layer 4 on: glDepthFunc "
				 "has changed since that was set)") && pass;
	set_first_layer(0);
	no_depth(&p);
	set_first_layer(LAYERS);
	pass = kb_expect_message(GL_INVALID_OPERATION, "(depth peeling without "
				 "a layered 2D array as depth attachment)") &&
		pass;
	kb_stop_messages();
	return peel_end(&p, pass);
}

#define BAD(name, change, text) \
	KB_SUBTEST(name, state, (&(struct bad) { "(depth peeling " text ")", \
						 change }))

const struct piglit_subtest kbuffer_subtests[] = {
	BAD("no-depth", no_depth,
	    "without a layered 2D array as depth attachment"),
	BAD("color-3d", color_3d,
	    "without a layered 2D array as depth attachment"),
	BAD("more-color-layers", more_layers,
	    "with 4 layers of depth and 5 in draw buffer 0"),
	BAD("always", always, "with glDepthFunc(GL_ALWAYS)"),
	BAD("stencil-test", stencil_test, "with GL_STENCIL_TEST"),
	BAD("kbuffer-program", kbuffer_program, "with GL_KBUFFER_PROGRAM_MESA"),
	BAD("continued-lequal", continued_lequal,
	    "from layer 4 on with glDepthFunc(GL_LEQUAL)"),
	BAD("other-depth-func", other_func, "from layer 4 on: glDepthFunc has "
	    "changed since that was set"),
	BAD("other-size", other_size, "from layer 4 on: the size of the depth "
	    "attachment has changed since that was set"),
	BAD("other-format", other_format, "from layer 4 on: the format of the "
	    "depth attachment has changed since that was set"),
	BAD("other-layers", other_layers, "from layer 4 on: the number of "
	    "layers has changed since that was set"),
	KB_SUBTEST("first-layer", first_layer, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
