/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_tile_store.h
 * The layers of the tile that a thread works on, for k-buffer programs and for
 * depth peeling.
 *
 * All layers of a pixel are read and written together, but in the buffers of
 * the framebuffer they lie whole images apart, mostly at the same offset in a
 * page, where a few of them already evict each other from the cache.  Here a
 * block of 4x4 pixels has all its values side by side, as vectors that the
 * generated code uses without shuffles: block, sample, layer, word of the pixel
 * (lp_tile_layout.h), quad, pixel of the quad.
 *
 * A block is loaded when the first fragment comes to it (lp_tile_blocks.h),
 * and stored before anything else can look at the buffers: at the end of the
 * tile, and where the state is no longer that of draws that keep their
 * fragments here.
 *
 * Clears are only noted.  They are done to the blocks as these come into use,
 * and to the buffers at the end, together with all other writing.
 *
 * Depth peeling has a count for each group of pixels: all layers behind that
 * one are equal to it, and are not there.  So nothing has to be done to layers
 * that have been cleared, until something comes into them.
 */

#ifndef LP_TILE_STORE_H
#define LP_TILE_STORE_H

#include <stdbool.h>
#include <stdint.h>

#include "lp_kbuf.h"
#include "lp_rast.h"
#include "lp_scene.h"
#include "lp_tile_layout.h"

struct lp_rasterizer;
struct lp_rasterizer_task;

/** Groups of a block, in which the generated code works: one of each quad. */
#define LP_TILE_GROUPS 4

/** What the store has of a block. */
enum lp_tile_valid
{
   LP_TILE_NOTHING = 0,
   LP_TILE_LAST,  /**< the depths of the last layer, to refuse fragments */
   LP_TILE_ALL,
};

enum lp_tile_changed
{
   LP_TILE_CHANGED = 1,  /**< different from the buffers */
   LP_TILE_UNKNOWN = 2,  /**< block_farthest does not hold */
};

/** What is to be cleared before anything else. */
struct lp_tile_clears
{
   uint32_t colors;  /**< a bit for each color buffer */
   bool depth;
   union lp_rast_cmd_arg color[PIPE_MAX_COLOR_BUFS];
   union lp_rast_cmd_arg zstencil;
};

struct lp_tile_store
{
   /* Used by generated code. */
   uint8_t *data;
   uint32_t *counts;      /**< of block, sample, group; behind the data */
   void (*load_block)(struct lp_tile_store *store, uint32_t block);
   void (*load_last)(struct lp_tile_store *store, uint32_t block);
   const struct lp_jit_kbuf *kbuf;  /**< what k-buffer programs read */
   uint32_t block_size;   /**< in bytes */
   uint32_t sample_size;
   uint32_t last_layer;
   int32_t empty;
   struct lp_peel_bound *bounds;  /**< of the first block */
   uint32_t bound_blocks_x;
   uint32_t overflow;
   uint8_t valid[LP_TILE_BLOCKS];    /**< of enum lp_tile_valid */
   uint8_t changed[LP_TILE_BLOCKS];  /**< of enum lp_tile_changed */

   struct lp_rasterizer_task *task;
   const lp_rast_cmd_func *dispatch;     /**< works on the buffers */
   const struct lp_tile_layout *layout;  /**< NULL: no block is valid */
   const struct lp_rast_peel *peel;      /**< NULL: not peeling */
   bool bypassed;                        /**< draws work on the buffers */
   unsigned num_valid;                   /**< blocks of which there is something */
   unsigned group_quads;                 /**< of the fragment functions that run */
   uint64_t written;                     /**< entries that programs store to */
   struct lp_tile_clears clears;

   /* See lp_peel_reject.c. */
   int32_t block_farthest[LP_TILE_BLOCKS];
   int32_t farthest;
   unsigned farthest_age;

   /** The counts of what is in the buffers (lp_layer_counts.h), or NULL. */
   uint16_t *known_counts;
   size_t known_counts_size;  /**< in bytes */

   uint8_t *spare;    /**< a larger one for data and counts, or NULL */
   size_t reserved;   /**< bytes of the largest one; not the thread's */
};

/**
 * Have room in the stores of all threads, before a state is used that needs it;
 * with the rasterizer's mutex held.
 *
 * \param block_size  bytes of a block
 * \return false if there is no memory
 */
bool
lp_tile_stores_reserve(struct lp_rasterizer *rast, size_t block_size,
                       unsigned num_samples);

void
lp_tile_stores_destroy(struct lp_rasterizer *rast);

/**
 * The store of the task, for a new bin.
 *
 * \param dispatch  does to the buffers what the store does not do
 */
struct lp_tile_store *
lp_tile_store_begin(struct lp_rasterizer_task *task,
                    const lp_rast_cmd_func *dispatch);

/** Get ready for the state that the task has. */
void
lp_tile_store_set_state(struct lp_tile_store *store);

/** Clear a color buffer, or depth and stencil. */
void
lp_tile_store_clear(struct lp_tile_store *store, unsigned cmd,
                    const union lp_rast_cmd_arg arg);

/** At the end of a bin, store everything and do the clears that were noted. */
void
lp_tile_store_end(struct lp_tile_store *store);

#endif /* LP_TILE_STORE_H */
