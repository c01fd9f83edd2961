/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_kbuf_tile.h
 * A copy of the k-buffer of the tile that a thread works on.
 *
 * All entries of a pixel are read and written together, but in the color
 * buffers they lie whole images apart, that is mostly at the same offset in
 * a page, where a few of them already evict each other from the cache.  Here
 * a block of 4x4 pixels has all its entries side by side, as vectors that the
 * generated code uses without shuffles: block, entry, 32-bit word of the
 * pixel, quad, pixel of the quad.
 *
 * A block is copied when the first fragment comes to it, and goes back to the
 * color buffers before anything else can look at them: at the end of the
 * tile and at commands that do not belong to the stage.
 *
 * Clears are only noted.  They are done to the tile's blocks as these come
 * into use, and to the color buffers at the end, together with all other
 * writing.
 */

#ifndef LP_KBUF_TILE_H
#define LP_KBUF_TILE_H

#include <stdbool.h>
#include <stdint.h>

#include "util/format/u_formats.h"
#include "lp_kbuf.h"
#include "lp_limits.h"
#include "lp_scene.h"

struct lp_rasterizer;
struct lp_rasterizer_task;

#define LP_KBUF_TILE_BLOCKS ((TILE_SIZE / 4) * (TILE_SIZE / 4))

/** Bytes of a word of the 16 pixels of a block. */
#define LP_KBUF_WORD_SIZE (16 * sizeof(uint32_t))

struct lp_kbuf_tile
{
   /* Used by generated code. */
   uint8_t *data;
   void (*load_block)(struct lp_kbuf_tile *tile, uint32_t block);
   uint8_t valid[LP_KBUF_TILE_BLOCKS];

   struct lp_rasterizer_task *task;
   const struct lp_jit_kbuf *kbuf;  /**< NULL: no block is valid */
   uint64_t written;                /**< entries that have to go back */
   unsigned num_valid;
   bool bypassed;  /**< draws work on the color buffers themselves */

   /* What is to be cleared before anything else. */
   uint32_t cleared;  /**< a bit for each color buffer */
   const struct lp_rast_clear_rb *clears[PIPE_MAX_COLOR_BUFS];
   lp_rast_cmd_func clear_color;  /**< clears a color buffer itself */
};

/** Where the entries of a block are, in words. */
struct lp_kbuf_layout
{
   uint16_t offset[LP_MAX_KBUF_ENTRIES];
   uint16_t size;
};

void
lp_kbuf_layout_init(struct lp_kbuf_layout *layout, unsigned num_entries,
                    unsigned num_color_buffers,
                    const enum pipe_format *formats, unsigned num_formats);

/** Allocate the copies of all threads; false if there is no memory. */
bool
lp_kbuf_tiles_create(struct lp_rasterizer *rast);

void
lp_kbuf_tiles_destroy(struct lp_rasterizer *rast);

/** A bin begins in which clears may be noted. */
static inline void
lp_kbuf_tile_begin(struct lp_kbuf_tile *tile, lp_rast_cmd_func clear_color)
{
   tile->clear_color = clear_color;
   tile->bypassed = false;
}

/** Note a clear; \return false if it has to be done to the color buffer. */
bool
lp_kbuf_tile_clear(struct lp_kbuf_tile *tile,
                   const struct lp_rast_clear_rb *clear);

/** Give everything back, and do the clears that were noted. */
void
lp_kbuf_tile_flush(struct lp_kbuf_tile *tile);

/**
 * Something else is about to use the color buffers.  The state stays: draws
 * may follow without setting it again.
 */
static inline void
lp_kbuf_tile_yield(struct lp_kbuf_tile *tile)
{
   if (tile && (tile->num_valid || tile->cleared))
      lp_kbuf_tile_flush(tile);
}

/** The state is no longer that of draws. */
static inline void
lp_kbuf_tile_end(struct lp_kbuf_tile *tile)
{
   lp_kbuf_tile_yield(tile);
   if (tile) {
      tile->written = 0;
      tile->kbuf = NULL;
   }
}

/** A new state is about to be used. */
void
lp_kbuf_tile_set_state(struct lp_rasterizer_task *task);

#endif /* LP_KBUF_TILE_H */
