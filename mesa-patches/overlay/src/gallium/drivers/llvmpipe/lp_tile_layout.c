/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_tile_layout.h"

#include <string.h>

#include "util/format/u_format.h"
#include "util/u_math.h"


void
lp_tile_layout_init(struct lp_tile_layout *layout, bool has_depth,
                    unsigned num_samples, unsigned num_layers,
                    unsigned num_color_buffers,
                    const enum pipe_format *formats, unsigned num_formats)
{
   /* Layouts are compared as a whole. */
   memset(layout, 0, sizeof *layout);
   layout->has_depth = has_depth;
   layout->num_samples = num_samples;
   layout->num_layers = num_layers;
   layout->num_color_buffers = num_color_buffers;
   layout->num_words = has_depth;
   for (unsigned i = 0; i < MIN2(num_color_buffers, num_formats); i++) {
      if (formats[i] != PIPE_FORMAT_NONE) {
         layout->color_words[i] =
            DIV_ROUND_UP(util_format_get_blocksizebits(formats[i]), 32);
         layout->num_words += layout->color_words[i];
      }
   }
}


void
lp_tile_layout_init_fb(struct lp_tile_layout *layout, bool has_depth,
                       unsigned num_samples, unsigned num_layers,
                       unsigned num_color_buffers,
                       const struct pipe_framebuffer_state *fb)
{
   enum pipe_format formats[PIPE_MAX_COLOR_BUFS];

   for (unsigned i = 0; i < fb->nr_cbufs; i++)
      formats[i] = fb->cbufs[i] ? fb->cbufs[i]->format : PIPE_FORMAT_NONE;
   lp_tile_layout_init(layout, has_depth, num_samples, num_layers,
                       num_color_buffers, formats, fb->nr_cbufs);
}


unsigned
lp_tile_color_word(const struct lp_tile_layout *layout, unsigned cbuf)
{
   unsigned word = layout->has_depth;

   for (unsigned i = 0; i < cbuf; i++)
      word += layout->color_words[i];
   return word;
}
