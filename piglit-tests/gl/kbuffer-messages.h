/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-messages.h
 * What KHR_debug says of an error.
 */

#ifndef KBUFFER_MESSAGES_H
#define KBUFFER_MESSAGES_H

#include "kbuffer-common.h"

/** Collect the messages of errors from now on; ends the test without KHR_debug. */
void
kb_collect_messages(void);

/**
 * Each command of kb_commands gives INVALID_OPERATION, and one message of an
 * error that has the text in it.  Collected messages are forgotten.
 */
bool
kb_expect_message_of_draws(const char *text);

/** The same of a command that was called before, with any GL error. */
bool
kb_expect_message(GLenum error, const char *text);

/** No more messages; to be called before the subtest ends. */
void
kb_stop_messages(void);

#endif /* KBUFFER_MESSAGES_H */
