/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-refused-neighbours.c
 * A fragment that is refused early is there for the shaders of its neighbours,
 * and a sample for its own pixel's: nothing that a shader can ask tells that
 * a part of its primitive was refused.
 *
 * A primitive covers everything, but a part of it falls behind the layers.
 * What its shader sees at the rest is what it sees where nothing is refused,
 * and that is known.
 */

#include "peel-common.h"

#define SIZE 16

/** What is in front, or in front of the bound: pixels, or samples of them. */
struct scene {
	const char *name;
	int samples, layers;
	bool (*in_front)(float x, float y);
	bool bounded;
};

/** What a shader asks about itself and others, and the answer. */
struct sight {
	const char *extensions[2];
	/** Of the input "at", the window coordinates. */
	const char *qualifier;
	const char *declarations;
	/** Gives "seen" a value. */
	const char *statements;
	float answer[3];
	/** The answer is where sample 2 lies, seen from the pixel's center. */
	bool asks_sample_position;
	bool reads_image;
	/** It needs a shader of version 4.00, which has 64-bit integers. */
	bool has_int64;
};

static bool
odd_columns(float x, float y)
{
	return (int)x % 2 == 1;
}

static bool
even_columns(float x, float y)
{
	return (int)x % 2 == 0;
}

/** An edge with samples of the same pixel on both of its sides. */
static bool
slanted(float x, float y)
{
	return x < 5.03f + .37f * y;
}

/** A convex polygon, by its corners in pixels. */
static void
draw_polygon(const float (*corners)[2], int n, float z, uint32_t id)
{
	struct peel_vertex vertices[4];

	for (int i = 0; i < n; i++)
		vertices[i] = (struct peel_vertex) {
			2 * corners[i][0] / (3 * SIZE) - 1,
			2 * corners[i][1] / (3 * SIZE) - 1, z, 1, id
		};
	peel_draw_vertices(GL_TRIANGLE_FAN, vertices, n);
}

/** The part that is in front, or all but that. */
static void
draw_part(const struct scene *s, bool in_front, float z, uint32_t id)
{
	if (s->in_front == slanted) {
		const float x = in_front ? 0 : 2 * SIZE;
		const float edge = 5.03f + .37f * SIZE;
		const float corners[4][2] = {
			{ x, 0 }, { 5.03f, 0 }, { edge, SIZE }, { x, SIZE },
		};

		draw_polygon(corners, 4, z, id);
		return;
	}
	for (int x = 0; x < SIZE; x++) {
		const float corners[4][2] = {
			{ x, 0 }, { x + 1, 0 }, { x + 1, SIZE }, { x, SIZE },
		};

		if (s->in_front(x, 0) == in_front)
			draw_polygon(corners, 4, z, id);
	}
}

/** One triangle, of which the window is a part: no edge and no clipping. */
static void
draw_all(float z, uint32_t id)
{
	const float corners[3][2] = {
		{ 0, 0 }, { 3 * SIZE, 0 }, { 0, 3 * SIZE }
	};

	draw_polygon(corners, 3, z, id);
}

#define WHOLE 100

/** All layers of the part in front hold a fragment before the whole comes. */
static void
draw_scene(struct peel *p, const struct scene *s)
{
	for (int i = 0; i < s->layers; i++)
		draw_part(s, true, .25f + i / 64.f, 1 + i);
	if (s->bounded) {
		for (int i = 0; i < s->layers; i++)
			draw_part(s, false, .75f + i / 64.f, 1 + i);
		peel_next(p);
	}
	for (int i = 0; i < s->layers; i++)
		draw_all(.5f + i / 64.f, WHOLE + i);
}

