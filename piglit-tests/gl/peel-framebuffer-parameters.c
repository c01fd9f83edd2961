/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-framebuffer-parameters.c
 * GL_DEPTH_PEELING_FIRST_LAYER_MESA and GL_DEPTH_PEELING_OVERFLOW_MESA: their
 * values, who may set what, by all commands; an error changes nothing.
 */

#include "peel-common.h"

#define FIRST GL_DEPTH_PEELING_FIRST_LAYER_MESA
#define OVERFLOW GL_DEPTH_PEELING_OVERFLOW_MESA
#define LAYERS 4

static void
set(int first)
{
	glFramebufferParameteri(GL_FRAMEBUFFER, FIRST, first);
}

static bool
check(GLenum pname, int wanted)
{
	const int value = peel_get(pname);

	if (value == wanted)
		return piglit_check_gl_error(GL_NO_ERROR);
	printf("%s is %d, expected %d\n",
	       pname == FIRST ? "first layer" : "overflow", value, wanted);
	return false;
}

/** Twice as many fragments as there are layers, everywhere. */
static void
draw_scene(struct peel *p)
{
	for (int i = 0; i < 2 * p->layers; i++) {
		const struct peel_quad q =
			peel_full(p, 1 - (i + 1) / 64.f, i + 1);

		peel_draw(p, &q, 1);
	}
}

/** A framebuffer that has overflowed. */
static struct peel
make(void)
{
	struct peel p = peel_simple(LAYERS);

	draw_scene(&p);
	return p;
}

/**
 * Setting gives the error and changes nothing: not the value, not the
 * overflow, not the layers.
 */
static bool
check_refused(struct peel *p, int param, GLenum error)
{
	const int first = peel_get(FIRST), overflow = peel_get(OVERFLOW);

	set(param);
	if (!piglit_check_gl_error(error)) {
		printf("by setting %d at %d\n", param, first);
		return false;
	}
	return check(FIRST, first) && check(OVERFLOW, overflow) &&
		peel_check_layers(p);
}

/** The framebuffer goes on as if nothing had been tried. */
static bool
check_unharmed(struct peel *p)
{
	bool pass = peel_check(p);

	peel_next(p);
	draw_scene(p);
	return check(FIRST, p->model.rank) && peel_check(p) && pass;
}

static enum piglit_result
initial(void *data)
{
	const GLuint fbo = kb_new_framebuffer();
	bool pass;

	/* Without an attachment, then with some, never drawn to. */
	glBindFramebuffer(GL_FRAMEBUFFER, fbo);
	pass = check(FIRST, 0);
	pass = check(OVERFLOW, 0) && pass;
	struct peel p = peel_simple(LAYERS);
	pass = check(FIRST, 0) && pass;
	pass = check(OVERFLOW, 0) && pass;
	return peel_end(&p, pass);
}

static enum piglit_result
values(void *data)
{
	struct peel p = make();
	bool pass = check(OVERFLOW, 1);

	peel_next(&p);
	pass = check(FIRST, LAYERS) && pass;
	pass = check(OVERFLOW, 0) && pass;
	draw_scene(&p);
	pass = check(OVERFLOW, 0) && peel_check(&p) && pass;
	peel_next(&p);
	pass = check(FIRST, 2 * LAYERS) && pass;
	draw_scene(&p);
	pass = check(OVERFLOW, 0) && peel_check(&p) && pass;
	peel_restart(&p);
	pass = check(FIRST, 0) && pass;
	draw_scene(&p);
	pass = check(OVERFLOW, 1) && peel_check(&p) && pass;

	/* Clears do not change them; setting 0 again clears the overflow. */
	peel_clear(&p);
	pass = check(OVERFLOW, 1) && pass;
	set(0);
	pass = check(OVERFLOW, 0) && pass;

	/* Setting leaves the layers as they are. */
	peel_restart(&p);
	draw_scene(&p);
	set(LAYERS);
	pass = peel_check_layers(&p) && pass;
	return peel_end(&p, pass);
}

