/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_kbuf_rast.h
 * The commands of a bin, in scenes that run k-buffer programs.
 */

#ifndef LP_KBUF_RAST_H
#define LP_KBUF_RAST_H

#include "util/macros.h"

#include "lp_rast.h"
#include "lp_scene.h"

struct lp_rasterizer_task;

/** Commands between the one that runs and the one whose data are fetched. */
#define LP_RAST_FETCH_DISTANCE 4


/*
 * GCC leaves calls of a function out that does nothing else, unless it is
 * made to inline it first.
 */
static ALWAYS_INLINE void
lp_rast_fetch(const void *data, unsigned size)
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
lp_rast_fetch_ahead(const struct cmd_block *block, unsigned k)
{
   if (k == 0 && block->next)
      lp_rast_fetch(block->next, sizeof *block->next);

   k += LP_RAST_FETCH_DISTANCE;
   if (k >= block->count) {
      k -= block->count;
      block = block->next;
      if (!block || k >= block->count)
         return;
   }

   /* A triangle with few attributes; other commands have less. */
   lp_rast_fetch(block->arg[k].triangle.tri, 256);
}


/** \param dispatch  what to do where k-buffers make no difference */
void
lp_kbuf_rasterize_bin(struct lp_rasterizer_task *task,
                      const struct cmd_bin *bin,
                      const lp_rast_cmd_func *dispatch);

#endif /* LP_KBUF_RAST_H */
