/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_peel_blocks.h"

#include "util/u_math.h"

#include "lp_peel_parts.h"
#include "lp_tile_pixels.h"
#include "lp_rast_priv.h"
#include "lp_scene.h"


/** A 4x4 block of one layer and sample of a buffer, in memory. */
static uint8_t *
color_block(const struct lp_rasterizer_task *task, unsigned cbuf,
            unsigned block, unsigned layer, unsigned sample)
{
   const struct lp_scene_surface *surf = &task->scene->cbufs[cbuf];
   const unsigned x = block % (TILE_SIZE / 4) * 4;
   const unsigned y = block / (TILE_SIZE / 4) * 4;

   return task->color_tiles[cbuf] +
          (size_t)layer * surf->layer_stride +
          (size_t)sample * surf->sample_stride +
          y * surf->stride + x * surf->format_bytes;
}


static uint8_t *
depth_block(const struct lp_rasterizer_task *task,
            unsigned block, unsigned layer, unsigned sample)
{
   const struct lp_scene_surface *surf = &task->scene->zsbuf;
   const unsigned x = block % (TILE_SIZE / 4) * 4;
   const unsigned y = block / (TILE_SIZE / 4) * 4;

   return task->depth_tile +
          (size_t)layer * surf->layer_stride +
          (size_t)sample * surf->sample_stride +
          y * surf->stride + x * surf->format_bytes;
}


/*
 * From memory.
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


static void
load_layer(const struct lp_peel_tile *tile, uint32_t *words, unsigned block,
           unsigned layer, unsigned sample)
{
   const struct lp_rasterizer_task *task = tile->task;
   const struct lp_scene *scene = task->scene;

   if (!tile->cleared_depth) {
      load_depth(words, depth_block(task, block, layer, sample),
                 scene->zsbuf.stride, &tile->peel->depth);
   }
   words += 16;

   for (unsigned i = 0; i < scene->fb.nr_cbufs; i++) {
      const unsigned bytes = scene->cbufs[i].format_bytes;

      if (!scene->fb.cbufs[i])
         continue;
      if (!(tile->cleared_colors & (1 << i))) {
         lp_tile_load_pixels(words, color_block(task, i, block, layer, sample),
                             scene->cbufs[i].stride, bytes);
      }
      words += DIV_ROUND_UP(bytes, 4) * 16;
   }
}


/** \return whether all of the layer has been cleared */
static bool
clear_layer(const struct lp_peel_tile *tile, uint32_t *words)
{
   const struct lp_peel_depth_format *format = &tile->peel->depth;
   const struct lp_scene *scene = tile->task->scene;
   bool all = tile->cleared_depth;

   if (tile->cleared_depth) {
      const uint32_t bits =
         (tile->depth_clear.clear_zstencil.value >> format->shift) &
         lp_peel_depth_mask(format);
      const uint32_t word = lp_peel_compare_bits(format, bits);

      lp_tile_fill_pixels(words, &word, sizeof word);
   }
   words += 16;

   for (unsigned i = 0; i < scene->fb.nr_cbufs; i++) {
      const unsigned bytes = scene->cbufs[i].format_bytes;

      if (!scene->fb.cbufs[i])
         continue;
      if (tile->cleared_colors & (1 << i)) {
         lp_tile_fill_pixels(words,
                             tile->color_clears[i].clear_rb->color_val.ui,
                             bytes);
      } else {
         all = false;
      }
      words += DIV_ROUND_UP(bytes, 4) * 16;
   }
   return all;
}


/**
 * The last layer of a block that any group has of its own, if that is known
 * of what is in memory; -1 if not.
 */
static int
known_count(const struct lp_peel_tile *tile, unsigned block, unsigned sample)
{
   const uint16_t *counts = lp_peel_part_counts(tile, block, sample);
   int last = -1;

   for (unsigned g = 0; counts && g < LP_PEEL_GROUPS; g++) {
      if (counts[g] == LP_PEEL_UNKNOWN_COUNT)
         return -1;
      last = MAX2(last, counts[g]);
   }
   return last;
}


