/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_tile_blocks.h"

#include "util/u_math.h"

#include "lp_layer_counts.h"
#include "lp_peel_depth.h"
#include "lp_rast_priv.h"
#include "lp_scene.h"
#include "lp_tile_pixels.h"


/** Where a 4x4 block of one layer and sample of a buffer is in memory. */
static uint8_t *
block_in_buffer(uint8_t *tile, const struct lp_scene_surface *surf,
                unsigned block, unsigned layer, unsigned sample)
{
   const unsigned x = block % (TILE_SIZE / 4) * 4;
   const unsigned y = block / (TILE_SIZE / 4) * 4;

   return tile + (size_t)layer * surf->layer_stride +
                 (size_t)sample * surf->sample_stride +
                 y * surf->stride + x * surf->format_bytes;
}


static uint8_t *
color_block(const struct lp_tile_store *store, unsigned cbuf,
            unsigned block, unsigned layer, unsigned sample)
{
   return block_in_buffer(store->task->color_tiles[cbuf],
                          &store->task->scene->cbufs[cbuf],
                          block, layer, sample);
}


static uint8_t *
depth_block(const struct lp_tile_store *store,
            unsigned block, unsigned layer, unsigned sample)
{
   return block_in_buffer(store->task->depth_tile,
                          &store->task->scene->zsbuf,
                          block, layer, sample);
}


/*
 * From the buffers.
 */

static void
load_depth(uint32_t *words, const uint8_t *block, unsigned stride,
           const struct lp_peel_depth_format *format)
{
   const uint32_t mask = lp_peel_depth_mask(format);
   uint32_t pixels[2 * 16];

   lp_tile_load_pixels(pixels, block, stride, format->bytes);
   for (unsigned i = 0; i < 16; i++) {
      words[i] = lp_peel_compare_bits(format,
                                      (pixels[i] >> format->shift) & mask);
   }
}


/** Load what is not to be cleared of a layer. */
static void
load_layer(const struct lp_tile_store *store, uint32_t *words, unsigned block,
           unsigned layer, unsigned sample)
{
   const struct lp_tile_layout *layout = store->layout;
   const struct lp_scene *scene = store->task->scene;

   if (layout->has_depth) {
      if (!store->clears.depth) {
         load_depth(words, depth_block(store, block, layer, sample),
                    scene->zsbuf.stride, &store->peel->depth);
      }
      words += 16;
   }

   for (unsigned i = 0; i < layout->num_color_buffers; i++) {
      if (layout->color_words[i] && !(store->clears.colors & (1 << i))) {
         lp_tile_load_pixels(words, color_block(store, i, block, layer, sample),
                             scene->cbufs[i].stride,
                             scene->cbufs[i].format_bytes);
      }
      words += layout->color_words[i] * 16;
   }
}


/** \return whether all of the layer has been cleared */
static bool
clear_layer(const struct lp_tile_store *store, uint32_t *words)
{
   const struct lp_tile_layout *layout = store->layout;
   const struct lp_tile_clears *clears = &store->clears;
   bool all = true;

   if (layout->has_depth) {
      all = clears->depth;
      if (clears->depth) {
         const struct lp_peel_depth_format *format = &store->peel->depth;
         const uint32_t bits =
            (clears->zstencil.clear_zstencil.value >> format->shift) &
            lp_peel_depth_mask(format);
         const uint32_t word = lp_peel_compare_bits(format, bits);

         lp_tile_fill_pixels(words, &word, sizeof word);
      }
      words += 16;
   }

   for (unsigned i = 0; i < layout->num_color_buffers; i++) {
      if (!layout->color_words[i])
         continue;
      if (clears->colors & (1 << i)) {
         lp_tile_fill_pixels(words, clears->color[i].clear_rb->color_val.ui,
                             store->task->scene->cbufs[i].format_bytes);
      } else {
         all = false;
      }
      words += layout->color_words[i] * 16;
   }
   return all;
}


/**
 * The last layer of a block that any group has of its own, if that is known
 * of what is in the buffers; -1 if not.
 */
static int
known_count(const struct lp_tile_store *store, unsigned block, unsigned sample)
{
   const uint16_t *counts = lp_tile_known_counts(store, block, sample);
   int last = -1;

   for (unsigned g = 0; counts && g < LP_TILE_GROUPS; g++) {
      if (counts[g] == LP_UNKNOWN_COUNT)
         return -1;
      last = MAX2(last, counts[g]);
   }
   return last;
}


