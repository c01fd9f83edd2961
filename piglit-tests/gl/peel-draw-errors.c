/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-draw-errors.c
 * Each state in which drawing with GL_DEPTH_PEELING_MESA enabled is an error,
 * by each kind of draw command: the right error, nothing drawn, no overflow;
 * and when the state is mended, the drawing goes on as if nothing had been.
 */

#include "peel-common.h"

#define W KB_COMMAND_SIZE
#define LAYERS 4

/** The scene of this file: more fragments than layers, two of each depth. */
static void
draw_scene(struct peel *p)
{
	glUseProgram(p->program);
	for (int i = 0; i < 10; i++) {
		const struct peel_quad q =
			peel_full(p, 1 - (i / 2 + 1) / 16.f, i + 1);

		peel_draw(p, &q, 1);
	}
}

/** A framebuffer that has been peeled into, but has not overflowed. */
static struct peel
make_with(int layers, int samples, GLenum depth, GLenum color)
{
	struct peel p = peel_create(&(struct peel_shape) {
		layers, W, W, samples, depth, { color } });
	const struct peel_quad q = peel_full(&p, .75f, 99);

	peel_draw(&p, &q, 1);
	return p;
}

static struct peel
make(void)
{
	return make_with(LAYERS, 0, GL_DEPTH_COMPONENT32F, GL_RGBA8);
}

/** All draw commands give the error and leave all layers as they are. */
static bool
check_refused(const struct peel *p, GLenum error)
{
	bool pass = true;

	/* Nearer than everything. */
	glUseProgram(0);
	glColor4f(1, 1, 1, 1);
	for (int i = 0; i < KB_NUM_COMMANDS; i++) {
		/* Mesa's DrawPixels and Bitmap have their own for this. */
		const bool pixels = kb_commands[i].is_pixels;
		const GLenum wanted = pixels &&
			error == GL_INVALID_FRAMEBUFFER_OPERATION ?
			GL_INVALID_OPERATION : error;

		kb_commands[i].draw();
		if (!piglit_check_gl_error(wanted)) {
			printf("by %s\n", kb_commands[i].name);
			pass = false;
		}
		if (!peel_check_layers(p)) {
			printf("%s has drawn\n", kb_commands[i].name);
			return false;
		}
	}
	return pass;
}

/** The framebuffer is as it was: this pass, and the next two. */
static bool
check_unharmed(struct peel *p)
{
	bool pass = peel_check(p);

	draw_scene(p);
	pass = peel_check(p) && pass;
	for (int i = 0; i < 2; i++) {
		peel_next(p);
		draw_scene(p);
		pass = peel_check(p) && pass;
	}
	return pass;
}

static void
attach(GLenum attachment, GLuint tex)
{
	glFramebufferTexture(GL_FRAMEBUFFER, attachment, tex, 0);
}

/** A texture of any target, its contents undefined. */
static GLuint
texture(GLenum target, GLenum internal, GLenum format, int layers)
{
	const GLuint tex = kb_new_texture();

	glBindTexture(target, tex);
	switch (target) {
	case GL_TEXTURE_2D:
		glTexImage2D(target, 0, internal, W, W, 0, format, GL_FLOAT,
			     NULL);
		break;
	case GL_TEXTURE_1D_ARRAY:
		glTexImage2D(target, 0, internal, W, layers, 0, format,
			     GL_FLOAT, NULL);
		break;
	case GL_TEXTURE_CUBE_MAP:
		for (int i = 0; i < 6; i++)
			glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + i, 0,
				     internal, W, W, 0, format, GL_FLOAT,
				     NULL);
		break;
	default:
		glTexImage3D(target, 0, internal, W, W, layers, 0, format,
			     GL_FLOAT, NULL);
	}
	glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	glBindTexture(target, 0);
	return tex;
}

static GLuint
color_texture(GLenum target, int layers)
{
	return texture(target, GL_RGBA8, GL_RGBA, layers);
}

static GLuint
depth_texture(GLenum target, int layers)
{
	return texture(target, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT,
		       layers);
}

