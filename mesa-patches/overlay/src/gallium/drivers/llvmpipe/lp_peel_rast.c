/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_peel_rast.h"

#include "lp_peel_tile.h"
#include "lp_rast_priv.h"


void
lp_peel_rasterize_bin(struct lp_rasterizer_task *task,
                      const struct cmd_bin *bin,
                      const lp_rast_cmd_func *dispatch)
{
   bool draw = true;

   for (const struct cmd_block *block = bin->head; block; block = block->next) {
      for (unsigned k = 0; k < block->count; k++) {
         const unsigned cmd = block->cmd[k];

         switch (cmd) {
         case LP_RAST_OP_CLEAR_COLOR:
         case LP_RAST_OP_CLEAR_ZSTENCIL:
            lp_peel_tile_done(task->thread_data.peel_tile);
            dispatch[cmd](task, block->arg[k]);
            break;
         case LP_RAST_OP_SET_STATE:
            dispatch[cmd](task, block->arg[k]);
            draw = lp_peel_tile_set_state(task);
            break;
         case LP_RAST_OP_BEGIN_QUERY:
         case LP_RAST_OP_END_QUERY:
            dispatch[cmd](task, block->arg[k]);
            break;
         default:
            if (draw)
               dispatch[cmd](task, block->arg[k]);
            break;
         }
      }
   }
   lp_peel_tile_done(task->thread_data.peel_tile);
}
