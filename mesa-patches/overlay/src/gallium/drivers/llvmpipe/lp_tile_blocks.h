/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_tile_blocks.h
 * The blocks of the tile store, and their way from and to the buffers.
 */

#ifndef LP_TILE_BLOCKS_H
#define LP_TILE_BLOCKS_H

#include <stddef.h>
#include <stdint.h>

#include "lp_tile_store.h"

/** The words of a layer of a block, in one sample. */
static inline uint32_t *
lp_tile_words(const struct lp_tile_store *store, unsigned block,
              unsigned layer, unsigned sample)
{
   return (uint32_t *)(store->data + (size_t)block * store->block_size +
                       (size_t)sample * store->sample_size +
                       layer * lp_tile_layer_size(store->layout));
}

/** The counts of the groups of a block, in one sample. */
static inline uint32_t *
lp_tile_counts(const struct lp_tile_store *store, unsigned block,
               unsigned sample)
{
   return &store->counts[(block * store->layout->num_samples + sample) *
                         LP_TILE_GROUPS];
}

/** The counts of what is in the buffers, see lp_layer_counts.h; or NULL. */
static inline uint16_t *
lp_tile_known_counts(const struct lp_tile_store *store, unsigned block,
                     unsigned sample)
{
   return store->known_counts ?
      &store->known_counts[(block * store->layout->num_samples + sample) *
                           LP_TILE_GROUPS] : NULL;
}

/** The count of the group that a quad is in. */
static inline uint32_t
lp_tile_quad_count(const struct lp_tile_store *store, unsigned block,
                   unsigned sample, unsigned quad)
{
   return lp_tile_counts(store, block, sample)[quad / store->group_quads];
}

/** Load all layers of a block, or clear them. */
void
lp_tile_load_block(struct lp_tile_store *store, uint32_t block);

/**
 * Load the depths of a block's last layer.  Of a frame that takes several
 * scenes only some blocks change in each: for the others this is all that is
 * needed.
 */
void
lp_tile_load_last(struct lp_tile_store *store, uint32_t block);

/** Store all blocks that have changed, or are to be cleared. */
void
lp_tile_store_blocks(struct lp_tile_store *store);

#endif /* LP_TILE_BLOCKS_H */
