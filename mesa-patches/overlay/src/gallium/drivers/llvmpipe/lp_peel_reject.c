/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_peel_reject.h"

#include <math.h>

#include "util/u_atomic.h"
#include "util/u_math.h"

#include "lp_rast_priv.h"
#include "lp_state_fs.h"
#include "lp_tile_blocks.h"
#include "lp_tile_store.h"


/**
 * Fragments at this depth or farther can not be inserted anywhere in the
 * block; INT32_MAX if there is no such depth.
 */
static int32_t
block_farthest(struct lp_tile_store *store, unsigned block)
{
   if (!store->valid[block])
      return INT32_MAX;
   if (!(store->changed[block] & LP_TILE_UNKNOWN))
      return store->block_farthest[block];

   int32_t farthest = INT32_MIN;
   for (unsigned s = 0; s < store->layout->num_samples; s++) {
      for (unsigned q = 0; q < 4; q++) {
         const uint32_t last = lp_tile_quad_count(store, block, s, q);
         const int32_t *depths =
            (int32_t *)lp_tile_words(store, block, last, s) + 4 * q;

         for (unsigned i = 0; i < 4; i++)
            farthest = MAX2(farthest, depths[i]);
      }
   }
   if (farthest >= store->empty)
      farthest = INT32_MAX;
   store->block_farthest[block] = farthest;
   store->changed[block] &= ~LP_TILE_UNKNOWN;
   return farthest;
}


/**
 * The same for the whole tile.
 *
 * \param exact  find the nearest such depth, which takes some time
 */
static int32_t
tile_farthest(struct lp_tile_store *store, bool exact)
{
   const struct lp_rasterizer_task *task = store->task;
   int32_t farthest = INT32_MIN;

   /* It only gets nearer, so that an old one is right, too. */
   if (!exact && store->farthest_age++ % 16)
      return store->farthest;

   for (unsigned y = 0; y < DIV_ROUND_UP(task->height, 4); y++) {
      for (unsigned x = 0; x < DIV_ROUND_UP(task->width, 4); x++) {
         const int32_t f = block_farthest(store, y * (TILE_SIZE / 4) + x);

         farthest = MAX2(farthest, f);
         if (farthest == INT32_MAX)
            return farthest;
      }
   }
   return store->farthest = farthest;
}


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


bool
lp_peel_is_rejected(struct lp_tile_store *store, unsigned cmd,
                    const union lp_rast_cmd_arg arg)
{
   const struct lp_rasterizer_task *task = store->task;
   const struct lp_fragment_shader_variant_key *key =
      &task->state->variant->key;
   const struct lp_rast_peel *peel = store->peel;

   /* As long as nothing has overflowed each fragment has to be looked at. */
   if (!key->kbuf.peel.cull || key->depth_clamp ||
       !(store->overflow || p_atomic_read(&peel->object->overflow)))
      return false;

   const struct lp_rast_shader_inputs *inputs = large_inputs(cmd, arg);
   if (!inputs)
      return false;

   const int32_t farthest =
      tile_farthest(store, cmd == LP_RAST_OP_SHADE_TILE);
   if (farthest == INT32_MAX)
      return false;

   const int32_t nearest = nearest_depth(task, &peel->depth,
                                         key->restrict_depth_values, inputs);

   /* Those at the bound are counted. */
   return nearest > farthest ||
          (nearest == farthest && !key->kbuf.peel.equal && !peel->bounded);
}
