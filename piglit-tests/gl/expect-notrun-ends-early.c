/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file expect-notrun-ends-early.c
 * Tests the tester: a subtest that ends the whole test has not been run, nor
 * have those after it, though piglit's own verdict is that of those before.
 */

#include "kbuffer-common.h"

static enum piglit_result
passes(void *data)
{
	return PIGLIT_PASS;
}

static enum piglit_result
ends(void *data)
{
	piglit_report_result(PIGLIT_FAIL);
	return PIGLIT_PASS;
}

const struct piglit_subtest kbuffer_subtests[] = {
	KB_SUBTEST("passes", passes, NULL),
	KB_SUBTEST("ends", ends, NULL),
	KB_SUBTEST("after", ends, NULL),
	KB_SUBTEST_END
};

KBUFFER_TEST(20)
