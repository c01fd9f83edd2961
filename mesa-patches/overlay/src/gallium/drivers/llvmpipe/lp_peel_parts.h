/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_peel_parts.h
 * What is known of the layers from one part of a frame to the next.
 *
 * A frame that does not fit in one scene is run in parts.  Each of them would
 * have to load all layers of the blocks that it comes to; but most layers of
 * most blocks are the same, as there is nothing in them.  Nobody else touches
 * the layers between two parts, so that the counts of lp_peel_tile.h still
 * hold.
 */

#ifndef LP_PEEL_PARTS_H
#define LP_PEEL_PARTS_H

#include <stdint.h>

#include "util/u_inlines.h"

#include "lp_limits.h"

struct lp_scene;

/** The count of a group of which nothing is known. */
#define LP_PEEL_UNKNOWN_COUNT UINT16_MAX

/** Referenced by the scenes that are the parts of a frame. */
struct lp_peel_parts
{
   struct pipe_reference reference;
   unsigned tiles_x;
   unsigned tile_counts;  /**< counts of a tile */
   uint16_t counts[];     /**< of tile, block, sample, group */
};

static inline void
lp_peel_parts_reference(struct lp_peel_parts **dst, struct lp_peel_parts *src)
{
   struct lp_peel_parts *old = *dst;

   if (pipe_reference(old ? &old->reference : NULL,
                      src ? &src->reference : NULL))
      free(old);
   *dst = src;
}

/** The counts of the tile with its first pixel at (x, y). */
static inline uint16_t *
lp_peel_parts_tile(struct lp_peel_parts *parts, unsigned x, unsigned y)
{
   const size_t tile = y / TILE_SIZE * parts->tiles_x + x / TILE_SIZE;

   return &parts->counts[tile * parts->tile_counts];
}

/**
 * The scene is full, and the frame goes on in another one.
 *
 * \return a reference for lp_peel_continue_scene(), or NULL
 */
struct lp_peel_parts *
lp_peel_split_scene(struct lp_scene *scene);

/**
 * \param scene  goes on where the one that was split ends, or NULL
 * \param parts  taken over
 */
void
lp_peel_continue_scene(struct lp_scene *scene, struct lp_peel_parts *parts);

#endif /* LP_PEEL_PARTS_H */
