/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file depth_peeling.c
 * State of GL_MESA_depth_peeling: the capability, and the rank of the first
 * layer of each framebuffer object.
 */

#include "main/depth_peeling.h"
#include "main/depth_peeling_validate.h"
#include "main/context.h"
#include "main/draw_validate.h"
#include "main/errors.h"
#include "main/fbobject.h"
#include "main/kbuffer.h"
#include "main/state.h"
#include "state_tracker/st_context.h"
#include "state_tracker/st_peel.h"

void
_mesa_enable_depth_peeling(struct gl_context *ctx, GLboolean state)
{
   if (ctx->DepthPeeling.Enabled == state)
      return;

   FLUSH_VERTICES(ctx, _mesa_new_advanced_blend_state(ctx), GL_ENABLE_BIT);
   ctx->DepthPeeling.Enabled = state;
   _mesa_depth_peeling_changed(ctx);
}

void
_mesa_depth_peeling_changed(struct gl_context *ctx)
{
   ctx->NewDriverState |= ST_NEW_BLEND;
   _mesa_update_valid_to_render_state(ctx);
   _mesa_update_allow_draw_out_of_order(ctx);
}

static void
start_over(struct gl_context *ctx, struct gl_framebuffer *fb)
{
   st_peel_start_over(ctx, fb);
   fb->Peeling.FirstLayer = 0;
}

static void
continue_at(struct gl_context *ctx, struct gl_framebuffer *fb, GLint layer,
            const char *func)
{
   struct gl_framebuffer_peeling *peeling = &fb->Peeling;
   struct gl_peel_order order;
   char reason[MAX_DRAW_REASON];

   if (fb->_Status == 0)
      _mesa_test_framebuffer_completeness(ctx, fb);

   if (fb->_Status != GL_FRAMEBUFFER_COMPLETE) {
      _mesa_error(ctx, GL_INVALID_OPERATION,
                  "%s(framebuffer is not complete)", func);
      return;
   }

   if (!_mesa_get_peel_order(ctx, fb, &order, reason) ||
       (peeling->FirstLayer != 0 &&
        !_mesa_check_peel_order(&order, peeling, reason))) {
      _mesa_error(ctx, GL_INVALID_OPERATION, "%s(%s)", func, reason);
      return;
   }

   if ((GLuint) layer != peeling->FirstLayer + order.NumLayers) {
      _mesa_error(ctx, GL_INVALID_VALUE, "%s(layer=%d, %d layers at %d)",
                  func, layer, order.NumLayers, peeling->FirstLayer);
      return;
   }

   if (_mesa_is_peeled_elsewhere(ctx, fb)) {
      _mesa_error(ctx, GL_INVALID_OPERATION,
                  "%s(framebuffer peeled by another context)", func);
      return;
   }

   if (!st_peel_continue(ctx, fb, &order)) {
      _mesa_error(ctx, GL_OUT_OF_MEMORY, "%s", func);
      return;
   }

   peeling->FirstLayer = layer;
   peeling->Order = order;
}

void
_mesa_set_first_peel_layer(struct gl_context *ctx, struct gl_framebuffer *fb,
                           GLint layer, const char *func)
{
   FLUSH_VERTICES(ctx, 0, 0);

   if (layer < 0)
      _mesa_error(ctx, GL_INVALID_VALUE, "%s(layer=%d)", func, layer);
   else if (layer == 0)
      start_over(ctx, fb);
   else
      continue_at(ctx, fb, layer, func);

   if (fb == ctx->DrawBuffer)
      _mesa_update_depth_peeling(ctx);
}

GLint
_mesa_get_peel_overflow(struct gl_context *ctx, struct gl_framebuffer *fb)
{
   FLUSH_VERTICES(ctx, 0, 0);

   return st_peel_overflow(ctx, fb);
}