static void
use_shader(const struct sight *sight)
{
	char *vs, *fs;

	if (asprintf(&vs,
		     "#version 150 compatibility\n"
		     "#extension GL_ARB_explicit_attrib_location: require\n"
		     "layout(location = 0) in vec4 position;\n"
		     "layout(location = 1) in uint vertex_id;\n"
		     "%s out vec2 at;\nflat out uint id;\n"
		     "void main() {\n"
		     "  gl_Position = position;\n"
		     "  at = (position.xy * .5 + .5) * %d.;\n"
		     "  id = vertex_id;\n}\n", sight->qualifier, 3 * SIZE) < 0 ||
	    asprintf(&fs,
		     "#version %d compatibility\n"
		     "%s%s%s%s%s%s"
		     "%s in vec2 at;\nflat in uint id;\nout vec4 color;\n%s"
		     "void main() {\n"
		     "  vec3 seen = vec3(0);\n"
		     "  %s\n"
		     "  color = vec4(id, seen);\n}\n",
		     sight->has_int64 ? 400 : 150,
		     sight->extensions[0] ? "#extension " : "",
		     sight->extensions[0] ? sight->extensions[0] : "",
		     sight->extensions[0] ? ": require\n" : "",
		     sight->extensions[1] ? "#extension " : "",
		     sight->extensions[1] ? sight->extensions[1] : "",
		     sight->extensions[1] ? ": require\n" : "",
		     sight->qualifier, sight->declarations,
		     sight->statements) < 0)
		abort();
	kb_use_glsl(vs, NULL, fs);
	free(vs);
	free(fs);
}

/** An image whose texel (x, y) is 3 x + 5 y + 7. */
static void
bind_image(void)
{
	const GLuint texture = kb_new_texture();
	float texels[SIZE * SIZE];

	for (int i = 0; i < SIZE * SIZE; i++)
		texels[i] = 3 * (i % SIZE) + 5 * (i / SIZE) + 7;
	glBindTexture(GL_TEXTURE_2D, texture);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
	glTexImage2D(GL_TEXTURE_2D, 0, GL_R32F, SIZE, SIZE, 0, GL_RED,
		     GL_FLOAT, texels);
	glBindImageTexture(0, texture, 0, GL_FALSE, 0, GL_READ_ONLY, GL_R32F);
}

/** Each sample that the whole came into has the answer, and there are some. */
static bool
check(const struct peel *p, const struct scene *s, const float answer[3])
{
	const int samples = MAX2(s->samples, 1), area = SIZE * SIZE;
	GLfloat position[KB_SAMPLES][2] = { { .5, .5 } };
	uint32_t *codes;
	int found = 0;
	bool pass = true;

	for (int i = 0; i < s->samples; i++)
		glGetMultisamplefv(GL_SAMPLE_POSITION, i, position[i]);
	codes = s->samples ? peel_read_samples(p, p->color_tex[0], p->color[0]) :
		peel_read_color(p, 0);
	for (int i = 0; i < samples * p->layers * area && pass; i++) {
		const int sample = i / area / p->layers;
		const int layer = i / area % p->layers;
		const int x = i % SIZE, y = i % area / SIZE;
		const bool in_front = s->in_front(x + position[sample][0],
						  y + position[sample][1]);
		const float id = in_front == s->bounded ? WHOLE + layer :
			s->bounded ? 0 : 1 + layer;
		float color[4];

		memcpy(color, codes + 4 * i, sizeof(color));
		pass = color[0] == id;
		/* Window coordinates are interpolated. */
		for (int c = 0; c < 3 && id >= WHOLE; c++)
			pass = pass && fabsf(color[1 + c] - answer[c]) < .01f;
		found += id >= WHOLE;
		if (!pass)
			printf("%s: (%d, %d), sample %d, layer %d: fragment %g "
			       "saw (%g, %g, %g), expected fragment %g and "
			       "(%g, %g, %g)\n", s->name, x, y, sample, layer,
			       color[0], color[1], color[2], color[3], id,
			       answer[0], answer[1], answer[2]);
	}
	free(codes);
	if (found == 0 || found == samples * p->layers * area) {
		printf("%s: the whole came into %d samples\n", s->name, found);
		pass = false;
	}
	return pass;
}

