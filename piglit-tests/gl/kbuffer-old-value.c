/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-old-value.c
 * kbuffer[e] reads the value from before the fragment, also after
 * result.kbuffer[e] was written; results take effect together at the end; of
 * several writes to a component the last counts.
 */

#include "kbuffer-common.h"

struct old_value {
	const char *program;
	float expected[2][4];
};

static enum piglit_result
run(void *data)
{
	const struct old_value *t = data;
	struct kb kb = kb_create(GL_RGBA32F, 2, 0, 16, 16);
	bool pass = true;

	kb_fill(&kb, 0, 1, 2, 3, 4);
	kb_fill(&kb, 1, 10, 20, 30, 40);
	kb_program(t->program);
	kb_fragment_value(100, 200, 300, 400);
	glEnable(GL_KBUFFER_PROGRAM_MESA);
	kb_draw(&kb);
	for (int e = 0; e < 2; e++) {
		const float *v = t->expected[e];

		pass = kb_expect(&kb, e, 0, v[0], v[1], v[2], v[3]) && pass;
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}

static const struct old_value
swap = {
	"MOV result.kbuffer[0], kbuffer[1];\n"
	"MOV result.kbuffer[1], kbuffer[0];",
	{ { 10, 20, 30, 40 }, { 1, 2, 3, 4 } }
},
swap_components = {
	"MOV result.kbuffer[0].xy, kbuffer[0].yxzw;\n"
	"MOV result.kbuffer[0].zw, kbuffer[0].xyxy;\n"
	"MOV result.kbuffer[1], kbuffer[1].wzyx;",
	{ { 2, 1, 1, 2 }, { 40, 30, 20, 10 } }
},
read_after_write = {
	"MOV result.kbuffer[0], fragment.color;\n"
	"ADD result.kbuffer[1], kbuffer[0], kbuffer[1];",
	{ { 100, 200, 300, 400 }, { 11, 22, 33, 44 } }
},
last_write = {
	"MOV result.kbuffer[0], fragment.color;\n"
	"ADD result.kbuffer[0].xz, kbuffer[0], 1;\n"
	"MOV result.kbuffer[1].w, 5;\n"
	"MUL result.kbuffer[1].w, kbuffer[1], 2;",
	{ { 2, 200, 4, 400 }, { 10, 20, 30, 80 } }
},
same_instruction = {
	"ADD result.kbuffer[0], kbuffer[0].wzyx, kbuffer[0];\n"
	"MAD result.kbuffer[1], kbuffer[1], kbuffer[0].x, kbuffer[1].wzyx;",
	{ { 5, 5, 5, 5 }, { 50, 50, 50, 50 } }
},
through_names = {
	"ATTRIB old = kbuffer[1];\nOUTPUT new = result.kbuffer[1];\n"
	"ALIAS mine = old;\nTEMP t;\n"
	"MOV new, 0;\nMOV t, mine;\nADD new.x, t, mine;\n"
	"SUB result.kbuffer[0], mine, t;",
	{ { 0, 0, 0, 0 }, { 20, 0, 0, 0 } }
},
saturated = {
	"MUL_SAT result.kbuffer[0], kbuffer[0], { 0.25, -1, 1, 0.125 };\n"
	"MOV_SAT result.kbuffer[1].yz, -kbuffer[1];",
	{ { .25, 0, 1, .5 }, { 10, 0, 0, 40 } }
};

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("swap-entries", run, &swap),
	KB_SUBTEST("swap-components", run, &swap_components),
	KB_SUBTEST("read-after-write", run, &read_after_write),
	KB_SUBTEST("last-write-counts", run, &last_write),
	KB_SUBTEST("same-instruction", run, &same_instruction),
	KB_SUBTEST("through-names", run, &through_names),
	KB_SUBTEST("saturated", run, &saturated),
	KB_SUBTEST_END
};

KBUFFER_TEST(30)
