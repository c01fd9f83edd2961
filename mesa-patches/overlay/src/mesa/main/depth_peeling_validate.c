/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file depth_peeling_validate.c
 * Whether framebuffers have layers to peel into, and whether a draw may.
 */

#include "main/depth_peeling.h"
#include "state_tracker/st_context.h"
#include "state_tracker/st_peel.h"

/** Layers of an attachment that depth peeling can use, else 0. */
static unsigned
num_layers(const struct gl_renderbuffer_attachment *att)
{
   if (!att->Layered || !att->Texture || !att->Renderbuffer ||
       (att->Texture->Target != GL_TEXTURE_2D_ARRAY &&
        att->Texture->Target != GL_TEXTURE_2D_MULTISAMPLE_ARRAY))
      return 0;

   return att->Renderbuffer->Depth;
}

bool
_mesa_get_peel_order(const struct gl_context *ctx,
                     const struct gl_framebuffer *fb,
                     struct gl_peel_order *order)
{
   const struct gl_renderbuffer_attachment *att = &fb->Attachment[BUFFER_DEPTH];
   const unsigned layers = num_layers(att);

   if (layers == 0 || layers > ctx->Const.MaxDepthPeelingLayers)
      return false;

   order->DepthFunc = ctx->Depth.Func;
   order->Format = att->Renderbuffer->Format;
   order->Width = att->Renderbuffer->Width;
   order->Height = att->Renderbuffer->Height;
   order->NumLayers = layers;
   order->NumSamples = att->Renderbuffer->NumSamples;

   return true;
}

bool
_mesa_peel_orders_equal(const struct gl_peel_order *a,
                        const struct gl_peel_order *b)
{
   return a->DepthFunc == b->DepthFunc &&
          a->Format == b->Format &&
          a->Width == b->Width &&
          a->Height == b->Height &&
          a->NumLayers == b->NumLayers &&
          a->NumSamples == b->NumSamples;
}

static bool
draw_buffers_have_layers(const struct gl_framebuffer *fb, unsigned layers)
{
   for (unsigned i = 0; i < fb->_NumColorDrawBuffers; i++) {
      const gl_buffer_index buffer = fb->_ColorDrawBufferIndexes[i];

      if (buffer != BUFFER_NONE &&
          fb->Attachment[buffer].Type != GL_NONE &&
          num_layers(&fb->Attachment[buffer]) != layers)
         return false;
   }

   return true;
}

bool
_mesa_depth_peeling_valid(const struct gl_context *ctx)
{
   const struct gl_framebuffer *fb = ctx->DrawBuffer;
   struct gl_peel_order order;

   if (ctx->Stencil.Enabled || ctx->Kbuffer.Enabled)
      return false;

   switch (ctx->Depth.Func) {
   case GL_LESS:
   case GL_LEQUAL:
   case GL_GREATER:
   case GL_GEQUAL:
      break;
   default:
      return false;
   }

   if (!fb || !_mesa_get_peel_order(ctx, fb, &order) ||
       !draw_buffers_have_layers(fb, order.NumLayers))
      return false;

   return fb->Peeling.FirstLayer == 0 ||
          (_mesa_can_continue_peeling(&order) &&
           _mesa_peel_orders_equal(&order, &fb->Peeling.Order));
}

bool
_mesa_depth_peeling_valid_to_render(struct gl_context *ctx)
{
   if (!ctx->DepthPeeling.Enabled)
      return true;

   if (!_mesa_depth_peeling_valid(ctx) ||
       !st_peel_owns_object(ctx, ctx->DrawBuffer))
      return false;

   if (!st_peel_create_object(ctx, ctx->DrawBuffer)) {
      ctx->DrawGLError = GL_OUT_OF_MEMORY;
      return false;
   }

   return true;
}