/** Load all layers of a sample, and find out how many of them differ. */
static void
load_and_count(struct lp_tile_store *store, unsigned block, unsigned sample)
{
   const size_t layer_size = lp_tile_layer_size(store->layout);
   unsigned count = 0;

   for (unsigned layer = 0; layer < store->layout->num_layers; layer++) {
      uint32_t *words = lp_tile_words(store, block, layer, sample);

      if (clear_layer(store, words))
         break;
      load_layer(store, words, block, layer, sample);
      if (layer && memcmp(words, (uint8_t *)words - layer_size, layer_size))
         count = layer;
   }
   for (unsigned g = 0; g < LP_TILE_GROUPS; g++)
      lp_tile_counts(store, block, sample)[g] = count;
}


/** Load the layers of a sample of which the counts are known. */
static void
load_counted(struct lp_tile_store *store, unsigned block, unsigned sample)
{
   const int count = known_count(store, block, sample);

   if (count < 0) {
      load_and_count(store, block, sample);
      return;
   }

   for (int layer = 0; layer <= count; layer++) {
      load_layer(store, lp_tile_words(store, block, layer, sample), block,
                 layer, sample);
   }
   for (unsigned g = 0; g < LP_TILE_GROUPS; g++) {
      lp_tile_counts(store, block, sample)[g] =
         lp_tile_known_counts(store, block, sample)[g];
   }
}


void
lp_tile_load_block(struct lp_tile_store *store, uint32_t block)
{
   const struct lp_tile_layout *layout = store->layout;

   if (store->peel) {
      for (unsigned s = 0; s < layout->num_samples; s++)
         load_counted(store, block, s);
   } else {
      for (unsigned layer = 0; layer < layout->num_layers; layer++) {
         uint32_t *words = lp_tile_words(store, block, layer, 0);

         if (store->clears.colors)
            clear_layer(store, words);
         load_layer(store, words, block, layer, 0);
      }
   }
   if (!store->valid[block])
      store->num_valid++;
   store->valid[block] = LP_TILE_ALL;
   store->changed[block] = store->peel ? LP_TILE_UNKNOWN : LP_TILE_CHANGED;
}


void
lp_tile_load_last(struct lp_tile_store *store, uint32_t block)
{
   if (store->clears.depth || store->clears.colors) {
      lp_tile_load_block(store, block);
      return;
   }

   for (unsigned s = 0; s < store->layout->num_samples; s++) {
      const int count = known_count(store, block, s);
      const unsigned last = count < 0 ? store->last_layer : count;

      load_depth(lp_tile_words(store, block, last, s),
                 depth_block(store, block, last, s),
                 store->task->scene->zsbuf.stride, &store->peel->depth);
      for (unsigned g = 0; g < LP_TILE_GROUPS; g++)
         lp_tile_counts(store, block, s)[g] = last;
   }
   store->num_valid++;
   store->valid[block] = LP_TILE_LAST;
   store->changed[block] = LP_TILE_UNKNOWN;
}


/*
 * To the buffers.
 */

/** Put the stencil values that a block has, or is cleared to, beside depths. */
static void
add_stencil(const struct lp_tile_store *store, uint32_t *pixels,
            const uint8_t *block)
{
   const struct lp_peel_depth_format *format = &store->peel->depth;
   const union lp_rast_cmd_arg *clear = &store->clears.zstencil;
   const uint64_t stencil_mask =
      ~((uint64_t)lp_peel_depth_mask(format) << format->shift);
   const uint64_t clear_mask =
      store->clears.depth ? clear->clear_zstencil.mask : 0;
   uint32_t old[2 * 16];

   lp_tile_load_pixels(old, block, store->task->scene->zsbuf.stride,
                       format->bytes);
   for (unsigned w = 0; w < format->bytes / 4; w++) {
      const uint32_t cleared = clear_mask >> (32 * w);
      const uint32_t value = clear->clear_zstencil.value >> (32 * w);
      const uint32_t kept = stencil_mask >> (32 * w);

      for (unsigned i = 0; i < 16; i++) {
         const uint32_t stencil =
            ((old[16 * w + i] & ~cleared) | (value & cleared)) & kept;

         pixels[16 * w + i] = (w ? 0 : pixels[i]) | stencil;
      }
   }
}


static void
store_depth(const struct lp_tile_store *store, const uint32_t *const quads[4],
            uint8_t *block, bool stream)
{
   const struct lp_peel_depth_format *format = &store->peel->depth;
   uint32_t pixels[2 * 16];
   const uint32_t *pixel_quads[4];

   for (unsigned q = 0; q < 4; q++) {
      pixel_quads[q] = pixels + 4 * q;
      for (unsigned i = 0; i < 4; i++) {
         pixels[4 * q + i] =
            lp_peel_depth_bits(format, quads[q][i]) << format->shift;
      }
   }
   if (format->has_stencil)
      add_stencil(store, pixels, block);
   lp_tile_store_pixels(pixel_quads, block, store->task->scene->zsbuf.stride,
                        format->bytes, stream);
}


