/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_peel_tile.h
 * The layers of the tile that a thread works on.
 *
 * As in lp_kbuf_tile.h a block of 4x4 pixels has all of its values side by
 * side, as vectors that the generated code uses without shuffles: block,
 * sample, layer, word (the depth in comparable form, then the colors as they
 * are stored), quad, pixel of the quad.
 *
 * For each group of pixels there is a count: all layers behind that one are
 * the same as it, and are not there.  So nothing has to be done to layers
 * that have been cleared, until something comes into them.
 *
 * Clears are only noted.  They are done to the tile's blocks as these come
 * into use, and to memory at the end, together with all other writing.
 */

#ifndef LP_PEEL_TILE_H
#define LP_PEEL_TILE_H

#include <stdbool.h>
#include <stdint.h>

#include "util/macros.h"

#include "lp_limits.h"
#include "lp_peel.h"
#include "lp_rast.h"
#include "lp_scene.h"

struct lp_rasterizer;
struct lp_rasterizer_task;

#define LP_PEEL_TILE_BLOCKS ((TILE_SIZE / 4) * (TILE_SIZE / 4))

/** Bytes of a word of the 16 pixels of a block. */
#define LP_PEEL_WORD_SIZE (16 * sizeof(uint32_t))

/** Groups of a block, in which the generated code works: one of each quad. */
#define LP_PEEL_GROUPS 4

/** What the tile has of a block. */
enum lp_peel_valid
{
   LP_PEEL_NOTHING = 0,
   LP_PEEL_LAST,  /**< the depths of the last layer, to refuse fragments */
   LP_PEEL_ALL,
};

enum lp_peel_changed
{
   LP_PEEL_CHANGED = 1,  /**< different from the buffers */
   LP_PEEL_UNKNOWN = 2,  /**< block_farthest does not hold */
};

struct lp_peel_tile
{
   /* Used by generated code. */
   uint8_t *data;
   uint32_t *counts;      /**< of block, sample, group; behind the data */
   void (*load_block)(struct lp_peel_tile *tile, uint32_t block);
   void (*load_last)(struct lp_peel_tile *tile, uint32_t block);
   uint32_t block_size;   /**< in bytes */
   uint32_t sample_size;
   uint32_t last_layer;
   int32_t empty;
   struct lp_peel_bound *bounds;  /**< of the first block */
   uint32_t bound_blocks_x;
   uint32_t overflow;
   uint8_t valid[LP_PEEL_TILE_BLOCKS];    /**< of enum lp_peel_valid */
   uint8_t changed[LP_PEEL_TILE_BLOCKS];  /**< of enum lp_peel_changed */

   struct lp_rasterizer_task *task;
   const lp_rast_cmd_func *dispatch;
   const struct lp_rast_peel *peel;  /**< NULL: no block is valid */
   unsigned group_quads;  /**< of the fragment functions that run */
   unsigned num_valid;  /**< blocks of which there is something */
   int32_t block_farthest[LP_PEEL_TILE_BLOCKS];
   int32_t farthest;        /**< see lp_peel_tile_farthest() */
   unsigned farthest_age;
   uint16_t *part;          /**< the counts of what is in memory, or NULL */
   size_t part_size;        /**< in bytes */

   /* What is to be cleared before anything else. */
   uint32_t cleared_colors;      /**< a bit for each color buffer */
   bool cleared_depth;
   union lp_rast_cmd_arg color_clears[PIPE_MAX_COLOR_BUFS];
   union lp_rast_cmd_arg depth_clear;

   uint8_t *spare;    /**< a larger one for data and counts, or NULL */
   size_t reserved;   /**< bytes of the largest one; not the thread's */
};

/**
 * Have room for such layers in all threads.  Called before they are drawn to,
 * with the rasterizer's mutex held.
 *
 * \return false if there is no memory
 */
bool
lp_peel_tiles_reserve(struct lp_rasterizer *rast,
                      const struct lp_rast_peel *peel);

/**
 * The tile of the task, for a new bin.
 *
 * \param dispatch  does what is not done here
 */
struct lp_peel_tile *
lp_peel_tile_begin(struct lp_rasterizer_task *task,
                   const lp_rast_cmd_func *dispatch);

/** Get ready for the state that the task has. */
void
lp_peel_tile_set_state(struct lp_peel_tile *tile);

/** Clear a color buffer, or depth and stencil. */
void
lp_peel_tile_clear(struct lp_peel_tile *tile, unsigned cmd,
                   const union lp_rast_cmd_arg arg);

/** Give everything back: something else is about to use the buffers. */
void
lp_peel_tile_flush(struct lp_peel_tile *tile);

/** The same at the end of a bin. */
void
lp_peel_tile_end(struct lp_peel_tile *tile);

/**
 * Fragments at this depth or farther can not be inserted anywhere in the tile;
 * INT32_MAX if there is no such depth.
 *
 * \param exact  find the nearest such depth, which takes some time
 */
int32_t
lp_peel_tile_farthest(struct lp_peel_tile *tile, bool exact);

void
lp_peel_tiles_destroy(struct lp_rasterizer *rast);

#endif /* LP_PEEL_TILE_H */