static enum piglit_result
invalid_values(void *data)
{
	static const int bad[] = {
		-1, -LAYERS, INT_MIN, 1, LAYERS - 1, LAYERS + 1, 2 * LAYERS,
		3 * LAYERS, INT_MAX, INT_MAX - LAYERS + 1
	};
	struct peel p = make();
	bool pass = true;

	for (int i = 0; i < ARRAY_SIZE(bad); i++)
		pass = check_refused(&p, bad[i], GL_INVALID_VALUE) && pass;
	pass = check_unharmed(&p) && pass;

	/* With LAYERS its own value is one of them. */
	for (int i = 0; i < ARRAY_SIZE(bad); i++) {
		const int value = bad[i] == 2 * LAYERS ? LAYERS : bad[i];

		pass = check_refused(&p, value, GL_INVALID_VALUE) && pass;
	}
	pass = check_unharmed(&p) && pass;
	return peel_end(&p, pass);
}

static enum piglit_result
overflow_is_read_only(void *data)
{
	struct peel p = make();
	bool pass = true;

	for (int value = 0; value < 2; value++) {
		glFramebufferParameteri(GL_FRAMEBUFFER, OVERFLOW, value);
		pass = piglit_check_gl_error(GL_INVALID_ENUM) && pass;
		pass = check(OVERFLOW, 1) && pass;
	}
	pass = check_unharmed(&p) && pass;
	return peel_end(&p, pass);
}

static enum piglit_result
default_framebuffer(void *data)
{
	const GLenum error = GL_INVALID_OPERATION;
	GLint value = 7;
	bool pass = true;

	/* Not piglit_winsys_fbo, which may be a framebuffer object. */
	glBindFramebuffer(GL_FRAMEBUFFER, 0);
	glGetFramebufferParameteriv(GL_FRAMEBUFFER, FIRST, &value);
	pass = piglit_check_gl_error(error) && pass;
	glGetFramebufferParameteriv(GL_READ_FRAMEBUFFER, OVERFLOW, &value);
	pass = piglit_check_gl_error(error) && pass;
	set(0);
	pass = piglit_check_gl_error(error) && pass;
	set(4);
	pass = piglit_check_gl_error(error) && pass;
	return pass && value == 7 ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
bad_target(void *data)
{
	struct peel p = make();
	GLint value = 7;
	bool pass;

	glFramebufferParameteri(GL_TEXTURE_2D, FIRST, LAYERS);
	pass = piglit_check_gl_error(GL_INVALID_ENUM);
	glGetFramebufferParameteriv(GL_TEXTURE_2D, OVERFLOW, &value);
	pass = piglit_check_gl_error(GL_INVALID_ENUM) && value == 7 && pass;
	pass = check_unharmed(&p) && pass;
	return peel_end(&p, pass);
}

/** Attach a new texture of any target, or NULL data. */
static GLuint
texture(GLenum target, GLenum attachment, GLenum internal, GLenum format)
{
	const GLuint tex = kb_new_texture();

	glBindTexture(target, tex);
	switch (target) {
	case GL_TEXTURE_2D:
	case GL_TEXTURE_1D_ARRAY:
		glTexImage2D(target, 0, internal, 16, 16, 0, format, GL_FLOAT,
			     NULL);
		break;
	case GL_TEXTURE_CUBE_MAP:
		for (int i = 0; i < 6; i++)
			glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + i, 0,
				     internal, 16, 16, 0, format, GL_FLOAT,
				     NULL);
		break;
	default:
		glTexImage3D(target, 0, internal, 16, 16, 4, 0, format,
			     GL_FLOAT, NULL);
	}
	glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	glFramebufferTexture(GL_FRAMEBUFFER, attachment, tex, 0);
	glBindTexture(target, 0);
	return tex;
}

static void
detach_all(void)
{
	glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, 0, 0);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, 0, 0);
}

static void
no_depth(struct peel *p)
{
	glFramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, 0, 0);
}

static void
depth_2d(struct peel *p)
{
	detach_all();
	texture(GL_TEXTURE_2D, GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT32F,
		GL_DEPTH_COMPONENT);
}

static void
depth_1d_array(struct peel *p)
{
	detach_all();
	texture(GL_TEXTURE_1D_ARRAY, GL_DEPTH_ATTACHMENT,
		GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT);
}

static void
depth_cube(struct peel *p)
{
	detach_all();
	texture(GL_TEXTURE_CUBE_MAP, GL_DEPTH_ATTACHMENT,
		GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT);
}

static void
depth_one_layer(struct peel *p)
{
	detach_all();
	glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT,
				  p->depth_tex, 0, 1);
}

/** Deleting the renderbuffer of a bound framebuffer would detach it. */
static GLuint renderbuffer;