/** A state: how it is made, and what error it is. */
struct bad {
	void (*change)(void);
	GLenum error;
};

static void
no_depth(void)
{
	attach(GL_DEPTH_ATTACHMENT, 0);
}

static void
no_attachment_but(GLuint depth)
{
	attach(GL_COLOR_ATTACHMENT0, 0);
	attach(GL_DEPTH_ATTACHMENT, depth);
}

static void
depth_2d(void)
{
	no_attachment_but(depth_texture(GL_TEXTURE_2D, 1));
}

static void
depth_1d_array(void)
{
	no_attachment_but(depth_texture(GL_TEXTURE_1D_ARRAY, LAYERS));
}

static void
depth_cube(void)
{
	no_attachment_but(depth_texture(GL_TEXTURE_CUBE_MAP, 6));
}

static void
depth_cube_array(void)
{
	piglit_require_extension("GL_ARB_texture_cube_map_array");
	no_attachment_but(depth_texture(GL_TEXTURE_CUBE_MAP_ARRAY, 12));
}

/** Deleted by mend(): the one of a bound framebuffer would be detached. */
static GLuint renderbuffer;

static void
attach_renderbuffer(GLenum attachment, GLenum format)
{
	glGenRenderbuffers(1, &renderbuffer);
	glBindRenderbuffer(GL_RENDERBUFFER, renderbuffer);
	glRenderbufferStorage(GL_RENDERBUFFER, format, W, W);
	glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER,
				  renderbuffer);
}

static void
depth_renderbuffer(void)
{
	no_attachment_but(0);
	attach_renderbuffer(GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT24);
}

/** One layer of each array: a framebuffer that is not layered. */
static void
single_layers(void)
{
	glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
				  color_texture(GL_TEXTURE_2D_ARRAY, LAYERS),
				  0, 1);
	glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT,
				  depth_texture(GL_TEXTURE_2D_ARRAY, LAYERS),
				  0, 1);
}

/** Arrays of one layer, attached as such. */
static void
single_layer_arrays(void)
{
	glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
				  color_texture(GL_TEXTURE_2D_ARRAY, 1), 0, 0);
	glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT,
				  depth_texture(GL_TEXTURE_2D_ARRAY, 1), 0, 0);
}

static void
color_3d(void)
{
	attach(GL_COLOR_ATTACHMENT0, color_texture(GL_TEXTURE_3D, LAYERS));
}

static void
color_3d_only(void)
{
	color_3d();
	no_depth();
}

static void
color_cube(void)
{
	attach(GL_COLOR_ATTACHMENT0, color_texture(GL_TEXTURE_CUBE_MAP, 6));
}

static void
color_2d(void)
{
	attach(GL_COLOR_ATTACHMENT0, color_texture(GL_TEXTURE_2D, 1));
}

static void
color_renderbuffer(void)
{
	attach_renderbuffer(GL_COLOR_ATTACHMENT0, GL_RGBA8);
}

static void
fewer_color_layers(void)
{
	attach(GL_COLOR_ATTACHMENT0,
	       color_texture(GL_TEXTURE_2D_ARRAY, LAYERS - 1));
}

static void
more_color_layers(void)
{
	attach(GL_COLOR_ATTACHMENT0,
	       color_texture(GL_TEXTURE_2D_ARRAY, LAYERS + 1));
}

static void
second_color_layers(void)
{
	attach(GL_COLOR_ATTACHMENT1,
	       color_texture(GL_TEXTURE_2D_ARRAY, LAYERS + 1));
	glDrawBuffers(2, (GLenum[]) { GL_COLOR_ATTACHMENT0,
				      GL_COLOR_ATTACHMENT1 });
}

static void
never(void)
{
	glDepthFunc(GL_NEVER);
}

static void
equal(void)
{
	glDepthFunc(GL_EQUAL);
}

static void
notequal(void)
{
	glDepthFunc(GL_NOTEQUAL);
}

static void
always(void)
{
	glDepthFunc(GL_ALWAYS);
}

