/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_peel_blocks.h
 * The blocks of a tile (lp_peel_tile.h), and their way from and to memory.
 */

#ifndef LP_PEEL_BLOCKS_H
#define LP_PEEL_BLOCKS_H

#include <stddef.h>
#include <stdint.h>

#include "lp_peel_tile.h"

/** One layer of a sample of a block. */
static inline uint32_t *
lp_peel_tile_words(const struct lp_peel_tile *tile, unsigned block,
                   unsigned layer, unsigned sample)
{
   const size_t layer_size = tile->peel->num_words * LP_PEEL_WORD_SIZE;

   return (uint32_t *)(tile->data + (size_t)block * tile->block_size +
                       (size_t)sample * tile->sample_size +
                       layer * layer_size);
}

/** The counts of the groups. */
static inline uint32_t *
lp_peel_sample_counts(const struct lp_peel_tile *tile, unsigned block,
                      unsigned sample)
{
   return &tile->counts[(block * tile->peel->num_samples + sample) *
                        LP_PEEL_GROUPS];
}

/** The same of what is in memory, see lp_peel_parts.h; or NULL. */
static inline uint16_t *
lp_peel_part_counts(const struct lp_peel_tile *tile, unsigned block,
                    unsigned sample)
{
   return tile->part ?
      &tile->part[(block * tile->peel->num_samples + sample) *
                  LP_PEEL_GROUPS] : NULL;
}

/** The count of the group that a quad is in. */
static inline uint32_t
lp_peel_quad_count(const struct lp_peel_tile *tile, unsigned block,
                   unsigned sample, unsigned quad)
{
   return lp_peel_sample_counts(tile, block, sample)
             [quad / tile->group_quads];
}

/** All layers of a block, cleared or from memory. */
void
lp_peel_load_block(struct lp_peel_tile *tile, uint32_t block);

/**
 * The depths of its last layer.  A scene that is too large is run in parts, in
 * each of which only some of the blocks change: for the others this is all
 * that is needed.
 */
void
lp_peel_load_last(struct lp_peel_tile *tile, uint32_t block);

/** All blocks that have changed, or are to be cleared. */
void
lp_peel_store_blocks(struct lp_peel_tile *tile);

#endif /* LP_PEEL_BLOCKS_H */
