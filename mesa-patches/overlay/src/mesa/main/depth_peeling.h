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

#include <stdbool.h>
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

/**
 * The order in which drawing to \p fb would peel now.
 *
 * \param reason  NULL, or MAX_DRAW_REASON bytes for what is wrong
 * \return false if the depth attachment is none that can be peeled into
 */
bool
_mesa_get_peel_order(const struct gl_context *ctx,
                     const struct gl_framebuffer *fb,
                     struct gl_peel_order *order, char *reason);

/**
 * Whether fragments peeled in an order can go on behind those of the layers
 * before GL_DEPTH_PEELING_FIRST_LAYER_MESA, which is not 0.
 */
bool
_mesa_check_peel_order(const struct gl_peel_order *order,
                       const struct gl_framebuffer_peeling *peeling,
                       char *reason);

/** Whether ranks before GL_DEPTH_PEELING_FIRST_LAYER_MESA can be skipped. */
static inline bool
_mesa_can_continue_peeling(const struct gl_peel_order *order)
{
   /* With LEQUAL and GEQUAL the last to arrive is the first of its depth, so
    * which of them have been taken is not known before all have arrived.
    */
   return order->DepthFunc == GL_LESS || order->DepthFunc == GL_GREATER;
}

/**
 * Whether a draw with GL_DEPTH_PEELING_MESA enabled may go on, apart from the
 * memory for its object.
 *
 * \param reason  NULL, or MAX_DRAW_REASON bytes for what is wrong
 */
bool
_mesa_check_peel_draw(struct gl_context *ctx, char *reason);

/**
 * Whether a draw may run (true also when depth peeling is disabled).  Sets
 * gl_context::DrawGLError if not for GL_INVALID_OPERATION.
 */
bool
_mesa_depth_peeling_valid_to_render(struct gl_context *ctx);

#endif /* DEPTH_PEELING_H */
