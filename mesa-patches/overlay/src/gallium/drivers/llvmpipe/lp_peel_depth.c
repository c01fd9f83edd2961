/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_peel_depth.h"

#include <assert.h>
#include <string.h>

#include "util/format/u_format.h"
#include "util/u_pack_color.h"


void
lp_peel_depth_format_init(struct lp_peel_depth_format *depth,
                          enum pipe_format format, bool reversed)
{
   const struct util_format_description *desc =
      util_format_description(format);
   const struct util_format_channel_description *chan =
      &desc->channel[desc->swizzle[0]];

   assert(util_format_has_depth(desc));
   memset(depth, 0, sizeof *depth);
   depth->floating = chan->type == UTIL_FORMAT_TYPE_FLOAT;
   depth->reversed = reversed;
   depth->has_stencil = util_format_has_stencil(desc);
   depth->bytes = desc->block.bits / 8;
   depth->width = chan->size;
   depth->shift = chan->shift;
   assert(depth->width + depth->shift <= 32);

   /* Integers in two's complement sort as they are, floats by their sign. */
   if (depth->floating)
      depth->flip = 0x7fffffff;
   else if (depth->width == 32)
      depth->invert = 0x80000000;
   if (reversed)
      depth->invert ^= 0xffffffff;
}


int32_t
lp_peel_compare_depth(const struct lp_peel_depth_format *format,
                      enum pipe_format pipe_format, double depth)
{
   uint64_t value = util_pack64_z_stencil(pipe_format, depth, 0);

   return lp_peel_compare_bits(format, (value >> format->shift) &
                                       lp_peel_depth_mask(format));
}
