/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "main/depth_peeling_validate.h"
#include "main/enums.h"
#include "main/kbuffer.h"

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
                     struct gl_peel_order *order, char *reason)
{
   const struct gl_renderbuffer_attachment *att = &fb->Attachment[BUFFER_DEPTH];
   const unsigned layers = num_layers(att);

   if (fb->Name == 0) {
      return _mesa_refuse_draw(reason,
                               "depth peeling in the default framebuffer");
   }
   if (layers == 0) {
      return _mesa_refuse_draw(reason, "depth peeling without a layered 2D "
                               "array as depth attachment");
   }
   if (layers > ctx->Const.MaxDepthPeelingLayers) {
      return _mesa_refuse_draw(reason, "depth peeling with %u layers, at most "
                               "%u are possible", layers,
                               ctx->Const.MaxDepthPeelingLayers);
   }

   order->DepthFunc = ctx->Depth.Func;
   order->Format = att->Renderbuffer->Format;
   order->Width = att->Renderbuffer->Width;
   order->Height = att->Renderbuffer->Height;
   order->NumLayers = layers;
   order->NumSamples = att->Renderbuffer->NumSamples;

   return true;
}

bool
_mesa_check_peel_order(const struct gl_peel_order *order,
                       const struct gl_framebuffer_peeling *peeling,
                       char *reason)
{
   const struct gl_peel_order *before = &peeling->Order;
   const char *what;

   if (order->DepthFunc != before->DepthFunc)
      what = "glDepthFunc";
   else if (order->Format != before->Format)
      what = "the format of the depth attachment";
   else if (order->Width != before->Width || order->Height != before->Height)
      what = "the size of the depth attachment";
   else if (order->NumLayers != before->NumLayers)
      what = "the number of layers";
   else if (order->NumSamples != before->NumSamples)
      what = "the number of samples";
   else
      return true;

   return _mesa_refuse_draw(reason, "depth peeling from layer %d on: %s has "
                            "changed since that was set",
                            peeling->FirstLayer, what);
}

static bool
check_draw_buffers(const struct gl_framebuffer *fb, unsigned layers,
                   char *reason)
{
   for (unsigned i = 0; i < fb->_NumColorDrawBuffers; i++) {
      const gl_buffer_index buffer = fb->_ColorDrawBufferIndexes[i];

      if (buffer == BUFFER_NONE || fb->Attachment[buffer].Type == GL_NONE)
         continue;

      const unsigned found = num_layers(&fb->Attachment[buffer]);

      if (found == 0) {
         return _mesa_refuse_draw(reason, "depth peeling without a layered 2D "
                                  "array in draw buffer %u", i);
      }
      if (found != layers) {
         return _mesa_refuse_draw(reason, "depth peeling with %u layers of "
                                  "depth and %u in draw buffer %u",
                                  layers, found, i);
      }
   }

   return true;
}

bool
_mesa_check_peel_draw(const struct gl_context *ctx, char *reason)
{
   const struct gl_framebuffer *fb = ctx->DrawBuffer;
   const struct gl_framebuffer_peeling *peeling = &fb->Peeling;
   struct gl_peel_order order;

   if (!ctx->DepthPeeling.Enabled)
      return true;

   if (ctx->Stencil.Enabled)
      return _mesa_refuse_draw(reason, "depth peeling with GL_STENCIL_TEST");
   if (ctx->Kbuffer.Enabled) {
      return _mesa_refuse_draw(reason,
                               "depth peeling with GL_KBUFFER_PROGRAM_MESA");
   }

   switch (ctx->Depth.Func) {
   case GL_LESS:
   case GL_LEQUAL:
   case GL_GREATER:
   case GL_GEQUAL:
      break;
   default:
      return _mesa_refuse_draw(reason, "depth peeling with glDepthFunc(%s)",
                               _mesa_enum_to_string(ctx->Depth.Func));
   }

   if (!_mesa_get_peel_order(ctx, fb, &order, reason) ||
       !check_draw_buffers(fb, order.NumLayers, reason))
      return false;

   if (peeling->FirstLayer != 0) {
      if (!_mesa_check_peel_order(&order, peeling, reason))
         return false;
      if (!_mesa_can_continue_peeling(&order)) {
         return _mesa_refuse_draw(reason, "depth peeling from layer %d on with "
                                  "glDepthFunc(%s)", peeling->FirstLayer,
                                  _mesa_enum_to_string(ctx->Depth.Func));
      }
   }

   if (_mesa_is_peeled_elsewhere(ctx, fb)) {
      return _mesa_refuse_draw(reason, "depth peeling in a framebuffer that "
                               "another context peels into");
   }

   return true;
}
