/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file st_kbuffer.h
 * From the k-buffer program of the context to the k-buffer stage of the pipe
 * (pipe/p_kbuffer.h).
 */

#ifndef ST_KBUFFER_H
#define ST_KBUFFER_H

#include "main/kbuffer.h"
#include "st_atom.h"
#include "st_context.h"

#ifdef __cplusplus
extern "C" {
#endif

/**
 * The driver's form of a program string.  Referenced by the program and by
 * each context that has it bound in its pipe, so neither deleting nor
 * respecifying a program takes it away from a pipe.  Programs are shared by
 * contexts, so the last reference may be any context's.
 */
struct st_kbuffer_object;

/**
 * To be called after every successful specification of a k-buffer program's
 * string, in the place of st_program_string_notify.
 */
void
st_kbuffer_program_notify(struct gl_context *ctx, struct gl_program *prog);

/** Drop a reference and clear the pointer. */
void
st_kbuffer_release_object(struct st_context *st,
                          struct st_kbuffer_object **object);

/**
 * The object that draws must use, NULL when the stage is off.
 *
 * Draw validation has looked at the same, but not in contexts without errors,
 * nor when another context has specified a new program string since.  Drivers
 * rely on every entry being there.
 */
static inline struct st_kbuffer_object *
st_kbuffer_object(const struct gl_context *ctx)
{
   struct gl_program *prog = _mesa_kbuffer_program(ctx);

   return prog && _mesa_kbuffer_valid_to_render(ctx) ? prog->kbuffer : NULL;
}

/**
 * Whether these changes concern the stage.  A framebuffer, program or enable
 * that changes comes with ST_NEW_BLEND.
 */
static inline bool
st_kbuffer_is_dirty(const struct st_context *st, uint64_t dirty)
{
   return dirty & (ST_NEW_BLEND | ST_NEW_FS_CONSTANTS |
                   ST_NEW_FS_SAMPLER_VIEWS | ST_NEW_FS_SAMPLERS) &&
          unlikely(st->ctx->Kbuffer.Enabled || st->kbuffer);
}

/** Set the pipe's k-buffer state to that of the context. */
void
st_kbuffer_update(struct st_context *st);

/** Leave the pipe without a k-buffer program. */
void
st_kbuffer_unbind(struct st_context *st);

#ifdef __cplusplus
}
#endif

#endif /* ST_KBUFFER_H */
