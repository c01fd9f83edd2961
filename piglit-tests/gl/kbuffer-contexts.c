/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-contexts.c
 * More contexts than the one that piglit makes.
 */

#include "kbuffer-contexts.h"

#include <pthread.h>

static struct piglit_wfl_framework *
framework(void)
{
	return piglit_wfl_framework(gl_fw);
}

static void
make_current_on(struct waffle_window *window, struct waffle_context *context)
{
	if (!waffle_make_current(framework()->display, window, context)) {
		printf("a context cannot be made current: %s\n",
		       waffle_error_get_info()->message);
		piglit_report_result(PIGLIT_FAIL);
	}
}

void
kb_make_current(struct waffle_context *context)
{
	make_current_on(framework()->window,
			context ? context : framework()->context);
}

struct waffle_context *
kb_new_context(bool share)
{
	struct piglit_wfl_framework *wfl = framework();
	struct waffle_context *context = waffle_context_create(
		wfl->config, share ? wfl->context : NULL);

	if (!context) {
		printf("no second context\n");
		piglit_report_result(PIGLIT_FAIL);
	}
	return context;
}

static void *
run(void *data)
{
	struct kb_worker *worker = data;

	make_current_on(worker->window, worker->context);
	worker->pass = true;
	worker->work(worker);
	worker->pass = piglit_check_gl_error(GL_NO_ERROR) && worker->pass;
	waffle_make_current(framework()->display, NULL, NULL);
	return NULL;
}

enum piglit_result
kb_run_in_threads(void (*work)(struct kb_worker *worker))
{
	struct kb_worker workers[KB_WORKERS];
	pthread_t handles[KB_WORKERS];
	bool pass = true;

	for (int i = 0; i < KB_WORKERS; i++) {
		workers[i] = (struct kb_worker) {
			.number = i, .work = work,
			.context = kb_new_context(false),
			/* A window is current in one thread only. */
			.window = waffle_window_create(framework()->config,
						       64, 64),
		};
	}
	/* The first alone: piglit's function pointers are resolved then. */
	waffle_make_current(framework()->display, NULL, NULL);
	run(&workers[0]);
	for (int i = 1; i < KB_WORKERS; i++)
		pthread_create(&handles[i], NULL, run, &workers[i]);
	for (int i = 1; i < KB_WORKERS; i++)
		pthread_join(handles[i], NULL);
	kb_make_current(NULL);
	for (int i = 0; i < KB_WORKERS; i++) {
		pass = workers[i].pass && pass;
		waffle_context_destroy(workers[i].context);
		waffle_window_destroy(workers[i].window);
	}
	return pass ? PIGLIT_PASS : PIGLIT_FAIL;
}