static void
stencil_test(void)
{
	glEnable(GL_STENCIL_TEST);
}

static void
kbuffer_program(void)
{
	piglit_require_extension("GL_MESA_kbuffer_program");
	kb_program("MOV result.kbuffer[0], 1;");
	glEnable(GL_KBUFFER_PROGRAM_MESA);
}

/** The state of make(). */
static void
mend(const struct peel *p)
{
	attach(GL_COLOR_ATTACHMENT1, 0);
	attach(GL_COLOR_ATTACHMENT0, p->color_tex[0]);
	attach(GL_DEPTH_ATTACHMENT, p->depth_tex);
	glDrawBuffer(GL_COLOR_ATTACHMENT0);
	glDepthFunc(GL_LESS);
	glDisable(GL_STENCIL_TEST);
	glDisable(GL_KBUFFER_PROGRAM_MESA);
	glDeleteRenderbuffers(1, &renderbuffer);
	renderbuffer = 0;
}

/** In the first pass, and in a later one, whose arrivals are counted. */
static enum piglit_result
state(void *data)
{
	const struct bad *bad = data;
	struct peel p = make();
	bool pass = true;

	/* The mended state draws, without and with a refusal before. */
	mend(&p);
	bad->change();
	pass = check_refused(&p, bad->error);
	mend(&p);
	pass = check_unharmed(&p) && pass;

	bad->change();
	pass = check_refused(&p, bad->error) && pass;
	mend(&p);
	pass = check_unharmed(&p) && pass;

	/* With peeling disabled none of these is an error. */
	bad->change();
	glDisable(GL_DEPTH_PEELING_MESA);
	glDisable(GL_KBUFFER_PROGRAM_MESA);
	glUseProgram(0);
	glRectf(-1, -1, 1, 1);
	pass = piglit_check_gl_error(
		bad->error == GL_INVALID_FRAMEBUFFER_OPERATION ?
		bad->error : GL_NO_ERROR) && pass;
	mend(&p);
	return peel_end(&p, pass);
}

static const struct peel_shape other_shapes[] = {
	{ LAYERS, 2 * W, W, 0, GL_DEPTH_COMPONENT32F, { GL_RGBA8 } },
	{ LAYERS, W, W / 2, 0, GL_DEPTH_COMPONENT32F, { GL_RGBA8 } },
	{ LAYERS + 1, W, W, 0, GL_DEPTH_COMPONENT32F, { GL_RGBA8 } },
	{ LAYERS - 1, W, W, 0, GL_DEPTH_COMPONENT32F, { GL_RGBA8 } },
	{ LAYERS, W, W, 0, GL_DEPTH_COMPONENT24, { GL_RGBA8 } },
	{ LAYERS, W, W, 0, GL_DEPTH_COMPONENT16, { GL_RGBA8 } },
	{ LAYERS, W, W, 4, GL_DEPTH_COMPONENT32F, { GL_RGBA8 } },
};

/**
 * Between two passes the attachments are exchanged for others: drawing is an
 * error until FIRST_LAYER is 0 or the old form is back.
 */
