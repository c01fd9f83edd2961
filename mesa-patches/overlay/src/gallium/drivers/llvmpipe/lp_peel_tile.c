/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_peel_tile.h"

#include "util/format/u_format.h"
#include "util/u_math.h"
#include "util/u_memory.h"

#include "lp_peel_parts.h"
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


/** The counts of the groups. */
static uint32_t *
sample_counts(const struct lp_peel_tile *tile, unsigned block, unsigned sample)
{
   return &tile->counts[(block * tile->peel->num_samples + sample) *
                        LP_PEEL_GROUPS];
}


/** The same of what is in memory, see lp_peel_parts.h; or NULL. */
static uint16_t *
part_counts(const struct lp_peel_tile *tile, unsigned block, unsigned sample)
{
   return tile->part ?
      &tile->part[(block * tile->peel->num_samples + sample) *
                  LP_PEEL_GROUPS] : NULL;
}


/** The count of the group that a quad is in. */
static uint32_t
quad_count(const struct lp_peel_tile *tile, unsigned block, unsigned sample,
           unsigned quad)
{
   return sample_counts(tile, block, sample)[quad / lp_peel_group_quads()];
}


static uint32_t
depth_mask(const struct lp_peel_depth_format *format)
{
   return format->width == 32 ? ~0u : (1u << format->width) - 1;
}


/*
 * From memory.
 */

static void
load_depth(uint32_t *words, const uint8_t *block, unsigned stride,
           const struct lp_peel_depth_format *format)
{
   const uint32_t mask = depth_mask(format);
   uint32_t pixels[2 * 16];

   lp_peel_load_pixels(pixels, block, stride, format->bytes);
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
         lp_peel_load_pixels(words, color_block(task, i, block, layer, sample),
                             scene->cbufs[i].stride, bytes);
      }
      words += DIV_ROUND_UP(bytes, 4) * 16;
   }
}


static void
fill_word(uint32_t *words, uint32_t value)
{
   for (unsigned i = 0; i < 16; i++)
      words[i] = value;
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
         depth_mask(format);

      fill_word(words, lp_peel_compare_bits(format, bits));
   }
   words += 16;

   for (unsigned i = 0; i < scene->fb.nr_cbufs; i++) {
      const unsigned bytes = scene->cbufs[i].format_bytes;

      if (!scene->fb.cbufs[i])
         continue;
      for (unsigned w = 0; w < DIV_ROUND_UP(bytes, 4); w++, words += 16) {
         if (tile->cleared_colors & (1 << i)) {
            const union util_color *color =
               &tile->color_clears[i].clear_rb->color_val;
            uint32_t word = 0;

            memcpy(&word, &color->ui[w], MIN2(bytes - 4 * w, 4));
            fill_word(words, word);
         } else {
            all = false;
         }
      }
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
   const uint16_t *counts = part_counts(tile, block, sample);
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
      uint32_t *words = tile_words(tile, block, layer, sample);

      if (clear_layer(tile, words))
         break;
      load_layer(tile, words, block, layer, sample);
      if (layer && memcmp(words, (uint8_t *)words - layer_size, layer_size))
         count = layer;
   }
   for (unsigned g = 0; g < LP_PEEL_GROUPS; g++)
      sample_counts(tile, block, sample)[g] = count;
}


static void
load_block(struct lp_peel_tile *tile, uint32_t block)
{
   for (unsigned s = 0; s < tile->peel->num_samples; s++) {
      const int count = known_count(tile, block, s);

      for (int layer = 0; layer <= count; layer++)
         load_layer(tile, tile_words(tile, block, layer, s), block, layer, s);
      if (count < 0) {
         load_sample(tile, block, s);
      } else {
         for (unsigned g = 0; g < LP_PEEL_GROUPS; g++) {
            sample_counts(tile, block, s)[g] =
               part_counts(tile, block, s)[g];
         }
      }
   }
   if (!tile->valid[block])
      tile->num_valid++;
   tile->valid[block] = LP_PEEL_ALL;
   tile->changed[block] = LP_PEEL_UNKNOWN;
}


