/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer.c
 * State of GL_MESA_kbuffer_program: the capability, the binding point and the
 * limits of its programs.
 */

#include "main/kbuffer.h"
#include "main/blend.h"
#include "main/context.h"
#include "main/draw_validate.h"
#include "main/state.h"
#include "program/prog_instruction.h"
#include "program/program.h"
#include "state_tracker/st_context.h"

void
_mesa_init_kbuffer(struct gl_context *ctx)
{
   ctx->Kbuffer.Enabled = GL_FALSE;
   _mesa_update_default_objects_kbuffer(ctx);
}

void
_mesa_free_kbuffer(struct gl_context *ctx)
{
   _mesa_reference_program(ctx, &ctx->Kbuffer.Current, NULL);
}

void
_mesa_update_default_objects_kbuffer(struct gl_context *ctx)
{
   _mesa_reference_program(ctx, &ctx->Kbuffer.Current,
                           ctx->Shared->DefaultKbufferProgram);
   assert(ctx->Kbuffer.Current);
}

struct gl_program *
_mesa_new_kbuffer_program(struct gl_context *ctx, GLuint id)
{
   struct gl_program *prog =
      ctx->Driver.NewProgram(ctx, MESA_SHADER_FRAGMENT, id, true);

   if (prog)
      prog->arb.IsKbuffer = GL_TRUE;

   return prog;
}

void
_mesa_enable_kbuffer(struct gl_context *ctx, GLboolean state)
{
   if (ctx->Kbuffer.Enabled == state)
      return;

   FLUSH_VERTICES(ctx, _NEW_PROGRAM | _mesa_new_advanced_blend_state(ctx),
                  GL_ENABLE_BIT);
   ctx->Kbuffer.Enabled = state;
   _mesa_update_clamp_fragment_color(ctx, ctx->DrawBuffer);
   _mesa_kbuffer_program_changed(ctx);
   _mesa_update_allow_draw_out_of_order(ctx);
}

void
_mesa_bind_kbuffer_program(struct gl_context *ctx, struct gl_program *prog)
{
   _mesa_reference_program(ctx, &ctx->Kbuffer.Current, prog);
   _mesa_kbuffer_program_changed(ctx);
}

void
_mesa_kbuffer_program_changed(struct gl_context *ctx)
{
   ctx->NewState |= _NEW_PROGRAM;
   ctx->NewDriverState |= ST_NEW_BLEND |
                          ST_NEW_FS_CONSTANTS |
                          ST_NEW_FS_SAMPLER_VIEWS |
                          ST_NEW_FS_SAMPLERS;
   _mesa_update_valid_to_render_state(ctx);
}

struct gl_program_constants
_mesa_kbuffer_program_limits(const struct gl_context *ctx)
{
   struct gl_program_constants limits =
      ctx->Const.Program[MESA_SHADER_FRAGMENT];

   /* Drivers without a limit of their own report one that only memory
    * bounds; a k-buffer program is part of every fragment shader variant.
    */
   limits.MaxInstructions =
      MIN2(limits.MaxInstructions, MAX_PROGRAM_INSTRUCTIONS);
   limits.MaxAluInstructions =
      MIN2(limits.MaxAluInstructions, MAX_PROGRAM_INSTRUCTIONS);
   limits.MaxTexInstructions =
      MIN2(limits.MaxTexInstructions, MAX_PROGRAM_INSTRUCTIONS);
   limits.MaxTexIndirections =
      MIN2(limits.MaxTexIndirections, MAX_PROGRAM_INSTRUCTIONS);

   /* Registers have to fit in prog_dst_register::Index. */
   limits.MaxTemps = MIN2(limits.MaxTemps, 1u << INST_INDEX_BITS);

   /* fragment.position, fragment.color[] and kbuffer[] */
   limits.MaxAttribs =
      1 + ctx->Const.MaxDrawBuffers + ctx->Const.MaxKbufferEntries;

   return limits;
}
