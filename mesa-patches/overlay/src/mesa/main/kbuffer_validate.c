/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer_validate.c
 * What the draw framebuffer offers as a k-buffer, and whether the bound
 * k-buffer program can run on it.
 */

#include <stdarg.h>
#include <stdio.h>

#include "main/enums.h"
#include "main/kbuffer.h"
#include "util/bitscan.h"
#include "util/macros.h"

bool
_mesa_refuse_draw(char *reason, const char *format, ...)
{
   if (reason) {
      va_list args;

      va_start(args, format);
      vsnprintf(reason, MAX_DRAW_REASON, format, args);
      va_end(args);
   }

   return false;
}

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

/** Whether each entry that the program names is there. */
static bool
check_entries(const struct gl_context *ctx, const struct gl_program *prog,
              char *reason)
{
   const struct gl_framebuffer *fb = ctx->DrawBuffer;
   const unsigned num_entries = _mesa_kbuffer_num_entries(ctx);
   const uint64_t named = prog->arb.KbufferRead | prog->arb.KbufferWritten;

   if (num_entries == 0)
      return _mesa_refuse_draw(reason, "no color draw buffer is a k-buffer");

   u_foreach_bit64(bit, named) {
      const unsigned entry = bit;
      const char *verb =
         prog->arb.KbufferWritten & BITFIELD64_BIT(entry) ? "writes" : "reads";

      if (entry >= num_entries) {
         return _mesa_refuse_draw(reason, "k-buffer program %u %s entry %u, "
                                  "the k-buffer has %u",
                                  prog->Id, verb, entry, num_entries);
      }

      const unsigned buffer = entry % fb->_NumColorDrawBuffers;

      if (!color_attachment(fb, buffer)) {
         return _mesa_refuse_draw(reason, "k-buffer program %u %s entry %u, "
                                  "which has no buffer: draw buffer %u is %s",
                                  prog->Id, verb, entry, buffer,
                                  _mesa_enum_to_string(
                                     fb->ColorDrawBuffer[buffer]));
      }
   }

   return true;
}

bool
_mesa_kbuffer_check_draw(const struct gl_context *ctx, char *reason)
{
   if (!ctx->Kbuffer.Enabled)
      return true;

   const struct gl_program *prog = _mesa_kbuffer_program(ctx);

   if (!prog) {
      return _mesa_refuse_draw(reason, "k-buffer program %u is not valid",
                               ctx->Kbuffer.Current->Id);
   }
   if (!prog->kbuffer) {
      return _mesa_refuse_draw(reason, "no memory for k-buffer program %u",
                               prog->Id);
   }

   const struct gl_framebuffer *fb = ctx->DrawBuffer;

   if (fb->_IntegerDrawBuffers) {
      return _mesa_refuse_draw(reason, "k-buffer program %u with integers in "
                               "draw buffer %d",
                               prog->Id, ffs(fb->_IntegerDrawBuffers) - 1);
   }
   if (draw_buffer_is_ambiguous(fb)) {
      return _mesa_refuse_draw(reason, "k-buffer program %u with %s, which "
                               "stands for several color buffers", prog->Id,
                               _mesa_enum_to_string(fb->ColorDrawBuffer[0]));
   }

   return check_entries(ctx, prog, reason);
}
