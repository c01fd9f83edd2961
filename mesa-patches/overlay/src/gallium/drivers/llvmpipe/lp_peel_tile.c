/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_peel_tile.h"

#include "util/format/u_format.h"
#include "util/u_math.h"
#include "util/u_memory.h"

#include "lp_peel_pixels.h"
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


static uint32_t *
tile_words(const struct lp_peel_tile *tile, unsigned block, unsigned layer,
           unsigned sample)
{
   const size_t layer_size = tile->peel->num_words * LP_PEEL_WORD_SIZE;

   return (uint32_t *)(tile->data + (size_t)block * tile->block_size +
                       (size_t)sample * tile->sample_size +
                       layer * layer_size);
}


/** The count of the group that a quad is in. */
static uint32_t *
group_count(const struct lp_peel_tile *tile, unsigned block, unsigned sample,
            unsigned quad)
{
   const unsigned group = quad / lp_peel_group_quads();

   return &tile->counts[(block * tile->peel->num_samples + sample) *
                        LP_PEEL_GROUPS + group];
}


static void
load_depth(uint32_t *words, const uint8_t *block, unsigned stride,
           const struct lp_peel_depth_format *format)
{
   const uint32_t mask =
      format->width == 32 ? ~0u : (1u << format->width) - 1;
   uint32_t pixels[2 * 16];

   lp_peel_load_pixels(pixels, block, stride, format->bytes);
   for (unsigned i = 0; i < 16; i++) {
      words[i] = lp_peel_compare_bits(format,
                                      (pixels[i] >> format->shift) & mask);
   }
}


static void
store_depth(const uint32_t *const quads[4], uint8_t *block, unsigned stride,
            const struct lp_peel_depth_format *format)
{
   uint32_t pixels[2 * 16];
   const uint32_t *pixel_quads[4];

   for (unsigned i = 0; i < 16; i++) {
      pixels[i] = lp_peel_depth_bits(format, quads[i / 4][i % 4])
                  << format->shift;
   }

   if (format->has_stencil) {
      const uint32_t mask =
         format->width == 32 ? ~0u :
         ((1u << format->width) - 1) << format->shift;
      uint32_t old[2 * 16];

      lp_peel_load_pixels(old, block, stride, format->bytes);
      for (unsigned i = 0; i < 16; i++)
         pixels[i] |= old[i] & ~mask;
      memcpy(pixels + 16, old + 16, 16 * sizeof *pixels);
   }

   for (unsigned q = 0; q < 4; q++)
      pixel_quads[q] = pixels + 4 * q;
   lp_peel_store_pixels(pixel_quads, block, stride, format->bytes);
}


static void
load_layer(struct lp_peel_tile *tile, uint32_t *words, unsigned block,
           unsigned layer, unsigned sample)
{
   const struct lp_rasterizer_task *task = tile->task;
   const struct lp_scene *scene = task->scene;

   load_depth(words, depth_block(task, block, layer, sample),
              scene->zsbuf.stride, &tile->peel->depth);
   words += 16;

   for (unsigned i = 0; i < scene->fb.nr_cbufs; i++) {
      if (scene->fb.cbufs[i]) {
         const unsigned bytes = scene->cbufs[i].format_bytes;

         lp_peel_load_pixels(words, color_block(task, i, block, layer, sample),
                             scene->cbufs[i].stride, bytes);
         words += DIV_ROUND_UP(bytes, 4) * 16;
      }
   }
}


static void
store_layer(const struct lp_peel_tile *tile, unsigned block, unsigned layer,
            unsigned sample)
{
   const struct lp_rasterizer_task *task = tile->task;
   const struct lp_scene *scene = task->scene;
   const uint32_t *quads[4];

   for (unsigned q = 0; q < 4; q++) {
      const unsigned count = *group_count(tile, block, sample, q);

      quads[q] = tile_words(tile, block, MIN2(layer, count), sample) + 4 * q;
   }
   store_depth(quads, depth_block(task, block, layer, sample),
               scene->zsbuf.stride, &tile->peel->depth);

   for (unsigned i = 0, words = 16; i < scene->fb.nr_cbufs; i++) {
      if (scene->fb.cbufs[i]) {
         const unsigned bytes = scene->cbufs[i].format_bytes;
         const uint32_t *color_quads[4];

         for (unsigned q = 0; q < 4; q++)
            color_quads[q] = quads[q] + words;
         lp_peel_store_pixels(color_quads,
                              color_block(task, i, block, layer, sample),
                              scene->cbufs[i].stride, bytes);
         words += DIV_ROUND_UP(bytes, 4) * 16;
      }
   }
}