static bool
run_scene(const struct scene *s, const struct sight *sight)
{
	float answer[3];
	bool pass;
	struct peel p = peel_create(&(struct peel_shape) {
		s->layers, SIZE, SIZE, s->samples, GL_DEPTH_COMPONENT32F,
		{ GL_RGBA32F } });

	memcpy(answer, sight->answer, sizeof(answer));
	if (sight->asks_sample_position) {
		glGetMultisamplefv(GL_SAMPLE_POSITION, 2, answer);
		answer[0] -= .5f;
		answer[1] -= .5f;
	}
	glViewport(0, 0, 3 * SIZE, 3 * SIZE);
	use_shader(sight);
	if (sight->reads_image)
		bind_image();
	draw_scene(&p, s);
	pass = check(&p, s, answer);
	peel_end(&p, pass);
	return pass;
}

/** Scenes in which one thing or another is refused, up to a name of NULL. */
static const struct scene pixels[] = {
	{ "odd columns", 0, 1, odd_columns },
	{ "even columns", 0, 1, even_columns },
	{ "3 layers", 0, 3, odd_columns },
	{ "odd columns behind the bound", 0, 1, odd_columns, true },
	{ "even columns behind the bound", 0, 1, even_columns, true },
	{ NULL }
};
static const struct scene samples[] = {
	{ "samples", 4, 1, slanted },
	{ "samples of 2 layers", 4, 2, slanted },
	{ "samples behind the bound", 4, 1, slanted, true },
	{ "samples behind the bound of 2 layers", 4, 2, slanted, true },
	{ "all samples of odd columns", 4, 1, odd_columns },
	{ "all samples of even columns", 4, 1, even_columns },
	{ NULL }
};

struct view { const struct sight *sight; const struct scene *scenes; };

