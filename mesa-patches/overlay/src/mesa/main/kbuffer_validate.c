/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer_validate.c
 * What the draw framebuffer offers as a k-buffer, and whether the bound
 * k-buffer program can run on it.
 */

#include "main/kbuffer.h"
#include "util/bitscan.h"
#include "util/macros.h"

/** What draw buffer i writes to, or NULL for a GL_NONE or empty one. */
static const struct gl_renderbuffer_attachment *
color_attachment(const struct gl_framebuffer *fb, unsigned i)
{
   const gl_buffer_index buffer = fb->_ColorDrawBufferIndexes[i];

   if (buffer == BUFFER_NONE || !fb->Attachment[buffer].Renderbuffer)
      return NULL;

   return &fb->Attachment[buffer];
}

static unsigned
num_layers(const struct gl_renderbuffer_attachment *att)
{
   if (!att->Layered)
      return 1;

   switch (att->Texture->Target) {
   case GL_TEXTURE_CUBE_MAP:
      return 6;
   case GL_TEXTURE_1D_ARRAY:
      return att->Renderbuffer->Height;
   default:
      return att->Renderbuffer->Depth;
   }
}

unsigned
_mesa_kbuffer_num_entries(const struct gl_context *ctx)
{
   const struct gl_framebuffer *fb = ctx->DrawBuffer;
   const unsigned num_buffers = fb->_NumColorDrawBuffers;
   unsigned layers = 0;

   for (unsigned i = 0; i < num_buffers; i++) {
      const struct gl_renderbuffer_attachment *att = color_attachment(fb, i);

      if (att)
         layers = layers ? MIN2(layers, num_layers(att)) : num_layers(att);
   }

   return MIN2(num_buffers * layers, ctx->Const.MaxKbufferEntries);
}

/** Whether glDrawBuffer selected several buffers, as GL_FRONT_AND_BACK does. */
static bool
draw_buffer_is_ambiguous(const struct gl_framebuffer *fb)
{
   /* Their number is what glDrawBuffers counts up to a last one that is not
    * GL_NONE; glDrawBuffer has nothing behind the first.
    */
   return fb->_NumColorDrawBuffers > 1 &&
          fb->ColorDrawBuffer[fb->_NumColorDrawBuffers - 1] == GL_NONE;
}

bool
_mesa_kbuffer_valid_to_render(const struct gl_context *ctx)
{
   if (!ctx->Kbuffer.Enabled)
      return true;

   const struct gl_program *prog = _mesa_kbuffer_program(ctx);

   /* The string is invalid, or the driver was out of memory for it. */
   if (!prog || !prog->kbuffer)
      return false;

   const struct gl_framebuffer *fb = ctx->DrawBuffer;

   if (fb->_IntegerDrawBuffers || draw_buffer_is_ambiguous(fb))
      return false;

   const unsigned num_entries = _mesa_kbuffer_num_entries(ctx);
   const uint64_t named = prog->arb.KbufferRead | prog->arb.KbufferWritten;

   if (num_entries == 0 || util_last_bit64(named) > num_entries)
      return false;

   u_foreach_bit64(entry, named) {
      if (!color_attachment(fb, entry % fb->_NumColorDrawBuffers))
         return false;
   }

   return true;
}
