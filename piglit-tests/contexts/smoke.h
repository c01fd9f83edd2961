/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file smoke.h
 * A short test of GL_MESA_kbuffer_program for any kind of context: advertised,
 * renders into the default framebuffer and into a framebuffer object.
 */

#ifndef SMOKE_H
#define SMOKE_H

#define SMOKE_SIZE 32

typedef void (*smoke_proc)(void);

/**
 * With a context current whose framebuffer is SMOKE_SIZE squared and which is
 * of \p driver ("llvmpipe" or "softpipe"): 0 if all is well, else 1, having
 * said what is not.
 */
int
smoke(smoke_proc (*get_proc_address)(const char *name), const char *driver);

#endif
