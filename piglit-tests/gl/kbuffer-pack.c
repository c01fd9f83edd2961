/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-pack.c
 * PK4UB clamps, rounds to the nearest byte and packs four of them into the
 * bits of one component; UP4UB unpacks; the bits survive MOV, CMP and the
 * entries of a 32-bit floating-point format.
 */

#include "kbuffer-common.h"

#define W 64
#define N (W * W)

static uint32_t
as_bits(float f)
{
	uint32_t u;

	memcpy(&u, &f, 4);
	return u;
}

static float
as_float(uint32_t u)
{
	float f;

	memcpy(&f, &u, 4);
	return f;
}

/** Entry 0 is \p in; run the program; returns entry 1, free() it. */
static float *
run(const float *in, const char *program)
{
	struct kb kb = kb_create(GL_RGBA32F, 2, 0, W, W);

	kb_upload(&kb, 0, in);
	kb_program(program);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	return kb_read(&kb, 1);
}

/** Every byte in every position, a little above and below the value. */
static enum piglit_result
rounds_to_nearest(void *data)
{
	float *in = malloc(N * 16), *out;
	bool pass = true;

	for (int i = 0; i < N * 4; i++) {
		/* Offsets of -0.49, -0.25, 0, 0.25, 0.49 of a byte: 255 times
		 * the value is off by 2 * 2^-24 * 255 = 3e-5 at most. */
		const int byte = i / 4 % 256;
		const float offset = (i / 1024 % 5 - 2) * 0.245f;

		in[i] = ((byte + 64 * (i % 4)) % 256 + offset) / 255.0f;
	}
	out = run(in, "PK4UB result.kbuffer[1], kbuffer[0];");
	for (int i = 0; i < N && pass; i++) {
		uint32_t expected = 0;

		for (int c = 0; c < 4; c++) {
			const int byte = (i % 256 + 64 * c) % 256;

			expected |= (uint32_t)byte << (8 * c);
		}
		for (int c = 0; c < 4; c++) {
			if (as_bits(out[4 * i + c]) == expected)
				continue;
			printf("component %d of (%g %g %g %g) * 1/255: "
			       "%08x, expected %08x\n", c, in[4 * i] * 255,
			       in[4 * i + 1] * 255, in[4 * i + 2] * 255,
			       in[4 * i + 3] * 255, as_bits(out[4 * i + c]),
			       expected);
			pass = false;
		}
	}
	free(in);
	free(out);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static enum piglit_result
clamps(void *data)
{
	static const float values[4][4] = {
		{ -1, 2, 1, 0 }, { INFINITY, -INFINITY, 1e30, -1e-30 },
		{ NAN, 1.001, -0.001, 0.5019608 }, { 300, -NAN, -0.0, 1e-40 },
	};
	static const uint32_t packed[4] = {
		0x00ffff00, 0x00ff00ff, 0x8000ff00, 0x000000ff
	};
	float *in = malloc(N * 16), *out;
	bool pass = true;

	for (int i = 0; i < N; i++)
		memcpy(in + 4 * i, values[i % 4], 16);
	out = run(in, "PK4UB result.kbuffer[1].x, kbuffer[0];");
	for (int i = 0; i < 4; i++) {
		if (as_bits(out[4 * i]) != packed[i]) {
			printf("case %d: %08x, expected %08x\n", i,
			       as_bits(out[4 * i]), packed[i]);
			pass = false;
		}
	}
	free(in);
	free(out);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** Bit patterns that hold every byte in every position, NaNs among them. */
static uint32_t *
patterns(void)
{
	uint32_t *bits = malloc(N * 16), state = 1;

	for (int i = 0; i < N * 4; i++) {
		state = state * 1664525 + 1013904223;
		bits[i] = state;
		if (i < 1024)           /* small and denormalized numbers */
			bits[i] = i % 256 << (i / 256 * 8);
		else if (i < 2048)      /* NaNs and infinities */
			bits[i] |= 0x7f800000;
	}
	return bits;
}

/** Each component as operand, by \p data the letter's number. */
static enum piglit_result
unpacks(void *data)
{
	const int component = (int)(intptr_t)data;
	uint32_t *in = patterns();
	char program[64];
	float *out;
	bool pass = true;

	snprintf(program, sizeof(program),
		 "UP4UB result.kbuffer[1], kbuffer[0].%c;", "xyzw"[component]);
	out = run((float *)in, program);
	for (int i = 0; i < N * 4 && pass; i++) {
		const int byte = in[i / 4 * 4 + component] >> (i % 4 * 8) & 255;

		/* One rounding of a division or multiplication each. */
		if (fabs(out[i] - byte / 255.0) > 1.2e-7) {
			printf("byte %d unpacked to %.9g\n", byte, out[i]);
			pass = false;
		}
		/* The ends are exact. */
		if ((byte == 0 && out[i] != 0) || (byte == 255 && out[i] != 1))
			pass = false;
	}
	free(in);
	free(out);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/** PK4UB undoes UP4UB, MOV and CMP carry the bits, also through temporaries. */
static enum piglit_result
round_trip(void *data)
{
	uint32_t *in = patterns();
	float *out = run((float *)in, (const char *)data);
	bool pass = true;

	for (int i = 0; i < N * 4 && pass; i++) {
		if (as_bits(out[i]) != in[i]) {
			printf("%08x (%g) became %08x in component %d\n", in[i],
			       as_float(in[i]), as_bits(out[i]), i % 4);
			pass = false;
		}
	}
	free(in);
	free(out);
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

/**
 * The use that the instructions are for: two (RGBA8, z) fragments in an entry,
 * the nearer one first, sorted by CMP.
 */
static enum piglit_result
two_fragments_an_entry(void *data)
{
	static const float z[6] = { .5, .75, .25, .875, .125, .625 };
	static const float expected[4] = { 4 / 255., 2 / 255., .125, .25 };
	struct kb kb = kb_create(GL_RGBA32F, 2, 0, W, W);
	float *got;
	bool pass = true;

	/* x, y: packed colors; z, w: their depths. */
	kb_fill(&kb, 0, 0, 0, 1, 1);
	for (int i = 0; i < 6; i++) {
		kb_fragment_value(i / 255., (255 - i) / 255., .25, 1);
		kb_program(
			"TEMP new, f, s;\nATTRIB old = kbuffer[0];\n"
			"PK4UB new.x, fragment.color;\n"
			"MOV new.z, fragment.position.z;\n"
			/* f: nearer than the first, s: than the second */
			"SLT f, new.z, old.z;\nSLT s, new.z, old.w;\n"
			"CMP s.yw, -s, new.xxzz, old;\n"
			"CMP result.kbuffer[0].yw, -f, old.xxzz, s;\n"
			"CMP result.kbuffer[0].xz, -f, new, old;");
		glEnable(GL_KBUFFER_PROGRAM_MESA);
		kb_draw_rect(&kb, 0, 0, W, W, z[i]);
	}
	pass = piglit_check_gl_error(GL_NO_ERROR);
	got = kb_read(&kb, 0);
	for (int i = 0; i < N && pass; i++) {
		const uint32_t near = as_bits(got[4 * i]);
		const uint32_t far = as_bits(got[4 * i + 1]);

		pass = near == 0xff40fb04 && far == 0xff40fd02 &&
			got[4 * i + 2] == .125f && got[4 * i + 3] == .25f;
		if (!pass)
			printf("%08x %08x %g %g\n", near, far, got[4 * i + 2],
			       got[4 * i + 3]);
	}
	free(got);

	kb_program("TEMP a, b;\nUP4UB a, kbuffer[0].x;\n"
		   "UP4UB b, kbuffer[0].y;\nMOV a.y, b.x;\n"
		   "MOV a.zw, kbuffer[0];\nMOV result.kbuffer[1], a;");
	kb_draw(&kb);
	pass = kb_expect(&kb, 1, 1.2e-7, expected[0], expected[1], expected[2],
			 expected[3]) && pass;
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("rounds-to-nearest", rounds_to_nearest, NULL),
	KB_SUBTEST("clamps", clamps, NULL),
	KB_SUBTEST("unpacks-x", unpacks, 0),
	KB_SUBTEST("unpacks-y", unpacks, 1),
	KB_SUBTEST("unpacks-z", unpacks, 2),
	KB_SUBTEST("unpacks-w", unpacks, 3),
	KB_SUBTEST("pack-of-unpack", round_trip,
		   "TEMP t, u;\nUP4UB t, kbuffer[0].x;\nPK4UB u.x, t;\n"
		   "UP4UB t, kbuffer[0].y;\nPK4UB u.y, t;\n"
		   "UP4UB t, kbuffer[0].z;\nPK4UB u.z, t;\n"
		   "UP4UB t, kbuffer[0].w;\nPK4UB u.w, t;\n"
		   "MOV result.kbuffer[1], u;"),
	KB_SUBTEST("mov", round_trip,
		   "TEMP t, u;\nMOV t, kbuffer[0].wzyx;\nMOV u.xz, t.wzyx;\n"
		   "MOV u.yw, t.wzyx;\nMOV result.kbuffer[1], u;"),
	KB_SUBTEST("cmp", round_trip,
		   "TEMP t;\nCMP t, { -1, 1, -1, 1 }, kbuffer[0], 0;\n"
		   "CMP result.kbuffer[1], { -1, 1, -1, 1 }, t, kbuffer[0];"),
	KB_SUBTEST("two-fragments-an-entry", two_fragments_an_entry, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(30)
