/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_tile_rast.h"

#include "util/macros.h"

#include "lp_peel_reject.h"
#include "lp_rast_priv.h"
#include "lp_tile_store.h"

/** Commands between the one that runs and the one whose data are fetched. */
#define FETCH_DISTANCE 4


/*
 * GCC leaves calls of a function out that does nothing else, unless it is
 * made to inline it first.
 */
static ALWAYS_INLINE void
fetch(const void *data, unsigned size)
{
#ifdef __GNUC__
   /* There may be nothing, of which pointers to parts would be undefined. */
   const uintptr_t address = (uintptr_t)data;

   for (unsigned i = 0; i < size; i += 64)
      __builtin_prefetch((const void *)(address + i));
#endif
}


/**
 * Fetch the commands after those of a block, and what a command points to that
 * is soon to run.
 *
 * The triangles of a bin lie in the order of drawing among those of all other
 * bins, and so do its commands.  Where triangles cover only a few pixels each,
 * waiting for them would take as long as rasterizing them.
 */
static ALWAYS_INLINE void
fetch_ahead(const struct cmd_block *block, unsigned k)
{
   if (k == 0 && block->next)
      fetch(block->next, sizeof *block->next);

   k += FETCH_DISTANCE;
   if (k >= block->count) {
      k -= block->count;
      block = block->next;
      if (!block || k >= block->count)
         return;
   }

   /* A triangle with few attributes; other commands have less. */
   fetch(block->arg[k].triangle.tri, 256);
}


void
lp_tile_rasterize_bin(struct lp_rasterizer_task *task,
                      const struct cmd_bin *bin,
                      const lp_rast_cmd_func *dispatch)
{
   struct lp_tile_store *store = lp_tile_store_begin(task, dispatch);

   for (const struct cmd_block *block = bin->head; block; block = block->next) {
      for (unsigned k = 0; k < block->count; k++) {
         const unsigned cmd = block->cmd[k];
         const union lp_rast_cmd_arg arg = block->arg[k];

         fetch_ahead(block, k);
         switch (cmd) {
         case LP_RAST_OP_CLEAR_COLOR:
         case LP_RAST_OP_CLEAR_ZSTENCIL:
            lp_tile_store_clear(store, cmd, arg);
            break;
         case LP_RAST_OP_SET_STATE:
            dispatch[cmd](task, arg);
            lp_tile_store_set_state(store);
            break;
         case LP_RAST_OP_BEGIN_QUERY:
         case LP_RAST_OP_END_QUERY:
            dispatch[cmd](task, arg);
            break;
         default:
            if (!store->peel || !lp_peel_is_rejected(store, cmd, arg))
               dispatch[cmd](task, arg);
            break;
         }
      }
   }
   lp_tile_store_end(store);
}
