/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_peel_rast.h"

#include <math.h>

#include "util/u_atomic.h"

#include "lp_kbuf_rast.h"
#include "lp_peel_tile.h"
#include "lp_rast_priv.h"
#include "lp_state_fs.h"


/**
 * The inputs of a command that is large enough for its depths to be worth a
 * look; small triangles are refused as cheaply by the generated code.
 */
static const struct lp_rast_shader_inputs *
large_inputs(unsigned cmd, const union lp_rast_cmd_arg arg)
{
   switch (cmd) {
   case LP_RAST_OP_SHADE_TILE:
   case LP_RAST_OP_SHADE_TILE_OPAQUE:
      return arg.shade_tile;
   case LP_RAST_OP_RECTANGLE:
      return &arg.rectangle->inputs;
   case LP_RAST_OP_TRIANGLE_3_4:
   case LP_RAST_OP_TRIANGLE_3_16:
   case LP_RAST_OP_TRIANGLE_4_16:
   case LP_RAST_OP_TRIANGLE_32_3_4:
   case LP_RAST_OP_TRIANGLE_32_3_16:
   case LP_RAST_OP_TRIANGLE_32_4_16:
   case LP_RAST_OP_MS_TRIANGLE_3_4:
   case LP_RAST_OP_MS_TRIANGLE_3_16:
   case LP_RAST_OP_MS_TRIANGLE_4_16:
   case LP_RAST_OP_BLIT:
      return NULL;
   default:
      return &arg.triangle.tri->inputs;
   }
}


/** The nearest that a plane comes in the tile, in comparable form. */
static int32_t
nearest_depth(const struct lp_rasterizer_task *task,
              const struct lp_peel_depth_format *format, bool restricted,
              const struct lp_rast_shader_inputs *inputs)
{
   const float offset = GET_A0(inputs)[0][0];
   const float a0 = GET_A0(inputs)[0][2];
   const float dadx = GET_DADX(inputs)[0][2];
   const float dady = GET_DADY(inputs)[0][2];

   /* Samples lie up to a pixel from where pixels do. */
   const float x0 = task->x, x1 = task->x + task->width;
   const float y0 = task->y, y1 = task->y + task->height;

   /* More than the generated code can lose by rounding. */
   const float error = (fabsf(a0) + fabsf(offset) +
                        fabsf(dadx) * x1 + fabsf(dady) * y1) * 0x1p-20f;
   float z;

   if (format->reversed) {
      z = a0 + dadx * (dadx > 0 ? x1 : x0) + dady * (dady > 0 ? y1 : y0) +
          offset + error;
   } else {
      z = a0 + dadx * (dadx > 0 ? x0 : x1) + dady * (dady > 0 ? y0 : y1) +
          offset - error;
   }
   if (!isfinite(z))
      return INT32_MIN;
   if (restricted)
      z = CLAMP(z, 0.0f, 1.0f);

   if (format->floating)
      return lp_peel_compare_bits(format, fui(z));

   const double max = (double)((UINT64_C(1) << format->width) - 1);
   const double bits = format->reversed ? ceil(z * max) + 1 :
                                          floor(z * max) - 1;
   return lp_peel_compare_bits(format, (uint32_t)CLAMP(bits, 0.0, max));
}


/** Whether no fragment of a command can be inserted. */
static bool
is_refused(struct lp_peel_tile *tile, unsigned cmd,
           const union lp_rast_cmd_arg arg)
{
   const struct lp_rasterizer_task *task = tile->task;
   const struct lp_fragment_shader_variant_key *key =
      &task->state->variant->key;
   const struct lp_rast_peel *peel = tile->peel;

   /* As long as nothing has overflowed each fragment has to be looked at. */
   if (!key->kbuf.peel.cull || key->depth_clamp ||
       !(tile->overflow || p_atomic_read(&peel->object->overflow)))
      return false;

   const struct lp_rast_shader_inputs *inputs = large_inputs(cmd, arg);
   if (!inputs)
      return false;

   const int32_t farthest =
      lp_peel_tile_farthest(tile, cmd == LP_RAST_OP_SHADE_TILE);
   if (farthest == INT32_MAX)
      return false;

   const int32_t nearest = nearest_depth(task, &peel->depth,
                                         key->restrict_depth_values, inputs);

   /* Those at the bound are counted. */
   return nearest > farthest ||
          (nearest == farthest && !key->kbuf.peel.equal && !peel->bounded);
}


void
lp_peel_rasterize_bin(struct lp_rasterizer_task *task,
                      const struct cmd_bin *bin,
                      const lp_rast_cmd_func *dispatch)
{
   struct lp_peel_tile *tile = lp_peel_tile_begin(task, dispatch);
   bool bypassed = false;  /* draws work on the buffers themselves */

   for (const struct cmd_block *block = bin->head; block; block = block->next) {
      for (unsigned k = 0; k < block->count; k++) {
         const unsigned cmd = block->cmd[k];
         const union lp_rast_cmd_arg arg = block->arg[k];

         lp_rast_fetch_ahead(block, k);
         switch (cmd) {
         case LP_RAST_OP_CLEAR_COLOR:
         case LP_RAST_OP_CLEAR_ZSTENCIL:
            if (bypassed)
               dispatch[cmd](task, arg);
            else
               lp_peel_tile_clear(tile, cmd, arg);
            break;
         case LP_RAST_OP_SET_STATE:
            dispatch[cmd](task, arg);
            lp_peel_tile_set_state(tile);
            bypassed = !tile->peel;
            break;
         case LP_RAST_OP_BEGIN_QUERY:
         case LP_RAST_OP_END_QUERY:
            dispatch[cmd](task, arg);
            break;
         default:
            if (!(tile->peel && is_refused(tile, cmd, arg)))
               dispatch[cmd](task, arg);
            break;
         }
      }
   }
   lp_peel_tile_end(tile);
}