/**
 * A scene that is too large is run in parts, in each of which only some of
 * the blocks change: for the others this is all that is needed.
 */
static void
load_last(struct lp_peel_tile *tile, uint32_t block)
{
   const struct lp_rast_peel *peel = tile->peel;
   const struct lp_rasterizer_task *task = tile->task;

   if (tile->cleared_depth || tile->cleared_colors) {
      load_block(tile, block);
      return;
   }

   for (unsigned s = 0; s < peel->num_samples; s++) {
      const int count = known_count(tile, block, s);
      const unsigned last = count < 0 ? peel->num_layers - 1 : count;

      load_depth(tile_words(tile, block, last, s),
                 depth_block(task, block, last, s),
                 task->scene->zsbuf.stride, &peel->depth);
      for (unsigned g = 0; g < LP_PEEL_GROUPS; g++)
         sample_counts(tile, block, s)[g] = last;
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
         ~((uint64_t)depth_mask(format) << format->shift);
      const uint64_t clear_mask =
         tile->cleared_depth ? tile->depth_clear.clear_zstencil.mask : 0;
      const uint64_t clear_value = tile->depth_clear.clear_zstencil.value;
      uint32_t old[2 * 16];

      lp_peel_load_pixels(old, block, stride, format->bytes);
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
   lp_peel_store_pixels(pixel_quads, block, stride, format->bytes, stream);
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
         lp_peel_store_pixels(color_quads,
                              color_block(task, i, blocks[b].block, layer, sample),
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

      /* Layers that are not there are in memory already, if they came from it. */
      b->last = cleared ? tile->last_layer : 0;
      for (unsigned q = 0; q < 4; q++) {
         b->counts[q] = quad_count(tile, b->block, sample, q);
         b->quads[q] = tile_words(tile, b->block, 0, sample) + 4 * q;
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


static void
store_blocks(struct lp_peel_tile *tile)
{
   const struct lp_rasterizer_task *task = tile->task;
   const struct lp_rast_peel *peel = tile->peel;

   /* Clear what is not in use by the way. */
   if (tile->cleared_depth || tile->cleared_colors) {
      for (unsigned y = 0; y < task->height / 4; y++) {
         for (unsigned x = 0; x < task->width / 4; x++) {
            const unsigned block = y * (TILE_SIZE / 4) + x;

            if (!tile->valid[block])
               load_block(tile, block);
            tile->changed[block] |= LP_PEEL_CHANGED;
         }
      }
   }

   for (unsigned row = 0; row < DIV_ROUND_UP(task->height, 4); row++) {
      for (unsigned s = 0; s < peel->num_samples; s++)
         store_row(tile, row, s);
   }
   lp_peel_stream_end();
}


/** Something else may write to the buffers: the counts hold no longer. */
static void
forget_part(struct lp_peel_tile *tile)
{
   if (tile->part)
      memset(tile->part, 0xff, tile->part_size);
}


static void
remember_part(struct lp_peel_tile *tile)
{
   const unsigned num_counts = tile->peel->num_samples * LP_PEEL_GROUPS;

   for (unsigned block = 0; block < LP_PEEL_TILE_BLOCKS; block++) {
      if (tile->valid[block] != LP_PEEL_ALL)
         continue;
      for (unsigned i = 0; i < num_counts; i++) {
         part_counts(tile, block, 0)[i] =
            sample_counts(tile, block, 0)[i];
      }
   }
}


/** Whether all of each layer is to be cleared. */
static bool
is_cleared(const struct lp_peel_tile *tile)
{
   const struct pipe_framebuffer_state *fb = &tile->task->scene->fb;

   for (unsigned i = 0; i < fb->nr_cbufs; i++) {
      if (fb->cbufs[i] && !(tile->cleared_colors & (1 << i)))
         return false;
   }
   return tile->cleared_depth;
}


void
lp_peel_tile_end(struct lp_peel_tile *tile)
{
   struct lp_rasterizer_task *task = tile->task;

   if (tile->num_valid) {
      store_blocks(tile);
      if (tile->part)
         remember_part(tile);
      memset(tile->valid, 0, sizeof tile->valid);
      memset(tile->changed, 0, sizeof tile->changed);
      tile->farthest = INT32_MAX;
      tile->num_valid = 0;
   } else {
      if (tile->part && is_cleared(tile))
         memset(tile->part, 0, tile->part_size);
      u_foreach_bit(i, tile->cleared_colors)
         tile->dispatch[LP_RAST_OP_CLEAR_COLOR](task, tile->color_clears[i]);
      if (tile->cleared_depth)
         tile->dispatch[LP_RAST_OP_CLEAR_ZSTENCIL](task, tile->depth_clear);
   }
   tile->cleared_colors = 0;
   tile->cleared_depth = false;

   if (tile->overflow)
      p_atomic_set(&tile->peel->object->overflow, 1);
   tile->overflow = 0;
   tile->peel = NULL;
}


void
lp_peel_tile_flush(struct lp_peel_tile *tile)
{
   lp_peel_tile_end(tile);
   forget_part(tile);
}


void
lp_peel_tile_clear(struct lp_peel_tile *tile, unsigned cmd,
                   const union lp_rast_cmd_arg arg)
{
   struct lp_rasterizer_task *task = tile->task;
   const struct lp_rast_peel *peel = tile->peel;

   forget_part(tile);

   /* The rest of a block at the edge may belong to the texture. */
   if (tile->num_valid || task->width % 4 || task->height % 4) {
      lp_peel_tile_flush(tile);
      tile->peel = peel;
   }
   if (task->width % 4 || task->height % 4) {
      tile->dispatch[cmd](task, arg);
      return;
   }

   if (cmd == LP_RAST_OP_CLEAR_COLOR) {
      tile->color_clears[arg.clear_rb->cbuf] = arg;
      tile->cleared_colors |= 1 << arg.clear_rb->cbuf;
   } else if (tile->cleared_depth) {
      const uint64_t mask = arg.clear_zstencil.mask;
      union lp_rast_cmd_arg *clear = &tile->depth_clear;

      clear->clear_zstencil.value &= ~mask;
      clear->clear_zstencil.value |= arg.clear_zstencil.value & mask;
      clear->clear_zstencil.mask |= mask;
   } else {
      struct lp_peel_depth_format format;

      lp_peel_depth_format_init(&format, task->scene->fb.zsbuf->format, false);
      const uint64_t depth = (uint64_t)depth_mask(&format) << format.shift;
      if ((arg.clear_zstencil.mask & depth) == depth) {
         tile->depth_clear = arg;
         tile->cleared_depth = true;
      } else {
         tile->dispatch[cmd](task, arg);
      }
   }
}


/*
 * State.
 */

static struct lp_peel_tile *
create_tile(struct lp_rasterizer_task *task)
{
   struct lp_peel_tile *tile = CALLOC_STRUCT(lp_peel_tile);

   if (tile) {
      tile->task = task;
      tile->load_block = load_block;
      tile->load_last = load_last;
      task->thread_data.peel_tile = tile;
   }
   return tile;
}


bool
lp_peel_tiles_reserve(struct lp_rasterizer *rast,
                      const struct lp_rast_peel *peel)
{
   const size_t block_counts = peel->num_samples * LP_PEEL_GROUPS;
   const size_t size =
      LP_PEEL_TILE_BLOCKS *
      ((size_t)peel->num_samples * peel->num_layers * peel->num_words *
       LP_PEEL_WORD_SIZE + block_counts * sizeof(uint32_t));

   for (unsigned i = 0; i < MAX2(1, rast->num_threads); i++) {
      struct lp_peel_tile *tile = rast->tasks[i].thread_data.peel_tile;

      if (!tile)
         tile = create_tile(&rast->tasks[i]);
      if (!tile)
         return false;

      if (size > tile->reserved) {
         uint8_t *data = align_malloc(size, 64);

         if (!data)
            return false;
         /* What the thread has not taken yet is smaller. */
         align_free(p_atomic_xchg(&tile->spare, data));
         tile->reserved = size;
      }
   }
   return true;
}


struct lp_peel_tile *
lp_peel_tile_begin(struct lp_rasterizer_task *task,
                   const lp_rast_cmd_func *dispatch)
{
   struct lp_peel_tile *tile = task->thread_data.peel_tile;
   struct lp_peel_parts *parts = task->scene->peel_parts;

   tile->dispatch = dispatch;
   tile->farthest = INT32_MAX;
   tile->part = NULL;
   if (parts) {
      tile->part = lp_peel_parts_tile(parts, task->x, task->y);
      tile->part_size = parts->tile_counts * sizeof *tile->part;
   }
   return tile;
}


static void
take_spare(struct lp_peel_tile *tile)
{
   uint8_t *data = p_atomic_xchg(&tile->spare, NULL);

   if (data) {
      align_free(tile->data);
      tile->data = data;
   }
}


void
lp_peel_tile_set_state(struct lp_peel_tile *tile)
{
   const struct lp_rasterizer_task *task = tile->task;
   const struct lp_rast_peel *peel = task->state->peel;

   if (!peel || (tile->peel &&
                 (peel->depth.reversed != tile->peel->depth.reversed ||
                  peel->object != tile->peel->object)))
      lp_peel_tile_flush(tile);
   if (!peel)
      return;

   tile->sample_size = peel->num_layers * peel->num_words * LP_PEEL_WORD_SIZE;
   tile->block_size = peel->num_samples * tile->sample_size;
   if (!tile->num_valid)
      take_spare(tile);
   tile->counts = (uint32_t *)(tile->data + (size_t)LP_PEEL_TILE_BLOCKS *
                                            tile->block_size);

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
}


static int32_t
block_farthest(struct lp_peel_tile *tile, unsigned block)
{
   if (!tile->valid[block])
      return INT32_MAX;
   if (!(tile->changed[block] & LP_PEEL_UNKNOWN))
      return tile->block_farthest[block];

   int32_t farthest = INT32_MIN;
   for (unsigned s = 0; s < tile->peel->num_samples; s++) {
      for (unsigned q = 0; q < 4; q++) {
         const int32_t *depths =
            (int32_t *)tile_words(tile, block, quad_count(tile, block, s, q),
                                  s) + 4 * q;

         for (unsigned i = 0; i < 4; i++)
            farthest = MAX2(farthest, depths[i]);
      }
   }
   if (farthest >= tile->empty)
      farthest = INT32_MAX;
   tile->block_farthest[block] = farthest;
   tile->changed[block] &= ~LP_PEEL_UNKNOWN;
   return farthest;
}


int32_t
lp_peel_tile_farthest(struct lp_peel_tile *tile, bool exact)
{
   const struct lp_rasterizer_task *task = tile->task;
   int32_t farthest = INT32_MIN;

   /* It only gets nearer, so that an old one is right, too. */
   if (!exact && tile->farthest_age++ % 16)
      return tile->farthest;

   for (unsigned y = 0; y < DIV_ROUND_UP(task->height, 4); y++) {
      for (unsigned x = 0; x < DIV_ROUND_UP(task->width, 4); x++) {
         const int32_t f = block_farthest(tile, y * (TILE_SIZE / 4) + x);

         farthest = MAX2(farthest, f);
         if (farthest == INT32_MAX)
            return farthest;
      }
   }
   return tile->farthest = farthest;
}


void
lp_peel_tiles_destroy(struct lp_rasterizer *rast)
{
   for (unsigned i = 0; i < MAX2(1, rast->num_threads); i++) {
      struct lp_peel_tile *tile = rast->tasks[i].thread_data.peel_tile;

      if (tile) {
         align_free(tile->data);
         align_free(tile->spare);
         FREE(tile);
      }
   }
}
