/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file depth_peeling_validate.h
 * Whether framebuffers have layers to peel into, and whether a draw may.
 */

#ifndef DEPTH_PEELING_VALIDATE_H
#define DEPTH_PEELING_VALIDATE_H

#include <stdbool.h>
#include "main/mtypes.h"
#include "util/u_atomic.h"

/** Whether another context peels into a framebuffer. */
static inline bool
_mesa_is_peeled_elsewhere(const struct gl_context *ctx,
                          const struct gl_framebuffer *fb)
{
   const struct st_context *owner = p_atomic_read(&fb->Peeling.Owner);

   return owner && owner != ctx->st;
}

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
 * Whether a draw may go on, which it may when depth peeling is disabled.
 *
 * \param reason  NULL, or MAX_DRAW_REASON bytes for what is wrong
 */
bool
_mesa_check_peel_draw(const struct gl_context *ctx, char *reason);

#endif /* DEPTH_PEELING_VALIDATE_H */