/** A block that is to be stored. */
struct stored_block
{
   unsigned block;
   unsigned counts[4];      /**< of each quad: the last layer there is */
   unsigned last;           /**< layer that is to be stored */
   const uint32_t *quads[4];
};


/** Whether a color of a layer differs from that in the buffer. */
static bool
is_stored(const struct lp_tile_store *store, unsigned layer, unsigned cbuf)
{
   const unsigned entry = layer * store->layout->num_color_buffers + cbuf;

   return store->peel || store->clears.colors & (1 << cbuf) ||
          (entry < 64 && store->written & BITFIELD64_BIT(entry));
}


/** Store one layer and sample of some blocks. */
static void
store_layer(const struct lp_tile_store *store,
            const struct stored_block *blocks, unsigned num_blocks,
            unsigned layer, unsigned sample)
{
   const struct lp_tile_layout *layout = store->layout;
   const struct lp_scene *scene = store->task->scene;
   const uint32_t *quads[TILE_SIZE / 4][4];

   /* Whole cache lines, of more than the caches hold. */
   const bool stream = num_blocks == TILE_SIZE / 4 &&
                       store->peel && store->peel->stream;

   for (unsigned b = 0; b < num_blocks; b++) {
      for (unsigned q = 0; q < 4; q++) {
         quads[b][q] = blocks[b].quads[q] +
                       (size_t)MIN2(layer, blocks[b].counts[q]) *
                       layout->num_words * 16;
      }
      if (layout->has_depth) {
         store_depth(store, quads[b],
                     depth_block(store, blocks[b].block, layer, sample),
                     stream);
      }
   }

   unsigned words = layout->has_depth ? 16 : 0;
   for (unsigned i = 0; i < layout->num_color_buffers; i++) {
      const bool stored = layout->color_words[i] && is_stored(store, layer, i);

      for (unsigned b = 0; stored && b < num_blocks; b++) {
         const uint32_t *color_quads[4];

         for (unsigned q = 0; q < 4; q++)
            color_quads[q] = quads[b][q] + words;
         lp_tile_store_pixels(color_quads,
                              color_block(store, i, blocks[b].block, layer,
                                          sample),
                              scene->cbufs[i].stride,
                              scene->cbufs[i].format_bytes, stream);
      }
      words += layout->color_words[i] * 16;
   }
}


/** How much of a block has to be stored, in one sample. */
static void
init_stored_block(const struct lp_tile_store *store, struct stored_block *b,
                  unsigned block, unsigned sample)
{
   const bool cleared = store->clears.depth || store->clears.colors;
   const unsigned last_layer = store->layout->num_layers - 1;

   /* Layers that are not there are in the buffers, if they came from them. */
   b->block = block;
   b->last = cleared || !store->peel ? last_layer : 0;
   for (unsigned q = 0; q < 4; q++) {
      b->counts[q] = store->peel ?
         lp_tile_quad_count(store, block, sample, q) : last_layer;
      b->quads[q] = lp_tile_words(store, block, 0, sample) + 4 * q;
      b->last = MAX2(b->last, b->counts[q]);
   }
}


/** Store one sample of the blocks of a row that have changed. */
static void
store_row(const struct lp_tile_store *store, unsigned row, unsigned sample)
{
   struct stored_block blocks[TILE_SIZE / 4];
   unsigned num_blocks = 0;

   for (unsigned x = 0; x < TILE_SIZE / 4; x++) {
      const unsigned block = row * (TILE_SIZE / 4) + x;

      if (store->changed[block] & LP_TILE_CHANGED)
         init_stored_block(store, &blocks[num_blocks++], block, sample);
   }

   for (unsigned layer = 0; num_blocks; layer++) {
      unsigned num_left = 0;

      store_layer(store, blocks, num_blocks, layer, sample);
      for (unsigned b = 0; b < num_blocks; b++) {
         if (layer < blocks[b].last)
            blocks[num_left++] = blocks[b];
      }
      num_blocks = num_left;
   }
}


void
lp_tile_store_blocks(struct lp_tile_store *store)
{
   const struct lp_rasterizer_task *task = store->task;

   /* A program may name no entry. */
   if (!store->layout->num_layers)
      return;

   /* Clear what is not in use by the way. */
   if (store->clears.depth || store->clears.colors) {
      for (unsigned y = 0; y < task->height / 4; y++) {
         for (unsigned x = 0; x < task->width / 4; x++) {
            const unsigned block = y * (TILE_SIZE / 4) + x;

            if (!store->valid[block])
               lp_tile_load_block(store, block);
            store->changed[block] |= LP_TILE_CHANGED;
         }
      }
   }

   for (unsigned row = 0; row < DIV_ROUND_UP(task->height, 4); row++) {
      for (unsigned s = 0; s < store->layout->num_samples; s++)
         store_row(store, row, s);
   }
   lp_tile_stream_end();
}
