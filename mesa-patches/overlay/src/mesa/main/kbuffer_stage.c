/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer_stage.c
 * Which rule of the two extensions a refused draw breaks.
 */

#include "main/depth_peeling_validate.h"
#include "main/draw_validate.h"
#include "main/errors.h"
#include "main/kbuffer.h"
#include "main/kbuffer_stage.h"

GLenum
_mesa_explain_draw_error(struct gl_context *ctx, const char *caller)
{
   const GLenum error = ctx->DrawGLError;
   char reason[MAX_DRAW_REASON];

   /* What is known of the attachments of an incomplete framebuffer is old. */
   if (error != GL_INVALID_FRAMEBUFFER_OPERATION &&
       (!_mesa_kbuffer_check_draw(ctx, reason) ||
        !_mesa_check_peel_draw(ctx, reason)))
      _mesa_error(ctx, error, "%s(%s)", caller, reason);

   return error;
}
