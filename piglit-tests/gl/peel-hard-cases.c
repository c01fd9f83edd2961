/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file peel-hard-cases.c
 * Scenes that other systems get nearly right, with the analytic answer.
 * (Two abutting quads are in peel-msaa.c, ties across passes of every size in
 * peel-continuation.c.)
 */

#include "peel-common.h"

#define W 64
#define H 48

static struct peel
make(int layers, GLenum depth)
{
	return peel_create(&(struct peel_shape) {
		layers, W, H, 0, depth, { GL_R32UI } });
}

/** All layers, in the order y, x, layer. */
struct layers { uint32_t *depth, *id; };

/** Draw with ids themselves as colors. */
static void
use_ids(struct peel *p)
{
	p->program = kb_use_glsl(
		"#version 150 compatibility\n"
		"#extension GL_ARB_explicit_attrib_location: require\n"
		"layout(location = 0) in vec4 position;\n"
		"layout(location = 1) in uint vertex_id;\nflat out uint id;\n"
		"void main() { gl_Position = position; id = vertex_id; }\n",
		NULL,
		"#version 150 compatibility\n"
		"flat in uint id;\nout uvec4 o;\n"
		"void main() { o = uvec4(id); }\n");
}

static struct layers
read_layers(const struct peel *p)
{
	const int n = W * H, k = p->layers;
	uint32_t *depth = peel_read_depth(p), *color = peel_read_color(p, 0);
	struct layers r = { malloc(n * k * 4), malloc(n * k * 4) };

	for (int i = 0; i < n * k; i++) {
		r.depth[i % n * k + i / n] = depth[i];
		r.id[i % n * k + i / n] = color[4 * i];
	}
	free(depth);
	free(color);
	return r;
}

static void
free_layers(struct layers *r)
{
	free(r->depth);
	free(r->id);
}

/** Which pixel failed, and what is in its layers. */
static bool
fail(const struct peel *p, const struct layers *r, int pixel)
{
	printf("at (%d, %d):", pixel % W, pixel / W);
	for (int l = 0; l < p->layers; l++)
		printf(" %u at %08x", r->id[pixel * p->layers + l],
		       r->depth[pixel * p->layers + l]);
	printf("\n");
	return false;
}

/** Alpha of n layers of one alpha each, exact for alpha 1/2 and 1/4. */
static double
composite(const struct peel *p, const struct layers *r, int pixel,
	  double alpha)
{
	double light = 1;

	for (int l = 0; l < p->layers; l++) {
		if (r->depth[pixel * p->layers + l] != peel_max_depth(p->depth))
			light *= 1 - alpha;
	}
	return 1 - light;
}

/**
 * 1: one perspective plane, cut along both diagonals, alpha .5 each: two
 * fragments in every pixel, alpha .75, one of each cut.
 */
static enum piglit_result
two_triangulations(void *data)
{
	struct peel p = make(4, GL_DEPTH_COMPONENT32F);
	/* The corners of a plane at w = 1 on the left and 3 on the right. */
	const struct peel_vertex c[4] = {
		{ -1, -1, .3, 1 }, { 3, -3, 2.1, 3 }, { 3, 3, 2.4, 3 },
		{ -1, 1, .4, 1 },
	};
	static const int cuts[12] = { 0, 1, 2, 0, 2, 3, 0, 1, 3, 1, 2, 3 };
	struct peel_vertex vertices[12];
	struct layers r;
	bool pass = true;

	for (int i = 0; i < 12; i++) {
		vertices[i] = c[cuts[i]];
		vertices[i].id = 1 + i / 6;
	}
	use_ids(&p);
	peel_draw_vertices(GL_TRIANGLES, vertices, 12);
	r = read_layers(&p);
	for (int i = 0; i < W * H && pass; i++) {
		const uint32_t *id = r.id + 4 * i;

		if (composite(&p, &r, i, .5) != .75 || id[0] + id[1] != 3 ||
		    id[2] != 0)
			pass = fail(&p, &r, i);
	}
	free_layers(&r);
	return peel_end(&p, pass);
}