static void
load_block(struct lp_peel_tile *tile, uint32_t block)
{
   const struct lp_rast_peel *peel = tile->peel;
   const size_t layer_size = peel->num_words * LP_PEEL_WORD_SIZE;

   for (unsigned s = 0; s < peel->num_samples; s++) {
      unsigned count = 0;

      for (unsigned layer = 0; layer < peel->num_layers; layer++) {
         uint32_t *words = tile_words(tile, block, layer, s);

         load_layer(tile, words, block, layer, s);
         if (layer && memcmp(words, (uint8_t *)words - layer_size, layer_size))
            count = layer;
      }
      for (unsigned q = 0; q < 4; q++)
         *group_count(tile, block, s, q) = count;
   }
   tile->valid[block] = true;
   tile->changed[block] = true;
   tile->num_valid++;
}


void
lp_peel_tile_flush(struct lp_peel_tile *tile)
{
   const struct lp_rast_peel *peel = tile->peel;

   for (unsigned block = 0; block < LP_PEEL_TILE_BLOCKS; block++) {
      if (!tile->valid[block])
         continue;
      for (unsigned s = 0; s < peel->num_samples; s++) {
         for (unsigned layer = 0; layer < peel->num_layers; layer++)
            store_layer(tile, block, layer, s);
      }
   }
   memset(tile->valid, 0, sizeof tile->valid);
   tile->num_valid = 0;
   if (tile->overflow)
      p_atomic_set(&peel->object->overflow, 1);
   tile->overflow = 0;
   tile->peel = NULL;
}


/** Make room for a tile of this layout. */
static bool
reserve(struct lp_peel_tile *tile, size_t data_size, size_t counts_size)
{
   if (data_size > tile->data_size) {
      align_free(tile->data);
      tile->data = align_malloc(data_size, 64);
      tile->data_size = tile->data ? data_size : 0;
   }
   if (counts_size > tile->counts_size) {
      align_free(tile->counts);
      tile->counts = align_malloc(counts_size, 64);
      tile->counts_size = tile->counts ? counts_size : 0;
   }
   return tile->data && tile->counts;
}


bool
lp_peel_tile_set_state(struct lp_rasterizer_task *task)
{
   struct lp_peel_tile *tile = task->thread_data.peel_tile;
   const struct lp_rast_peel *peel = task->state->peel;

   if (tile && tile->peel &&
       (!peel || peel->depth.reversed != tile->peel->depth.reversed ||
        peel->object != tile->peel->object))
      lp_peel_tile_flush(tile);
   if (!peel)
      return true;

   if (!tile) {
      tile = CALLOC_STRUCT(lp_peel_tile);
      if (!tile)
         return false;
      tile->task = task;
      tile->load_block = load_block;
      task->thread_data.peel_tile = tile;
   }

   tile->sample_size = peel->num_layers * peel->num_words * LP_PEEL_WORD_SIZE;
   tile->block_size = peel->num_samples * tile->sample_size;
   if (!tile->peel &&
       !reserve(tile, (size_t)LP_PEEL_TILE_BLOCKS * tile->block_size,
                LP_PEEL_TILE_BLOCKS * peel->num_samples * LP_PEEL_GROUPS *
                sizeof(uint32_t)))
      return false;

   tile->peel = peel;
   tile->last_layer = peel->num_layers - 1;
   tile->empty = peel->empty;
   if (peel->bounded) {
      tile->bounds =
         peel->object->bounds +
         ((size_t)task->y / 4 * peel->object->blocks_x + task->x / 4) *
         peel->num_samples;
      tile->bound_blocks_x = peel->object->blocks_x;
   }
   return true;
}


void
lp_peel_tiles_destroy(struct lp_rasterizer *rast)
{
   for (unsigned i = 0; i < MAX2(1, rast->num_threads); i++) {
      struct lp_peel_tile *tile = rast->tasks[i].thread_data.peel_tile;

      if (tile) {
         align_free(tile->data);
         align_free(tile->counts);
         FREE(tile);
      }
   }
}