static void
depth_renderbuffer(struct peel *p)
{
	detach_all();
	glDeleteRenderbuffers(1, &renderbuffer);
	glGenRenderbuffers(1, &renderbuffer);
	glBindRenderbuffer(GL_RENDERBUFFER, renderbuffer);
	glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, 16, 16);
	glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT,
				  GL_RENDERBUFFER, renderbuffer);
}

/** Not complete: a layered and an unlayered attachment. */
static void
incomplete(struct peel *p)
{
	texture(GL_TEXTURE_2D, GL_COLOR_ATTACHMENT1, GL_RGBA8, GL_RGBA);
}

/** Whatever is unsuitable is refused; 0 can be set all the same. */
static enum piglit_result
unsuitable(void *data)
{
	void (*const change)(struct peel *) = data;
	struct peel p = make();
	bool pass;

	change(&p);
	pass = check_refused(&p, LAYERS, GL_INVALID_OPERATION);
	pass = check_refused(&p, 1, GL_INVALID_OPERATION) && pass;
	pass = check_refused(&p, -1, GL_INVALID_VALUE) && pass;

	/* The original attachments: as if nothing had been. */
	glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
			     p.color_tex[0], 0);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, 0, 0);
	glFramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT,
			     p.depth_tex, 0);
	pass = check_unharmed(&p) && pass;

	change(&p);
	set(0);
	pass = check(FIRST, 0) && check(OVERFLOW, 0) && pass;
	return peel_end(&p, pass);
}