/** All layers of a sample, and which of them there are. */
static void
load_sample(struct lp_peel_tile *tile, unsigned block, unsigned sample)
{
   const struct lp_rast_peel *peel = tile->peel;
   const size_t layer_size = peel->num_words * LP_PEEL_WORD_SIZE;
   unsigned count = 0;

   for (unsigned layer = 0; layer < peel->num_layers; layer++) {
      uint32_t *words = lp_peel_tile_words(tile, block, layer, sample);

      if (clear_layer(tile, words))
         break;
      load_layer(tile, words, block, layer, sample);
      if (layer && memcmp(words, (uint8_t *)words - layer_size, layer_size))
         count = layer;
   }
   for (unsigned g = 0; g < LP_PEEL_GROUPS; g++)
      lp_peel_sample_counts(tile, block, sample)[g] = count;
}


void
lp_peel_load_block(struct lp_peel_tile *tile, uint32_t block)
{
   for (unsigned s = 0; s < tile->peel->num_samples; s++) {
      const int count = known_count(tile, block, s);

      for (int layer = 0; layer <= count; layer++)
         load_layer(tile, lp_peel_tile_words(tile, block, layer, s), block,
                    layer, s);
      if (count < 0) {
         load_sample(tile, block, s);
      } else {
         for (unsigned g = 0; g < LP_PEEL_GROUPS; g++) {
            lp_peel_sample_counts(tile, block, s)[g] =
               lp_peel_part_counts(tile, block, s)[g];
         }
      }
   }
   if (!tile->valid[block])
      tile->num_valid++;
   tile->valid[block] = LP_PEEL_ALL;
   tile->changed[block] = LP_PEEL_UNKNOWN;
}


void
lp_peel_load_last(struct lp_peel_tile *tile, uint32_t block)
{
   const struct lp_rast_peel *peel = tile->peel;
   const struct lp_rasterizer_task *task = tile->task;

   if (tile->cleared_depth || tile->cleared_colors) {
      lp_peel_load_block(tile, block);
      return;
   }

   for (unsigned s = 0; s < peel->num_samples; s++) {
      const int count = known_count(tile, block, s);
      const unsigned last = count < 0 ? peel->num_layers - 1 : count;

      load_depth(lp_peel_tile_words(tile, block, last, s),
                 depth_block(task, block, last, s),
                 task->scene->zsbuf.stride, &peel->depth);
      for (unsigned g = 0; g < LP_PEEL_GROUPS; g++)
         lp_peel_sample_counts(tile, block, s)[g] = last;
   }
   tile->num_valid++;
   tile->valid[block] = LP_PEEL_LAST;
   tile->changed[block] = LP_PEEL_UNKNOWN;
}


/*
 * To memory.
 */

static void
store_depth(const struct lp_peel_tile *tile, const uint32_t *const quads[4],
            uint8_t *block, bool stream)
{
   const struct lp_peel_depth_format *format = &tile->peel->depth;
   const unsigned stride = tile->task->scene->zsbuf.stride;
   uint32_t pixels[2 * 16];
   const uint32_t *pixel_quads[4];

   for (unsigned q = 0; q < 4; q++) {
      pixel_quads[q] = pixels + 4 * q;
      for (unsigned i = 0; i < 4; i++) {
         pixels[4 * q + i] =
            lp_peel_depth_bits(format, quads[q][i]) << format->shift;
      }
   }

   if (format->has_stencil) {
      const uint64_t kept_mask =
         ~((uint64_t)lp_peel_depth_mask(format) << format->shift);
      const uint64_t clear_mask =
         tile->cleared_depth ? tile->depth_clear.clear_zstencil.mask : 0;
      const uint64_t clear_value = tile->depth_clear.clear_zstencil.value;
      uint32_t old[2 * 16];

      lp_tile_load_pixels(old, block, stride, format->bytes);
      for (unsigned w = 0; w < format->bytes / 4; w++) {
         const uint32_t clear = clear_mask >> (32 * w);
         const uint32_t value = clear_value >> (32 * w);
         const uint32_t kept = kept_mask >> (32 * w);

         for (unsigned i = 0; i < 16; i++) {
            const uint32_t stencil =
               ((old[16 * w + i] & ~clear) | (value & clear)) & kept;

            pixels[16 * w + i] = (w ? 0 : pixels[i]) | stencil;
         }
      }
   }
   lp_tile_store_pixels(pixel_quads, block, stride, format->bytes, stream);
}