static enum piglit_result
exchanged(void *data)
{
	const struct peel_shape *shape = data;
	GLint max_samples;
	bool pass;

	glGetIntegerv(GL_MAX_SAMPLES, &max_samples);
	if (shape->samples > max_samples)
		return PIGLIT_SKIP;

	struct peel p = make();
	struct peel other = peel_create(shape);

	/* Its attachments are what is of interest. */
	other.fbo = p.fbo;
	glBindFramebuffer(GL_FRAMEBUFFER, p.fbo);
	glViewport(0, 0, W, W);
	draw_scene(&p);
	peel_next(&p);
	attach(GL_COLOR_ATTACHMENT0, other.color_tex[0]);
	attach(GL_DEPTH_ATTACHMENT, other.depth_tex);
	pass = check_refused(&other, GL_INVALID_OPERATION);
	glFramebufferParameteri(GL_FRAMEBUFFER,
				GL_DEPTH_PEELING_FIRST_LAYER_MESA,
				p.model.rank + other.layers);
	pass = piglit_check_gl_error(GL_INVALID_OPERATION) && pass;

	/* Back again, nothing is lost. */
	attach(GL_COLOR_ATTACHMENT0, p.color_tex[0]);
	attach(GL_DEPTH_ATTACHMENT, p.depth_tex);
	pass = peel_get(GL_DEPTH_PEELING_FIRST_LAYER_MESA) == p.model.rank &&
		pass;
	pass = check_unharmed(&p) && pass;

	/* Or start over with the others. */
	attach(GL_COLOR_ATTACHMENT0, other.color_tex[0]);
	attach(GL_DEPTH_ATTACHMENT, other.depth_tex);
	glViewport(0, 0, other.width, other.height);
	pass = check_refused(&other, GL_INVALID_OPERATION) && pass;
	glUseProgram(other.program);
	peel_restart(&other);
	pass = check_unharmed(&other) && pass;
	peel_end(&other, pass);
	return peel_end(&p, pass);
}

/** The same texture is respecified between two passes. */
static enum piglit_result
resized(void *data)
{
	struct peel p = make();
	bool pass;

	draw_scene(&p);
	peel_next(&p);
	for (int size = 2 * W; size >= W; size -= W) {
		for (int i = 0; i < 2; i++) {
			glBindTexture(GL_TEXTURE_2D_ARRAY,
				      i ? p.color_tex[0] : p.depth_tex);
			glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, i ? GL_RGBA8 :
				     GL_DEPTH_COMPONENT32F, size, size,
				     LAYERS, 0, i ? GL_RGBA :
				     GL_DEPTH_COMPONENT, GL_FLOAT, NULL);
			glBindTexture(GL_TEXTURE_2D_ARRAY, 0);
		}
		glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
		if (size == W)
			break;
		glUseProgram(0);
		glRectf(-1, -1, 1, 1);
		pass = piglit_check_gl_error(GL_INVALID_OPERATION);
	}
	/* The old size: the bound still holds. */
	peel_clear(&p);
	pass = check_unharmed(&p) && pass;
	return peel_end(&p, pass);
}

/** Other textures of the same form may take the next layers. */
static enum piglit_result
other_textures(void *data)
{
	struct peel p = make(), q = make();
	bool pass;

	glBindFramebuffer(GL_FRAMEBUFFER, p.fbo);
	draw_scene(&p);
	peel_next(&p);
	attach(GL_COLOR_ATTACHMENT0, q.color_tex[0]);
	attach(GL_DEPTH_ATTACHMENT, q.depth_tex);
	p.color_tex[0] = q.color_tex[0];
	p.depth_tex = q.depth_tex;
	peel_clear(&p);
	draw_scene(&p);
	pass = peel_check(&p);
	peel_end(&q, pass);
	return peel_end(&p, pass);
}

static enum piglit_result
depth_func_between_passes(void *data)
{
	const GLenum first = GL_LESS, other = (GLenum)(intptr_t)data;
	struct peel p = make();
	bool pass;

	glDepthFunc(first);
	draw_scene(&p);
	peel_next(&p);
	glDepthFunc(other);
	pass = check_refused(&p, GL_INVALID_OPERATION);
	glFramebufferParameteri(GL_FRAMEBUFFER,
				GL_DEPTH_PEELING_FIRST_LAYER_MESA, 2 * LAYERS);
	pass = piglit_check_gl_error(GL_INVALID_OPERATION) && pass;
	glDepthFunc(first);
	pass = check_unharmed(&p) && pass;

	/* Setting 0 mends it, too. */
	glDepthFunc(other);
	pass = check_refused(&p, GL_INVALID_OPERATION) && pass;
	glClearDepth(other == GL_LEQUAL ? 1 : 0);
	peel_restart(&p);
	draw_scene(&p);
	pass = peel_check(&p) && pass;
	return peel_end(&p, pass);
}

