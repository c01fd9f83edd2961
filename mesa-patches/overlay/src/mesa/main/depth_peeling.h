/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file depth_peeling.h
 * GL_MESA_depth_peeling in the API layer.
 */

#ifndef DEPTH_PEELING_H
#define DEPTH_PEELING_H

#include "util/glheader.h"
#include "util/macros.h"
#include "main/extensions.h"
#include "main/mtypes.h"

/** glEnable and glDisable; the caller has checked the extension. */
void
_mesa_enable_depth_peeling(struct gl_context *ctx, GLboolean state);

/** Mark what depends on whether and how a draw peels. */
void
_mesa_depth_peeling_changed(struct gl_context *ctx);

/**
 * To be called when a state changes that depth peeling is one of the few to
 * look at; vertices have been flushed.
 */
static inline void
_mesa_update_depth_peeling(struct gl_context *ctx)
{
   if (unlikely(ctx->DepthPeeling.Enabled))
      _mesa_depth_peeling_changed(ctx);
}

/**
 * glFramebufferParameteri of GL_DEPTH_PEELING_FIRST_LAYER_MESA; the caller
 * has checked the extension and that \p fb is a framebuffer object.
 */
void
_mesa_set_first_peel_layer(struct gl_context *ctx, struct gl_framebuffer *fb,
                           GLint layer, const char *func);

/** Value of GL_DEPTH_PEELING_OVERFLOW_MESA. */
GLint
_mesa_get_peel_overflow(struct gl_context *ctx, struct gl_framebuffer *fb);

#endif /* DEPTH_PEELING_H */