/** A block that is to be stored. */
struct stored_block
{
   unsigned block;
   unsigned counts[4];      /**< of each quad: the last layer there is */
   unsigned last;           /**< layer that is to be stored */
   const uint32_t *quads[4];
};


/** One layer and sample of some blocks. */
static void
store_layer(const struct lp_peel_tile *tile, const struct stored_block *blocks,
            unsigned num_blocks, unsigned layer, unsigned sample)
{
   const struct lp_rasterizer_task *task = tile->task;
   const struct lp_scene *scene = task->scene;
   const unsigned layer_words = tile->peel->num_words * 16;
   const uint32_t *quads[TILE_SIZE / 4][4];

   /* Whole cache lines, of more than the caches hold. */
   const bool stream = num_blocks == TILE_SIZE / 4 && tile->peel->stream;

   for (unsigned b = 0; b < num_blocks; b++) {
      for (unsigned q = 0; q < 4; q++) {
         quads[b][q] = blocks[b].quads[q] +
                       (size_t)MIN2(layer, blocks[b].counts[q]) * layer_words;
      }
   }

   for (unsigned b = 0; b < num_blocks; b++) {
      store_depth(tile, quads[b],
                  depth_block(task, blocks[b].block, layer, sample), stream);
   }

   for (unsigned i = 0, words = 16; i < scene->fb.nr_cbufs; i++) {
      const unsigned bytes = scene->cbufs[i].format_bytes;

      if (!scene->fb.cbufs[i])
         continue;
      for (unsigned b = 0; b < num_blocks; b++) {
         const uint32_t *color_quads[4];

         for (unsigned q = 0; q < 4; q++)
            color_quads[q] = quads[b][q] + words;
         lp_tile_store_pixels(color_quads,
                              color_block(task, i, blocks[b].block, layer,
                                          sample),
                              scene->cbufs[i].stride, bytes, stream);
      }
      words += DIV_ROUND_UP(bytes, 4) * 16;
   }
}


/** One sample of the blocks of a row that have changed. */
static void
store_row(const struct lp_peel_tile *tile, unsigned row, unsigned sample)
{
   struct stored_block blocks[TILE_SIZE / 4];
   const bool cleared = tile->cleared_depth || tile->cleared_colors;
   unsigned num_blocks = 0;

   for (unsigned x = 0; x < TILE_SIZE / 4; x++) {
      struct stored_block *b = &blocks[num_blocks];

      b->block = row * (TILE_SIZE / 4) + x;
      if (!(tile->changed[b->block] & LP_PEEL_CHANGED))
         continue;

      /* Layers that are not there are in memory already, if they came from
       * it.
       */
      b->last = cleared ? tile->last_layer : 0;
      for (unsigned q = 0; q < 4; q++) {
         b->counts[q] = lp_peel_quad_count(tile, b->block, sample, q);
         b->quads[q] = lp_peel_tile_words(tile, b->block, 0, sample) + 4 * q;
         b->last = MAX2(b->last, b->counts[q]);
      }
      num_blocks++;
   }

   for (unsigned layer = 0; num_blocks; layer++) {
      unsigned num_left = 0;

      store_layer(tile, blocks, num_blocks, layer, sample);
      for (unsigned b = 0; b < num_blocks; b++) {
         if (layer < blocks[b].last)
            blocks[num_left++] = blocks[b];
      }
      num_blocks = num_left;
   }
}


void
lp_peel_store_blocks(struct lp_peel_tile *tile)
{
   const struct lp_rasterizer_task *task = tile->task;
   const struct lp_rast_peel *peel = tile->peel;

   /* Clear what is not in use by the way. */
   if (tile->cleared_depth || tile->cleared_colors) {
      for (unsigned y = 0; y < task->height / 4; y++) {
         for (unsigned x = 0; x < task->width / 4; x++) {
            const unsigned block = y * (TILE_SIZE / 4) + x;

            if (!tile->valid[block])
               lp_peel_load_block(tile, block);
            tile->changed[block] |= LP_PEEL_CHANGED;
         }
      }
   }

   for (unsigned row = 0; row < DIV_ROUND_UP(task->height, 4); row++) {
      for (unsigned s = 0; s < peel->num_samples; s++)
         store_row(tile, row, s);
   }
   lp_tile_stream_end();
}