static enum piglit_result
view(void *data)
{
	const struct view *v = data;
	GLint max = 0;
	bool pass = true;

	glGetIntegerv(GL_MAX_SAMPLES, &max);
	if (max < v->scenes->samples) {
		printf("there are no %d samples here\n", v->scenes->samples);
		return PIGLIT_SKIP;
	}
	for (int i = 0; i < 2; i++) {
		const char *extension = v->sight->extensions[i];

		if (extension && !piglit_is_extension_supported(extension)) {
			printf("no %s here\n", extension);
			return PIGLIT_SKIP;
		}
	}
	for (const struct scene *s = v->scenes; s->name; s++)
		pass = run_scene(s, v->sight) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

#define GPU_SHADER5 { "GL_ARB_gpu_shader5" }
#define IS_ODD "bool odd = int(gl_FragCoord.x) % 2 == 1;\n"

static const struct sight sample_mask_in = {
	GPU_SHADER5, "", "", "seen.x = gl_SampleMaskIn[0];", { 15 }
};
static const struct sight centroid = {
	{ NULL }, "centroid", "", "seen.xy = at - gl_FragCoord.xy;"
};
static const struct sight at_centroid = {
	GPU_SHADER5, "", "",
	"seen.xy = interpolateAtCentroid(at) - gl_FragCoord.xy;"
};
static const struct sight at_sample = {
	GPU_SHADER5, "", "",
	"seen.xy = interpolateAtSample(at, 2) - gl_FragCoord.xy;",
	.asks_sample_position = true
};
static const struct sight at_offset = {
	GPU_SHADER5, "", "",
	"seen.xy = interpolateAtOffset(at, vec2(.25, -.375)) - gl_FragCoord.xy;",
	{ .25, -.375 }
};
static const struct sight helper = {
	{ "GL_ARB_ES3_1_compatibility" }, "", "",
	"float helper = gl_HelperInvocation ? 1.0 : 0.0;\n"
	"seen = vec3(dFdx(helper), dFdy(helper), helper);"
};

/* Lanes leave it one after the other: 2 rounds in even columns, 9 in odd. */
static const struct sight loop = {
	{ NULL }, "", "",
	IS_ODD
	"int rounds = odd ? 9 : 2, n = 0;\n"
	"float sum = 0.0;\n"
	"while (n++ < rounds)\n"
	"  sum += at.x - gl_FragCoord.x + 1.0;\n"
	"seen = vec3(dFdx(sum), dFdy(sum), sum - float(rounds));", { 7 }
};
static const struct sight image = {
	{ "GL_ARB_shader_image_load_store" }, "",
	"layout(r32f) readonly uniform image2D image;\n",
	"float texel = imageLoad(image, ivec2(gl_FragCoord.xy)).x;\n"
	"seen.xy = vec2(dFdx(texel), dFdy(texel));", { 3, 5 },
	.reads_image = true
};
static const struct sight any = {
	{ "GL_ARB_shader_group_vote" }, "", "",
	IS_ODD
	"seen.xy = vec2(anyInvocationARB(odd), anyInvocationARB(!odd));",
	{ 1, 1 }
};
static const struct sight all = {
	{ "GL_ARB_shader_group_vote" }, "", "",
	IS_ODD
	"seen.xy = vec2(allInvocationsARB(odd), allInvocationsARB(!odd));"
};
static const struct sight all_equal = {
	{ "GL_ARB_shader_group_vote" }, "", "",
	IS_ODD
	"seen.x = float(allInvocationsEqualARB(odd));"
};

/* All lanes of a group, of which one half is in odd columns. */
static const struct sight ballot = {
	{ "GL_ARB_shader_ballot", "GL_ARB_gpu_shader_int64" }, "", "",
	IS_ODD
	"uvec2 lanes = unpackUint2x32(ballotARB(true));\n"
	"uvec2 odd_lanes = unpackUint2x32(ballotARB(odd));\n"
	"uint other = 0u, other_odd = 0u;\n"
	"for (uint i = 0u; i < gl_SubGroupSizeARB; i++) {\n"
	"  other += 1u - (lanes.x >> i & 1u);\n"
	"  other_odd += odd_lanes.x >> i & 1u;\n"
	"}\n"
	"seen = vec3(other, gl_SubGroupSizeARB / 2u - other_odd, lanes.y);",
	.has_int64 = true
};

/* The first lane is in an even column. */
static const struct sight first = {
	{ "GL_ARB_shader_ballot", "GL_ARB_gpu_shader_int64" }, "", "",
	IS_ODD
	"seen.x = readFirstInvocationARB(odd ? 1.0 : 0.0);",
	.has_int64 = true
};

#define VIEW(name, sight, scenes) \
	KB_SUBTEST(name, view, (&(const struct view) { &sight, scenes }))

const struct piglit_subtest kbuffer_subtests[] = {
	VIEW("sample-mask-in", sample_mask_in, samples),
	VIEW("centroid", centroid, samples),
	VIEW("interpolate-at-centroid", at_centroid, samples),
	VIEW("interpolate-at-sample", at_sample, samples),
	VIEW("interpolate-at-offset", at_offset, samples),
	VIEW("helper-invocation", helper, pixels),
	VIEW("helper-invocation-4-samples", helper, samples),
	VIEW("derivative-after-loop", loop, pixels),
	VIEW("derivative-after-loop-4-samples", loop, samples),
	VIEW("derivative-of-image", image, pixels),
	VIEW("derivative-of-image-4-samples", image, samples),
	VIEW("any-invocation", any, pixels),
	VIEW("any-invocation-4-samples", any, samples),
	VIEW("all-invocations", all, pixels),
	VIEW("all-invocations-4-samples", all, samples),
	VIEW("all-invocations-equal", all_equal, pixels),
	VIEW("all-invocations-equal-4-samples", all_equal, samples),
	VIEW("ballot", ballot, pixels),
	VIEW("ballot-4-samples", ballot, samples),
	VIEW("read-first-invocation", first, pixels),
	VIEW("read-first-invocation-4-samples", first, samples),
	KB_SUBTEST_END
};

PEEL_TEST(32)