/** The step is the number of layers of the depth attachment. */
static enum piglit_result
step(void *data)
{
	bool pass = true;

	for (int layers = 1; layers < 8; layers += 2) {
		struct peel p = peel_simple(layers);

		draw_scene(&p);
		for (int i = 0; i < 4; i++) {
			pass = check_refused(&p, (i + 1) * layers + 1,
					     GL_INVALID_VALUE) && pass;
			pass = check_unharmed(&p) && pass;
			pass = check(FIRST, (i + 1) * layers) && pass;
		}
		peel_end(&p, pass);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** A framebuffer that nothing was drawn to has no more behind its layers. */
static enum piglit_result
without_contents(void *data)
{
	struct peel p = peel_simple(LAYERS);
	bool pass;

	peel_next(&p);
	pass = check(FIRST, LAYERS);
	draw_scene(&p);
	pass = peel_check(&p) && pass;
	peel_restart(&p);
	draw_scene(&p);
	pass = peel_check(&p) && pass;
	return peel_end(&p, pass);
}

/** Each framebuffer has its own values, also as the read framebuffer. */
static enum piglit_result
per_framebuffer(void *data)
{
	struct peel a = make(), b = peel_simple(LAYERS);
	bool pass = check(OVERFLOW, 0);

	/* Bound for reading while the other one is drawn to. */
	glBindFramebuffer(GL_READ_FRAMEBUFFER, a.fbo);
	glFramebufferParameteri(GL_READ_FRAMEBUFFER, FIRST, LAYERS);
	pass = piglit_check_gl_error(GL_NO_ERROR) && pass;
	pass = check(FIRST, 0) && pass;
	draw_scene(&b);
	pass = peel_check(&b) && pass;

	/* It took the bound of its own layers. */
	glBindFramebuffer(GL_FRAMEBUFFER, a.fbo);
	pass = check(FIRST, LAYERS) && check(OVERFLOW, 0) && pass;
	set(0);
	draw_scene(&a);
	glBindFramebuffer(GL_FRAMEBUFFER, b.fbo);
	glBindFramebuffer(GL_READ_FRAMEBUFFER, a.fbo);
	peel_restart(&b);
	glBindFramebuffer(GL_FRAMEBUFFER, a.fbo);
	peel_restart(&a);
	draw_scene(&a);
	peel_next(&a);
	draw_scene(&a);
	pass = peel_check(&a) && pass;
	pass = check(FIRST, LAYERS) && pass;
	glBindFramebuffer(GL_FRAMEBUFFER, b.fbo);
	pass = check(FIRST, 0) && check(OVERFLOW, 0) && pass;
	peel_end(&a, pass);
	return peel_end(&b, pass);
}

/** The named commands do the same to a framebuffer that is not bound. */
static enum piglit_result
named(void *data)
{
	const bool ext = data;
	struct peel p;
	GLint value = 7;
	bool pass;

	piglit_require_extension(ext ? "GL_EXT_direct_state_access" :
				 "GL_ARB_direct_state_access");
	void (*const set_named)(GLuint, GLenum, GLint) = (void *)
		(ext ? glNamedFramebufferParameteriEXT :
		 glNamedFramebufferParameteri);
	void (*const get_named)(GLuint, GLenum, GLint *) = (void *)
		(ext ? glGetNamedFramebufferParameterivEXT :
		 glGetNamedFramebufferParameteriv);

	p = make();
	glBindFramebuffer(GL_FRAMEBUFFER, piglit_winsys_fbo);
	get_named(p.fbo, OVERFLOW, &value);
	pass = piglit_check_gl_error(GL_NO_ERROR) && value == 1;
	set_named(p.fbo, OVERFLOW, 0);
	pass = piglit_check_gl_error(GL_INVALID_ENUM) && pass;
	set_named(p.fbo, FIRST, 3);
	pass = piglit_check_gl_error(GL_INVALID_VALUE) && pass;
	set_named(p.fbo, FIRST, LAYERS);
	pass = piglit_check_gl_error(GL_NO_ERROR) && pass;
	get_named(p.fbo, FIRST, &value);
	pass = value == LAYERS && pass;
	get_named(p.fbo, OVERFLOW, &value);
	pass = value == 0 && pass;

	/* The default framebuffer has none. */
	if (!ext) {
		value = 7;
		set_named(0, FIRST, 0);
		pass = piglit_check_gl_error(GL_INVALID_OPERATION) && pass;
		get_named(0, OVERFLOW, &value);
		pass = piglit_check_gl_error(GL_INVALID_OPERATION) &&
			value == 7 && pass;
	}

	/* The bound is there: the next layers follow. */
	glBindFramebuffer(GL_FRAMEBUFFER, p.fbo);
	p.model.rank = 0;
	set(0);
	peel_restart(&p);
	draw_scene(&p);
	glBindFramebuffer(GL_FRAMEBUFFER, piglit_winsys_fbo);
	set_named(p.fbo, FIRST, LAYERS);
	glBindFramebuffer(GL_FRAMEBUFFER, p.fbo);
	pass = check(FIRST, LAYERS) && pass;
	glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
	for (int i = 0; i < 2 * LAYERS; i++) {
		const struct peel_quad q =
			peel_full(&p, 1 - (i + 1) / 64.f, i + 1);

		peel_draw_gl(&p, &q, 1);
	}
	uint32_t *depths = peel_read_depth(&p);
	for (int i = 0; i < LAYERS; i++) {
		const uint32_t want = peel_depth_code(p.depth,
						      1 - (LAYERS - i) / 64.f);

		if (depths[i * p.width * p.height] != want) {
			printf("layer %d: %08x, expected %08x\n", i,
			       depths[i * p.width * p.height], want);
			pass = false;
		}
	}
	free(depths);
	return peel_end(&p, pass);
}

/** A deleted framebuffer's name begins anew. */
static enum piglit_result
deleted(void *data)
{
	struct peel p = make();
	bool pass;

	peel_next(&p);
	glDeleteFramebuffers(1, &p.fbo);
	glBindFramebuffer(GL_FRAMEBUFFER, p.fbo);
	pass = check(FIRST, 0);
	pass = check(OVERFLOW, 0) && pass;
	return peel_end(&p, pass);
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("initial", initial, NULL),
	KB_SUBTEST("values", values, NULL),
	KB_SUBTEST("invalid-values", invalid_values, NULL),
	KB_SUBTEST("overflow-is-read-only", overflow_is_read_only, NULL),
	KB_SUBTEST("default-framebuffer", default_framebuffer, NULL),
	KB_SUBTEST("bad-target", bad_target, NULL),
	KB_SUBTEST("no-depth", unsuitable, no_depth),
	KB_SUBTEST("depth-2d", unsuitable, depth_2d),
	KB_SUBTEST("depth-1d-array", unsuitable, depth_1d_array),
	KB_SUBTEST("depth-cube", unsuitable, depth_cube),
	KB_SUBTEST("depth-one-layer", unsuitable, depth_one_layer),
	KB_SUBTEST("depth-renderbuffer", unsuitable, depth_renderbuffer),
	KB_SUBTEST("incomplete", unsuitable, incomplete),
	KB_SUBTEST("step", step, NULL),
	KB_SUBTEST("without-contents", without_contents, NULL),
	KB_SUBTEST("per-framebuffer", per_framebuffer, NULL),
	KB_SUBTEST("named", named, NULL),
	KB_SUBTEST("named-ext", named, true),
	KB_SUBTEST("deleted", deleted, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
