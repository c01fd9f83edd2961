/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_kbuf_rast.h"

#include "util/u_atomic.h"

#include "lp_kbuf_tile.h"
#include "lp_rast_priv.h"


void
lp_kbuf_rasterize_bin(struct lp_rasterizer_task *task,
                      const struct cmd_bin *bin,
                      const lp_rast_cmd_func *dispatch)
{
   struct lp_kbuf_tile *tile = p_atomic_read(&task->thread_data.kbuf_tile);

   lp_kbuf_tile_begin(tile, dispatch[LP_RAST_OP_CLEAR_COLOR]);

   for (const struct cmd_block *block = bin->head; block; block = block->next) {
      for (unsigned k = 0; k < block->count; k++) {
         const unsigned cmd = block->cmd[k];
         const union lp_rast_cmd_arg arg = block->arg[k];

         lp_rast_fetch_ahead(block, k);
         if (cmd != LP_RAST_OP_CLEAR_COLOR ||
             !lp_kbuf_tile_clear(tile, arg.clear_rb))
            dispatch[cmd](task, arg);
      }
   }
}
