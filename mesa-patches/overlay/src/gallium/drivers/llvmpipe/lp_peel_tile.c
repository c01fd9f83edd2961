/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_peel_tile.h"

#include "util/u_atomic.h"
#include "util/u_math.h"
#include "util/u_memory.h"

#include "lp_peel_blocks.h"
#include "lp_peel_parts.h"
#include "lp_rast_priv.h"
#include "lp_scene.h"
#include "lp_state_fs.h"


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
         lp_peel_part_counts(tile, block, 0)[i] =
            lp_peel_sample_counts(tile, block, 0)[i];
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
      lp_peel_store_blocks(tile);
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
      const uint64_t depth =
         (uint64_t)lp_peel_depth_mask(&format) << format.shift;
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
      tile->load_block = lp_peel_load_block;
      tile->load_last = lp_peel_load_last;
      /* The thread may be at work, for another context. */
      p_atomic_set(&task->thread_data.peel_tile, tile);
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
   struct lp_peel_tile *tile = p_atomic_read(&task->thread_data.peel_tile);
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

   const unsigned group_quads = task->state->variant->group_quads;
   assert(!tile->num_valid || tile->group_quads == group_quads);
   tile->group_quads = group_quads;

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
         const uint32_t last = lp_peel_quad_count(tile, block, s, q);
         const int32_t *depths =
            (int32_t *)lp_peel_tile_words(tile, block, last, s) + 4 * q;

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