/** With the functions that cannot be continued no later pass draws. */
static enum piglit_result
cannot_continue(void *data)
{
	struct peel p = make();
	bool pass;

	glDepthFunc((GLenum)(intptr_t)data);
	glClearDepth(data == (void *)GL_LEQUAL ? 1 : 0);
	peel_restart(&p);
	draw_scene(&p);
	pass = peel_check(&p);

	glFramebufferParameteri(GL_FRAMEBUFFER,
				GL_DEPTH_PEELING_FIRST_LAYER_MESA, LAYERS);
	pass = piglit_check_gl_error(GL_NO_ERROR) && pass;
	pass = peel_get(GL_DEPTH_PEELING_FIRST_LAYER_MESA) == LAYERS && pass;
	pass = peel_get(GL_DEPTH_PEELING_OVERFLOW_MESA) == 0 && pass;
	pass = check_refused(&p, GL_INVALID_OPERATION) && pass;
	glDepthFunc(GL_LESS);
	pass = check_refused(&p, GL_INVALID_OPERATION) && pass;

	glDepthFunc((GLenum)(intptr_t)data);
	peel_restart(&p);
	draw_scene(&p);
	pass = peel_check(&p) && pass;
	return peel_end(&p, pass);
}

/** More layers than the limit, if arrays can have them. */
static enum piglit_result
too_many_layers(void *data)
{
	struct peel p = make();
	GLint limit, arrays;
	bool pass;

	glGetIntegerv(GL_MAX_DEPTH_PEELING_LAYERS_MESA, &limit);
	glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &arrays);
	if (arrays <= limit) {
		const GLuint tex = kb_new_texture();

		glBindTexture(GL_TEXTURE_2D_ARRAY, tex);
		glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_DEPTH_COMPONENT32F, W,
			     W, limit + 1, 0, GL_DEPTH_COMPONENT, GL_FLOAT,
			     NULL);
		pass = piglit_check_gl_error(GL_INVALID_VALUE);
		return peel_end(&p, pass);
	}
	attach(GL_COLOR_ATTACHMENT0,
	       color_texture(GL_TEXTURE_2D_ARRAY, limit + 1));
	attach(GL_DEPTH_ATTACHMENT,
	       depth_texture(GL_TEXTURE_2D_ARRAY, limit + 1));
	pass = check_refused(&p, GL_INVALID_OPERATION);
	glFramebufferParameteri(GL_FRAMEBUFFER,
				GL_DEPTH_PEELING_FIRST_LAYER_MESA, limit + 1);
	pass = piglit_check_gl_error(GL_INVALID_OPERATION) && pass;
	mend(&p);
	pass = check_unharmed(&p) && pass;
	return peel_end(&p, pass);
}

/** RasterPos makes no fragments: no error. */
static enum piglit_result
raster_pos(void *data)
{
	struct peel p = make();
	bool pass;

	no_depth();
	glRasterPos2f(0, 0);
	glWindowPos2i(3, 3);
	pass = piglit_check_gl_error(GL_NO_ERROR);
	return peel_end(&p, pass);
}

/** What might be taken for an error but is none. */
static enum piglit_result
valid(void *data)
{
	static const int none[1] = { -1 }, holes[3] = { -1, 0, -1 };
	struct peel p = make_with(1, 0, GL_DEPTH_COMPONENT16, GL_RGBA8);
	struct peel q = make();
	bool pass;

	/* One layer, attached layered. */
	glBindFramebuffer(GL_FRAMEBUFFER, p.fbo);
	pass = check_unharmed(&p);

	/* Attachments that are no draw buffers, whatever they are. */
	glBindFramebuffer(GL_FRAMEBUFFER, q.fbo);
	attach(GL_COLOR_ATTACHMENT1,
	       color_texture(GL_TEXTURE_2D_ARRAY, LAYERS + 1));
	pass = check_unharmed(&q) && pass;
	attach(GL_COLOR_ATTACHMENT1, 0);

	/* Draw buffers without an attachment, or NONE. */
	glDrawBuffers(3, (GLenum[]) { GL_COLOR_ATTACHMENT0, GL_NONE,
				      GL_COLOR_ATTACHMENT3 });
	peel_restart(&q);
	pass = check_unharmed(&q) && pass;
	peel_draw_buffers(&q, 3, holes);
	peel_use_program(&q, "", "");
	peel_restart(&q);
	pass = check_unharmed(&q) && pass;

	/* No color at all, but a depth test enabled. */
	peel_draw_buffers(&q, 1, none);
	peel_use_program(&q, "", "");
	glEnable(GL_DEPTH_TEST);
	peel_restart(&q);
	pass = check_unharmed(&q) && pass;
	peel_end(&p, pass);
	return peel_end(&q, pass);
}

