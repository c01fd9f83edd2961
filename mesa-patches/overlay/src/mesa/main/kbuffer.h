/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer.h
 * GL_MESA_kbuffer_program in the API layer.
 *
 * A k-buffer program is a gl_program of target GL_FRAGMENT_PROGRAM_ARB and
 * stage FRAGMENT with arb.IsKbuffer set.  Only the entry points of
 * arbprogram.c see GL_KBUFFER_PROGRAM_MESA; the functions here map between
 * the two.
 */

#ifndef KBUFFER_H
#define KBUFFER_H

#include <stdbool.h>
#include "util/glheader.h"
#include "util/macros.h"
#include "main/extensions.h"
#include "main/mtypes.h"

struct gl_context;
struct gl_program;

/** Whether \p target is GL_KBUFFER_PROGRAM_MESA and the context has it. */
static inline bool
_mesa_is_kbuffer_target(const struct gl_context *ctx, GLenum target)
{
   return target == GL_KBUFFER_PROGRAM_MESA &&
          _mesa_has_MESA_kbuffer_program(ctx);
}

/** The target that the application knows the program by. */
static inline GLenum
_mesa_program_api_target(const struct gl_program *prog)
{
   return prog->arb.IsKbuffer ? GL_KBUFFER_PROGRAM_MESA : prog->Target;
}

/** The target that everything below the API knows such a program by. */
static inline GLenum
_mesa_program_internal_target(GLenum target)
{
   return target == GL_KBUFFER_PROGRAM_MESA ? GL_FRAGMENT_PROGRAM_ARB : target;
}

/**
 * The program that runs in place of blending, or NULL when the stage is
 * disabled or its program is missing or invalid.
 */
static inline struct gl_program *
_mesa_kbuffer_program(const struct gl_context *ctx)
{
   struct gl_program *prog = ctx->Kbuffer.Current;

   return ctx->Kbuffer.Enabled && prog && prog->arb.Instructions ? prog : NULL;
}

/**
 * State to update when what replaces blending is enabled or disabled: the
 * equations of KHR_blend_equation_advanced are in the fragment shader, which
 * looks at a constant for the one in force.
 */
static inline GLbitfield
_mesa_new_advanced_blend_state(const struct gl_context *ctx)
{
   return ctx->Color._AdvancedBlendMode != BLEND_NONE ? _NEW_COLOR : 0;
}

void
_mesa_init_kbuffer(struct gl_context *ctx);

void
_mesa_free_kbuffer(struct gl_context *ctx);

void
_mesa_update_default_objects_kbuffer(struct gl_context *ctx);

/** A program object of target GL_KBUFFER_PROGRAM_MESA. */
struct gl_program *
_mesa_new_kbuffer_program(struct gl_context *ctx, GLuint id);

/** glEnable and glDisable; the caller has checked the extension. */
void
_mesa_enable_kbuffer(struct gl_context *ctx, GLboolean state);

/** Bind a k-buffer program, vertices being flushed already. */
void
_mesa_bind_kbuffer_program(struct gl_context *ctx, struct gl_program *prog);

/**
 * Mark all derived state that depends on which k-buffer program runs and on
 * what it says.
 */
void
_mesa_kbuffer_program_changed(struct gl_context *ctx);

/** The limits of programs of target GL_KBUFFER_PROGRAM_MESA. */
struct gl_program_constants
_mesa_kbuffer_program_limits(const struct gl_context *ctx);

/**
 * Entries of the k-buffer that the draw framebuffer makes: color draw
 * buffers times layers (1 when it is not layered), at most
 * Const.MaxKbufferEntries.
 */
unsigned
_mesa_kbuffer_num_entries(const struct gl_context *ctx);

/** Bytes for the reason why a draw is refused, its final zero included. */
#define MAX_DRAW_REASON 160

/**
 * Write why a draw is refused, where \p reason is not NULL.
 *
 * \return false
 */
bool
_mesa_refuse_draw(char *reason, const char *format, ...) PRINTFLIKE(2, 3);

/**
 * Whether a draw may run with GL_KBUFFER_PROGRAM_MESA enabled (true also
 * when it is disabled): a valid program, no integer color buffer, one color
 * buffer per draw buffer and every entry named by the program present.
 *
 * \param reason  NULL, or MAX_DRAW_REASON bytes for what is wrong
 */
bool
_mesa_kbuffer_check_draw(const struct gl_context *ctx, char *reason);

static inline bool
_mesa_kbuffer_valid_to_render(const struct gl_context *ctx)
{
   return _mesa_kbuffer_check_draw(ctx, NULL);
}

#endif /* KBUFFER_H */
