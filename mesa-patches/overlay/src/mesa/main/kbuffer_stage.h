/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer_stage.h
 * What GL_MESA_kbuffer_program and GL_MESA_depth_peeling have in common for
 * the rest of the API layer: a stage of their own in the place of blending.
 */

#ifndef KBUFFER_STAGE_H
#define KBUFFER_STAGE_H

#include <stdbool.h>
#include "main/mtypes.h"

/** Whether the state of blending is ignored. */
static inline bool
_mesa_replaces_blending(const struct gl_context *ctx)
{
   return ctx->Kbuffer.Enabled || ctx->DepthPeeling.Enabled;
}

/**
 * Raise gl_context::DrawGLError with the rule of one of the two extensions
 * that a draw breaks; nothing if it breaks none of them.
 *
 * Draw validation notes only that a draw is an error, for its speed; which
 * rule it breaks is found out here, when it has been refused.
 *
 * \return gl_context::DrawGLError, for the caller to raise with its name
 */
GLenum
_mesa_explain_draw_error(struct gl_context *ctx, const char *caller);

#endif /* KBUFFER_STAGE_H */
