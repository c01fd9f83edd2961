/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file st_peel.h
 * From the depth peeling of framebuffer objects to the peel objects of the
 * pipe (pipe/p_kbuffer.h).
 *
 * A peel object belongs to the context that first peeled into the framebuffer,
 * but Mesa lets all contexts of a share group use one framebuffer object.
 * Another context can only delete it, or start it over with an object of its
 * own.
 */

#ifndef ST_PEEL_H
#define ST_PEEL_H

#include <stdbool.h>
#include "main/mtypes.h"
#include "util/macros.h"
#include "st_context.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Begin at rank 0 and forget the overflow. */
void
st_peel_start_over(struct gl_context *ctx, struct gl_framebuffer *fb);

/**
 * Go on behind what the layers of \p fb hold, and forget the overflow.
 *
 * \return false if there is no memory; nothing has changed then.
 */
bool
st_peel_continue(struct gl_context *ctx, struct gl_framebuffer *fb,
                 const struct gl_peel_order *order);

/** Whether a fragment has fallen behind the last layer. */
bool
st_peel_overflow(struct gl_context *ctx, struct gl_framebuffer *fb);

/** To be called, in any context or none, when \p fb is freed. */
void
st_peel_release_object(struct gl_framebuffer *fb);

/** See st_validate_peel. */
bool
st_peel_update(struct st_context *st);

/**
 * Set the pipe's state of the k-buffer stage if draws peel, else take it back.
 *
 * \return whether they do.
 */
static inline bool
st_validate_peel(struct st_context *st)
{
   return unlikely(st->ctx->DepthPeeling.Enabled || st->peel) &&
          st_peel_update(st);
}

/** Delete all objects of a context that is going to be destroyed. */
void
st_peel_destroy_objects(struct st_context *st);

#ifdef __cplusplus
}
#endif

#endif /* ST_PEEL_H */