/** 2: the same quad four times, alpha .25: 1 - .75^4. */
static enum piglit_result
duplicates(void *data)
{
	struct peel p = make(5, GL_DEPTH_COMPONENT32F);
	const struct peel_vertex v[3] = {
		{ -1, -1, .3, 1 }, { 3, -1, .8, 1 }, { -1, 3, .6, 1 },
	};
	struct layers r;
	bool pass = true;

	use_ids(&p);
	for (int i = 0; i < 4; i++) {
		struct peel_vertex copy[3] = { v[0], v[1], v[2] };

		copy[0].id = copy[1].id = copy[2].id = i + 1;
		peel_draw_vertices(GL_TRIANGLES, copy, 3);
	}
	r = read_layers(&p);
	for (int i = 0; i < W * H && pass; i++) {
		/* The same draw twice gives the same bits. */
		for (int l = 0; l < 4; l++) {
			if (r.id[5 * i + l] != l + 1 ||
			    r.depth[5 * i + l] != r.depth[5 * i])
				pass = false;
		}
		if (!pass || composite(&p, &r, i, .25) != 0.68359375)
			pass = fail(&p, &r, i);
	}
	free_layers(&r);
	return peel_end(&p, pass);
}

/** 3: red then blue at one depth. */
static enum piglit_result
red_and_blue(void *data)
{
	static const GLenum funcs[] = { GL_LESS, GL_LEQUAL, GL_GREATER,
		GL_GEQUAL };
	bool pass = true;

	for (int f = 0; f < 4 && pass; f++) {
		const uint32_t front = f % 2 ? 2 : 1;
		struct peel p;
		struct layers r;

		glDepthFunc(funcs[f]);
		glClearDepth(f < 2 ? 1 : 0);
		p = make(3, GL_DEPTH_COMPONENT24);
		use_ids(&p);
		for (int i = 1; i <= 2; i++) {
			const struct peel_quad q = peel_full(&p, .5, i);

			peel_draw_gl(&p, &q, 1);
		}
		r = read_layers(&p);
		for (int i = 0; i < W * H && pass; i++) {
			if (r.id[3 * i] != front || r.id[3 * i + 1] != 3 - front)
				pass = fail(&p, &r, i);
		}
		free_layers(&r);
		peel_end(&p, pass);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** 4: 40 coplanar quads in five passes of 8: every id once, in order. */
static enum piglit_result
across_passes(void *data)
{
	struct peel p = make(8, GL_DEPTH_COMPONENT32F);
	bool pass = true;

	use_ids(&p);
	for (int pass_no = 0; pass_no < 5 && pass; pass_no++) {
		struct layers r;

		if (pass_no > 0)
			peel_next(&p);
		for (int i = 0; i < 40; i++) {
			const struct peel_quad q = peel_full(&p, .5, i + 1);

			peel_draw(&p, &q, 1);
		}
		r = read_layers(&p);
		for (int i = 0; i < W * H * 8 && pass; i++) {
			if (r.id[i] != pass_no * 8 + i % 8 + 1)
				pass = fail(&p, &r, i / 8);
		}
		free_layers(&r);
	}
	pass = pass && peel_get(GL_DEPTH_PEELING_OVERFLOW_MESA) == 0;
	return peel_end(&p, pass);
}

/**
 * 5: 16 planes 2^-24 apart from .75 up.  Floats there are 2^-24 apart, too,
 * and codes of 24 bits are 2^-24 * (1 + 2^-24): 16 depths in both.  A code of
 * 16 bits is 2^-16 * (1 + 2^-16) wide, 256 times as much: one depth (the
 * planes begin 1/4 of a code above 49151, .75 * 65535 = 49151.25, and end 1/16
 * further), so that the order of arrival is kept.
 */
static enum piglit_result
neighbours(void *data)
{
	const GLenum format = *(const GLenum *)data;
	struct peel p = make(17, format);
	struct peel_quad planes[16];
	struct layers r;
	bool pass = true;

	peel_seed(5);
	for (int i = 0; i < 16; i++)
		planes[i] = peel_full(&p, .75 + ldexp(i, -24), i + 1);
	peel_shuffle(planes, 16);
	use_ids(&p);
	for (int i = 0; i < 16; i++) {
		const float z = planes[i].z;
		const struct peel_vertex v[3] = {
			{ -1, -1, z, 1, planes[i].id },
			{ 3, -1, z, 1, planes[i].id },
			{ -1, 3, z, 1, planes[i].id },
		};

		peel_draw_vertices(GL_TRIANGLES, v, 3);
	}
	r = read_layers(&p);
	for (int i = 0; i < W * H && pass; i++) {
		const uint32_t *depth = r.depth + 17 * i;
		const uint32_t *id = r.id + 17 * i;

		pass = depth[16] == peel_max_depth(p.depth);
		for (int l = 0; l < 16 && pass; l++) {
			if (format == GL_DEPTH_COMPONENT16)
				pass = depth[l] == 49151 &&
					id[l] == planes[l].id;
			else
				pass = depth[l] == depth[0] + l &&
					id[l] == l + 1;
		}
		if (!pass)
			fail(&p, &r, i);
	}
	free_layers(&r);
	return peel_end(&p, pass);
}

/**
 * 6: planes 1.0e-7 apart at z = .9, where floats are 2^-24 = 6.0e-8 apart:
 * two layers, the second one or two steps behind.
 */
static enum piglit_result
no_epsilon(void *data)
{
	struct peel p = make(3, GL_DEPTH_COMPONENT32F);
	const struct peel_quad planes[2] = {
		peel_full(&p, .9 + 1e-7, 2), peel_full(&p, .9, 1)
	};
	struct layers r;
	bool pass = true;

	use_ids(&p);
	peel_draw_gl(&p, planes, 2);
	r = read_layers(&p);
	for (int i = 0; i < W * H && pass; i++) {
		const uint32_t *depth = r.depth + 3 * i;

		if (r.id[3 * i] != 1 || r.id[3 * i + 1] != 2 ||
		    depth[1] - depth[0] < 1 || depth[1] - depth[0] > 2)
			pass = fail(&p, &r, i);
	}
	free_layers(&r);
	return peel_end(&p, pass);
}

/**
 * 7: reversed Z with an infinite far plane, near = .01: planes at w = 10^i have
 * z_clip = .01, so z = .01 / w, from 1e-2 to 1e-8, in 32-bit floats all apart.
 * Drawn from the nearest to the farthest and the other way.
 */
static enum piglit_result
reversed_z(void *data)
{
	struct peel p;
	bool pass = true;

	glDepthFunc(GL_GREATER);
	glClearDepth(0);
	p = make(8, GL_DEPTH_COMPONENT32F);
	use_ids(&p);
	for (int back = 0; back < 2 && pass; back++) {
		struct layers r;

		peel_clear(&p);
		for (int i = 0; i < 7; i++) {
			const int at = back ? 6 - i : i;
			const float w = pow(10, at);
			const struct peel_vertex v[3] = {
				{ -w, -w, .01, w, at + 1 },
				{ 3 * w, -w, .01, w, at + 1 },
				{ -w, 3 * w, .01, w, at + 1 },
			};

			peel_draw_vertices(GL_TRIANGLES, v, 3);
		}
		r = read_layers(&p);
		for (int i = 0; i < W * H && pass; i++) {
			for (int l = 0; l < 8 && pass; l++) {
				float z;

				memcpy(&z, &r.depth[8 * i + l], 4);
				/*
				 * 1/w, its product with .01, and .01 itself
				 * are rounded: 4 ulp are enough for drivers
				 * that compute 1/w otherwise than exactly.
				 */
				pass = l == 7 ? z == 0 && r.id[8 * i + l] == 0 :
					r.id[8 * i + l] == l + 1 &&
					fabs(z * pow(10, l) / .01 - 1) <
					4 * ldexp(1, -23);
			}
			if (!pass)
				fail(&p, &r, i);
		}
		free_layers(&r);
	}
	return peel_end(&p, pass);
}

/** 8: a flat depth range: all depths are equal, whatever they were. */
static enum piglit_result
flat_range(void *data)
{
	struct peel p = make(12, GL_DEPTH_COMPONENT32F);
	struct layers r;
	bool pass = true;

	glDepthRange(.3, .3);
	use_ids(&p);
	for (int i = 0; i < 12; i++) {
		const float z = (i * 5 % 12 + 1) / 16.;
		const struct peel_vertex v[3] = {
			{ -1, -1, z, 1, i + 1 }, { 3, -1, z / 2, 1, i + 1 },
			{ -1, 3, z / 3, 1, i + 1 },
		};

		peel_draw_vertices(GL_TRIANGLES, v, 3);
	}
	r = read_layers(&p);
	for (int i = 0; i < W * H * 12 && pass; i++) {
		float z;

		memcpy(&z, &r.depth[i], 4);
		if (r.id[i] != i % 12 + 1 || z != .3f)
			pass = fail(&p, &r, i / 12);
	}
	free_layers(&r);
	return peel_end(&p, pass);
}

/**
 * 10: NaN or infinite depth or color as third of eight.  A NaN depth is never
 * kept, an infinite one is the clear depth after clamping; colors are bits.
 */
static enum piglit_result
nan_and_infinity(void *data)
{
	static const uint32_t odd[] = {
		0x7fc00000, 0xffc00000, 0x7f800000, 0xff800000
	};
	const bool in_depth = data != NULL;
	bool pass = true;

	for (int o = 0; o < 4 && pass; o++) {
		struct peel p = peel_create(&(struct peel_shape) {
			8, W, H, 0, GL_DEPTH_COMPONENT32F, { GL_R32F } });
		/* Minus infinity is clamped to 0, in front of all. */
		const bool kept = !in_depth || odd[o] == 0xff800000;
		const char *fs[2] = {
			"o = vec4(id == 2u ? uintBitsToFloat(odd) : "
			"float(id));\ngl_FragDepth = gl_FragCoord.z;",
			"o = vec4(float(id));\ngl_FragDepth = id == 2u ? "
			"uintBitsToFloat(odd) : gl_FragCoord.z;",
		};
		char text[512];
		uint32_t *color;

		sprintf(text, "#version 150 compatibility\n"
			"#extension GL_ARB_shader_bit_encoding: require\n"
			"uniform uint odd, id;\nout vec4 o;\n"
			"void main() {\n%s\n}\n", fs[in_depth]);
		p.program = kb_use_glsl(
			"#version 150 compatibility\n"
			"void main() { gl_Position = gl_Vertex; }\n", NULL,
			text);
		glUniform1ui(glGetUniformLocation(p.program, "odd"), odd[o]);
		for (int i = 0; i < 8; i++) {
			glUniform1ui(glGetUniformLocation(p.program, "id"), i);
			glBegin(GL_TRIANGLES);
			glVertex3f(-1, -1, (i + 1) / 16.);
			glVertex3f(3, -1, (i + 1) / 16.);
			glVertex3f(-1, 3, (i + 1) / 16.);
			glEnd();
		}
		color = peel_read_color(&p, 0);
		for (int i = 0; i < W * H && pass; i++) {
			int rank = 0;

			for (int id = 0; id < 8 && pass; id++) {
				/* The third comes first, or in its place. */
				const int which = kept && in_depth ?
					(id == 0 ? 2 : id <= 2 ? id - 1 : id) :
					id;
				const float value = which;
				uint32_t expected;

				if (which == 2 && !kept)
					continue;
				memcpy(&expected, &value, 4);
				if (which == 2 && !in_depth)
					expected = odd[o];
				pass = color[4 * (rank++ * W * H + i)] ==
					expected;
			}
			if (pass && rank == 7)
				pass = color[4 * (7 * W * H + i)] == 0;
			if (!pass)
				printf("%08x, layer %d at (%d, %d) is %08x\n",
				       odd[o], rank - 1, i % W, i / W,
				       color[4 * ((rank - 1) * W * H + i)]);
		}
		free(color);
		peel_end(&p, pass);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/**
 * 11: n = k + m shuffled layers: the nearest k, and m are left for the passes
 * behind, which find exactly that many.  The alpha of the kept ones, 1 -
 * product(1 - a), is that of the nearest k: with a = 1/2 exact in doubles.
 */
static enum piglit_result
k_overflow(void *data)
{
	bool pass = true;

	for (int k = 1; k <= 16 && pass; k *= 2) {
		for (int m = 0; m <= 5 && pass; m += 5) {
			struct peel p = make(k, GL_DEPTH_COMPONENT32F);
			struct peel_quad quads[32];
			struct layers r;
			int left = 0;

			peel_seed(k + m);
			for (int i = 0; i < k + m; i++)
				quads[i] = peel_full(&p, (i + 1) / 32., i + 1);
			peel_shuffle(quads, k + m);
			use_ids(&p);
			peel_draw(&p, quads, k + m);
			r = read_layers(&p);
			for (int i = 0; i < W * H * k && pass; i++)
				pass = r.id[i] == i % k + 1 ||
					fail(&p, &r, i / k);
			for (int i = 0; i < W * H && pass; i++)
				pass = composite(&p, &r, i, .5) ==
					1 - ldexp(1, -k) || fail(&p, &r, i);
			free_layers(&r);
			/* What is left, counted at one pixel. */
			while (pass && left <= m &&
			       peel_get(GL_DEPTH_PEELING_OVERFLOW_MESA)) {
				peel_next(&p);
				peel_draw(&p, quads, k + m);
				r = read_layers(&p);
				for (int l = 0; l < k; l++)
					left += r.id[l] != 0;
				free_layers(&r);
			}
			if (pass && left != m) {
				printf("%d left of %d + %d\n", left, k, m);
				pass = false;
			}
			peel_end(&p, pass);
		}
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/**
 * 12: a layer of alpha 0 anywhere changes no bit of the composite, one of
 * alpha 1 hides all behind it; alpha is a color of the layer, so the composite
 * is made here, front to back, in floats.
 */
static enum piglit_result
transparent_and_opaque(void *data)
{
	float expected[2] = { 0 };
	bool pass = true;

	/* Where it is inserted: -1 nowhere, then at each rank. */
	for (int kind = 0; kind < 2 && pass; kind++) {
		for (int at = -1; at < 6 && pass; at++) {
			struct peel p = peel_create(&(struct peel_shape) {
				8, W, H, 0, GL_DEPTH_COMPONENT32F,
				{ GL_RG32F } });
			uint32_t *color;

			p.program = kb_use_glsl(
				"#version 150 compatibility\n"
				"void main() { gl_Position = gl_Vertex;\n"
				"  gl_FrontColor = gl_Color; }\n", NULL,
				"#version 150 compatibility\nout vec4 o;\n"
				"void main() { o = gl_Color; }\n");
			for (int i = 0; i < 6; i++) {
				const int rank = i * 5 % 6;
				const bool extra = i == 3 && at >= 0;

				for (int e = 0; e <= extra; e++) {
					const float z = e ? (2 * at + 1) / 32. :
						(2 * rank + 2) / 32.;

					glColor4f(e ? .75 : rank / 8.,
						  e ? kind : .25 + rank / 16.,
						  0, 0);
					glBegin(GL_TRIANGLES);
					glVertex3f(-1, -1, z);
					glVertex3f(3, -1, z);
					glVertex3f(-1, 3, z);
					glEnd();
				}
			}
			color = peel_read_color(&p, 0);
			for (int i = 0; i < W * H && pass; i++) {
				float sum = 0, light = 1;
				/* Of layers nearer than the opaque one. */
				float hidden = 0, hidden_light = 1;

				for (int l = 0; l < 8; l++) {
					float c[2];

					memcpy(c, &color[4 * (l * W * H + i)],
					       8);
					sum += light * (c[1] * c[0]);
					light *= 1 - c[1];
				}
				for (int l = 0; l < at; l++) {
					const float a = .25 + l / 16.;

					hidden += hidden_light * (a * (l / 8.));
					hidden_light *= 1 - a;
				}
				hidden += hidden_light * .75f;
				if (at < 0) {
					expected[0] = sum;
					expected[1] = light;
				}
				if (kind == 0 || at < 0)
					pass = sum == expected[0] &&
						light == expected[1];
				else
					pass = sum == hidden && light == 0;
				if (!pass)
					printf("alpha %d at rank %d: %.9g "
					       "(%.9g)\n", kind, at, sum,
					       light);
			}
			free(color);
			peel_end(&p, pass);
		}
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static const GLenum d16 = GL_DEPTH_COMPONENT16, d24 = GL_DEPTH_COMPONENT24,
	d32f = GL_DEPTH_COMPONENT32F;

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("1-two-triangulations", two_triangulations, NULL),
	KB_SUBTEST("2-duplicates", duplicates, NULL),
	KB_SUBTEST("3-red-and-blue", red_and_blue, NULL),
	KB_SUBTEST("4-across-passes", across_passes, NULL),
	KB_SUBTEST("5-neighbours-16", neighbours, &d16),
	KB_SUBTEST("5-neighbours-24", neighbours, &d24),
	KB_SUBTEST("5-neighbours-32f", neighbours, &d32f),
	KB_SUBTEST("6-no-epsilon", no_epsilon, NULL),
	KB_SUBTEST("7-reversed-z", reversed_z, NULL),
	KB_SUBTEST("8-flat-depth-range", flat_range, NULL),
	KB_SUBTEST("10-nan-and-infinite-color", nan_and_infinity, NULL),
	KB_SUBTEST("10-nan-and-infinite-depth", nan_and_infinity, ""),
	KB_SUBTEST("11-k-overflow", k_overflow, NULL),
	KB_SUBTEST("12-transparent-and-opaque", transparent_and_opaque, NULL),
	KB_SUBTEST_END
};

PEEL_TEST(32)
