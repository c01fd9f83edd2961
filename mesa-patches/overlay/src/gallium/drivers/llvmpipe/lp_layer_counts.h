/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_layer_counts.h
 * How many layers of each group of pixels differ, from one scene of a frame to
 * the next.
 *
 * A frame that does not fit in one scene is run as several.  Each of them
 * would have to load all layers of the blocks that it comes to; but most
 * layers of most blocks are the same, as there is nothing in them.  Nobody
 * else touches the layers between two scenes of a frame, so that the counts
 * of the tile store (lp_tile_store.h) still hold.
 */

#ifndef LP_LAYER_COUNTS_H
#define LP_LAYER_COUNTS_H

#include <stdint.h>

#include "util/u_inlines.h"

#include "lp_limits.h"

struct lp_scene;

/** The count of a group of which nothing is known. */
#define LP_UNKNOWN_COUNT UINT16_MAX

/** Referenced by the scenes of a frame. */
struct lp_layer_counts
{
   struct pipe_reference reference;
   unsigned tiles_x;
   unsigned tile_counts;  /**< counts of a tile */
   uint16_t counts[];     /**< of tile, block, sample, group */
};

static inline void
lp_layer_counts_reference(struct lp_layer_counts **dst,
                          struct lp_layer_counts *src)
{
   struct lp_layer_counts *old = *dst;

   if (pipe_reference(old ? &old->reference : NULL,
                      src ? &src->reference : NULL))
      free(old);
   *dst = src;
}

/** The counts of the tile with its first pixel at (x, y). */
static inline uint16_t *
lp_layer_counts_tile(struct lp_layer_counts *counts, unsigned x, unsigned y)
{
   const size_t tile = y / TILE_SIZE * counts->tiles_x + x / TILE_SIZE;

   return &counts->counts[tile * counts->tile_counts];
}

/**
 * The scene is full, and the frame goes on in another one.
 *
 * \return a reference for lp_layer_counts_continue(), or NULL
 */
struct lp_layer_counts *
lp_layer_counts_split(struct lp_scene *scene);

/**
 * \param scene   goes on where the one that was split ends, or NULL
 * \param counts  taken over
 */
void
lp_layer_counts_continue(struct lp_scene *scene,
                         struct lp_layer_counts *counts);

#endif /* LP_LAYER_COUNTS_H */
