/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_tile_layout.h
 * Where the values of a pixel are in the tile store (lp_tile_store.h).
 *
 * A pixel has the same 32-bit words in each layer: its depth, if depths are
 * kept, and then the colors as their buffers store them, each of a whole
 * number of words.
 */

#ifndef LP_TILE_LAYOUT_H
#define LP_TILE_LAYOUT_H

#include <stdbool.h>
#include <stddef.h>

#include "pipe/p_state.h"

#include "lp_limits.h"

/** Blocks of 4x4 pixels of a tile. */
#define LP_TILE_BLOCKS ((TILE_SIZE / 4) * (TILE_SIZE / 4))

/** Bytes of a word of the 16 pixels of a block. */
#define LP_TILE_WORD_SIZE (16 * sizeof(uint32_t))

/** The most words that a color takes. */
#define LP_TILE_COLOR_WORDS 4

struct lp_tile_layout
{
   unsigned num_samples;
   unsigned num_layers;
   unsigned num_color_buffers;  /**< of which the framebuffer may have fewer */
   unsigned num_words;          /**< of a pixel in a layer */
   bool has_depth;              /**< in word 0 */
   uint8_t color_words[PIPE_MAX_COLOR_BUFS]; /**< of each buffer; 0: no buffer */
};

void
lp_tile_layout_init(struct lp_tile_layout *layout, bool has_depth,
                    unsigned num_samples, unsigned num_layers,
                    unsigned num_color_buffers,
                    const enum pipe_format *formats, unsigned num_formats);

/** The same for the color buffers of a framebuffer. */
void
lp_tile_layout_init_fb(struct lp_tile_layout *layout, bool has_depth,
                       unsigned num_samples, unsigned num_layers,
                       unsigned num_color_buffers,
                       const struct pipe_framebuffer_state *fb);

/** The first word of a color buffer in a layer. */
unsigned
lp_tile_color_word(const struct lp_tile_layout *layout, unsigned cbuf);

/** Bytes of a layer of a block, in one sample. */
static inline size_t
lp_tile_layer_size(const struct lp_tile_layout *layout)
{
   return layout->num_words * LP_TILE_WORD_SIZE;
}

/** Bytes of all layers of a block, in one sample. */
static inline size_t
lp_tile_sample_size(const struct lp_tile_layout *layout)
{
   return layout->num_layers * lp_tile_layer_size(layout);
}

/** Bytes of a block. */
static inline size_t
lp_tile_block_size(const struct lp_tile_layout *layout)
{
   return layout->num_samples * lp_tile_sample_size(layout);
}

#endif /* LP_TILE_LAYOUT_H */
