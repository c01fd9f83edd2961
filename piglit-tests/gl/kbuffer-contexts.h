/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-contexts.h
 * More contexts than the one that piglit makes, in turn and in threads.
 */

#ifndef KBUFFER_CONTEXTS_H
#define KBUFFER_CONTEXTS_H

#include "kbuffer-common.h"
#include "piglit-framework-gl/piglit_wfl_framework.h"

/** A context that shares objects with piglit's, or none. */
struct waffle_context *
kb_new_context(bool share);

/** On piglit's window; NULL: piglit's context. */
void
kb_make_current(struct waffle_context *context);

#define KB_WORKERS 4

/** A thread with a context and a window of its own, that are current. */
struct kb_worker {
	int number;             /**< from 0 to KB_WORKERS - 1 */
	bool pass;
	/* For kbuffer-contexts.c: */
	void (*work)(struct kb_worker *worker);
	struct waffle_context *context;
	struct waffle_window *window;
};

/** All of KB_WORKERS threads do the work, and leave no GL error. */
enum piglit_result
kb_run_in_threads(void (*work)(struct kb_worker *worker));

#endif /* KBUFFER_CONTEXTS_H */
