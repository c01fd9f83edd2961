/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer_state.h
 * The context state of GL_MESA_kbuffer_program, apart from kbuffer.h because
 * struct gl_context contains it.
 */

#ifndef KBUFFER_STATE_H
#define KBUFFER_STATE_H

#include "util/glheader.h"
#include "main/config.h"

struct gl_program;

/** Entries a program can name: one bit each in gl_program::arb.Kbuffer*. */
#define MAX_KBUFFER_ENTRIES 64

struct gl_kbuffer_state
{
   GLboolean Enabled;           /**< GL_KBUFFER_PROGRAM_MESA */
   struct gl_program *Current;  /**< bound program, never NULL */
   GLfloat Parameters[MAX_PROGRAM_ENV_PARAMS][4]; /**< Env params */
};

#endif /* KBUFFER_STATE_H */