#define BAD(name, change, error) \
	KB_SUBTEST(name, state, (&(struct bad) { change, error }))

const struct piglit_subtest kbuffer_subtests[] = {
	BAD("no-depth", no_depth, GL_INVALID_OPERATION),
	BAD("depth-2d", depth_2d, GL_INVALID_OPERATION),
	BAD("depth-1d-array", depth_1d_array, GL_INVALID_OPERATION),
	BAD("depth-cube", depth_cube, GL_INVALID_OPERATION),
	BAD("depth-cube-array", depth_cube_array, GL_INVALID_OPERATION),
	BAD("depth-renderbuffer", depth_renderbuffer, GL_INVALID_OPERATION),
	BAD("single-layers", single_layers, GL_INVALID_OPERATION),
	BAD("single-layer-arrays", single_layer_arrays, GL_INVALID_OPERATION),
	BAD("color-3d", color_3d, GL_INVALID_OPERATION),
	BAD("color-3d-only", color_3d_only, GL_INVALID_OPERATION),
	BAD("color-cube", color_cube, GL_INVALID_OPERATION),
	BAD("color-2d", color_2d, GL_INVALID_FRAMEBUFFER_OPERATION),
	BAD("color-renderbuffer", color_renderbuffer,
	    GL_INVALID_FRAMEBUFFER_OPERATION),
	BAD("fewer-color-layers", fewer_color_layers, GL_INVALID_OPERATION),
	BAD("more-color-layers", more_color_layers, GL_INVALID_OPERATION),
	BAD("second-color-layers", second_color_layers, GL_INVALID_OPERATION),
	BAD("depth-func-never", never, GL_INVALID_OPERATION),
	BAD("depth-func-equal", equal, GL_INVALID_OPERATION),
	BAD("depth-func-notequal", notequal, GL_INVALID_OPERATION),
	BAD("depth-func-always", always, GL_INVALID_OPERATION),
	BAD("stencil-test", stencil_test, GL_INVALID_OPERATION),
	BAD("kbuffer-program", kbuffer_program, GL_INVALID_OPERATION),
	KB_SUBTEST("other-width", exchanged, &other_shapes[0]),
	KB_SUBTEST("other-height", exchanged, &other_shapes[1]),
	KB_SUBTEST("more-layers", exchanged, &other_shapes[2]),
	KB_SUBTEST("fewer-layers", exchanged, &other_shapes[3]),
	KB_SUBTEST("other-format-24", exchanged, &other_shapes[4]),
	KB_SUBTEST("other-format-16", exchanged, &other_shapes[5]),
	KB_SUBTEST("other-samples", exchanged, &other_shapes[6]),
	KB_SUBTEST("resized", resized, NULL),
	KB_SUBTEST("other-textures", other_textures, NULL),
	KB_SUBTEST("greater-after-less", depth_func_between_passes, GL_GREATER),
	KB_SUBTEST("lequal-after-less", depth_func_between_passes, GL_LEQUAL),
	KB_SUBTEST("lequal-continued", cannot_continue, GL_LEQUAL),
	KB_SUBTEST("gequal-continued", cannot_continue, GL_GEQUAL),
	KB_SUBTEST("too-many-layers", too_many_layers, NULL),
	KB_SUBTEST("raster-pos", raster_pos, NULL),
	KB_SUBTEST("valid", valid, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
