/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_kbuf_tile.h"

#include "util/format/u_format.h"
#include "util/u_atomic.h"
#include "util/u_math.h"
#include "util/u_memory.h"

#include "lp_rast_priv.h"
#include "lp_scene.h"
#include "lp_state_fs.h"
#include "lp_tile_pixels.h"

/* Room for all entries with the largest pixels. */
#define TILE_DATA_SIZE \
   (LP_KBUF_TILE_BLOCKS * LP_MAX_KBUF_ENTRIES * 4 * LP_KBUF_WORD_SIZE)


void
lp_kbuf_layout_init(struct lp_kbuf_layout *layout, unsigned num_entries,
                    unsigned num_color_buffers,
                    const enum pipe_format *formats, unsigned num_formats)
{
   layout->size = 0;
   for (unsigned e = 0; e < num_entries; e++) {
      const unsigned cbuf = e % num_color_buffers;

      layout->offset[e] = layout->size;
      if (cbuf < num_formats && formats[cbuf] != PIPE_FORMAT_NONE) {
         layout->size +=
            DIV_ROUND_UP(util_format_get_blocksizebits(formats[cbuf]), 32);
      }
   }
}


/** Copy entries of a block in (or out), or clear them. */
static void
copy_entries(struct lp_kbuf_tile *tile, unsigned block, uint64_t entries,
             bool in)
{
   const struct lp_rasterizer_task *task = tile->task;
   const struct lp_scene *scene = task->scene;
   const struct lp_jit_kbuf *kbuf = tile->kbuf;
   const unsigned x = block % (TILE_SIZE / 4) * 4;
   const unsigned y = block / (TILE_SIZE / 4) * 4;
   uint32_t *words = (uint32_t *)(tile->data + block * kbuf->block_size);

   for (unsigned e = 0; e < kbuf->num_entries; e++) {
      const unsigned cbuf = e % kbuf->num_color_buffers;

      if (cbuf >= scene->fb.nr_cbufs || !scene->fb.cbufs[cbuf])
         continue;

      const unsigned stride = scene->cbufs[cbuf].stride;
      const unsigned bytes = scene->cbufs[cbuf].format_bytes;
      uint8_t *pixels = task->color_tiles[cbuf] +
                        e / kbuf->num_color_buffers * kbuf->layer_stride[cbuf] +
                        y * stride + x * bytes;

      if (!(entries & BITFIELD64_BIT(e))) {
         /* stays as it is */
      } else if (!in) {
         const uint32_t *const quads[4] = {
            words, words + 4, words + 8, words + 12
         };
         lp_tile_store_pixels(quads, pixels, stride, bytes, false);
      } else if (tile->cleared & (1 << cbuf)) {
         lp_tile_fill_pixels(words, tile->clears[cbuf]->color_val.ui, bytes);
      } else {
         lp_tile_load_pixels(words, pixels, stride, bytes);
      }
      words += DIV_ROUND_UP(bytes, 4) * 16;
   }
}


static void
load_block(struct lp_kbuf_tile *tile, uint32_t block)
{
   copy_entries(tile, block, ~UINT64_C(0), true);
   tile->valid[block] = true;
   tile->num_valid++;
}


/** The entries that a color buffer has in the tile. */
static uint64_t
entries_of(const struct lp_jit_kbuf *kbuf, unsigned cbuf)
{
   uint64_t entries = 0;

   for (unsigned e = cbuf; e < kbuf->num_entries; e += kbuf->num_color_buffers)
      entries |= BITFIELD64_BIT(e);
   return entries;
}


/** Whether all layers of a color buffer are in the tile. */
static bool
has_all(const struct lp_kbuf_tile *tile, unsigned cbuf)
{
   const struct lp_jit_kbuf *kbuf = tile->kbuf;

   return cbuf < kbuf->num_color_buffers &&
          util_bitcount64(entries_of(kbuf, cbuf)) ==
          tile->task->scene->cbufs[cbuf].layer_count;
}


static void
store_blocks(struct lp_kbuf_tile *tile)
{
   const struct lp_rasterizer_task *task = tile->task;
   uint64_t stored = tile->written;

   u_foreach_bit(cbuf, tile->cleared)
      stored |= entries_of(tile->kbuf, cbuf);

   for (unsigned y = 0; y < DIV_ROUND_UP(task->height, 4); y++) {
      for (unsigned x = 0; x < DIV_ROUND_UP(task->width, 4); x++) {
         const unsigned block = y * (TILE_SIZE / 4) + x;

         /* Clear what is not in use by the way. */
         if (tile->cleared && !tile->valid[block])
            load_block(tile, block);
         if (tile->valid[block])
            copy_entries(tile, block, stored, false);
      }
   }
}


void
lp_kbuf_tile_flush(struct lp_kbuf_tile *tile)
{
   const uint32_t cleared = tile->cleared;

   if (tile->num_valid) {
      store_blocks(tile);
      memset(tile->valid, 0, sizeof tile->valid);
      tile->num_valid = 0;
      tile->cleared = 0;
   } else {
      tile->cleared = 0;
      u_foreach_bit(cbuf, cleared) {
         const union lp_rast_cmd_arg arg = { .clear_rb = tile->clears[cbuf] };

         tile->clear_color(tile->task, arg);
      }
   }
   tile->written = tile->kbuf ? tile->kbuf->written : 0;
}


bool
lp_kbuf_tile_clear(struct lp_kbuf_tile *tile,
                   const struct lp_rast_clear_rb *clear)
{
   const struct lp_rasterizer_task *task = tile->task;

   /* The rest of a block at the edge may belong to the texture. */
   if (tile->bypassed || task->width % 4 || task->height % 4 ||
       (tile->kbuf && !has_all(tile, clear->cbuf)))
      return false;

   if (tile->num_valid)
      lp_kbuf_tile_flush(tile);
   tile->clears[clear->cbuf] = clear;
   tile->cleared |= 1 << clear->cbuf;
   return true;
}


void
lp_kbuf_tile_set_state(struct lp_rasterizer_task *task)
{
   struct lp_kbuf_tile *tile = task->thread_data.kbuf_tile;
   const struct lp_jit_kbuf *kbuf = task->state->kbuf;

   if (kbuf && !task->state->variant->key.kbuf.tiled)
      kbuf = NULL;

   if (!kbuf ||
       (tile->kbuf &&
        (kbuf->num_entries != tile->kbuf->num_entries ||
         kbuf->num_color_buffers != tile->kbuf->num_color_buffers)))
      lp_kbuf_tile_end(tile);
   tile->bypassed = !kbuf;
   /* Blocks of the tile are found without help. */
   task->nr_cbufs = kbuf ? 0 : task->scene->fb.nr_cbufs;

   if (kbuf) {
      tile->kbuf = kbuf;
      tile->written |= kbuf->written;
      u_foreach_bit(cbuf, tile->cleared) {
         if (!has_all(tile, cbuf))
            lp_kbuf_tile_yield(tile);
      }
   }
}


bool
lp_kbuf_tiles_create(struct lp_rasterizer *rast)
{
   for (unsigned i = 0; i < MAX2(1, rast->num_threads); i++) {
      struct lp_rasterizer_task *task = &rast->tasks[i];

      if (task->thread_data.kbuf_tile)
         continue;

      struct lp_kbuf_tile *tile = CALLOC_STRUCT(lp_kbuf_tile);
      if (!tile)
         return false;

      tile->data = align_malloc(TILE_DATA_SIZE, 64);
      if (!tile->data) {
         FREE(tile);
         return false;
      }
      tile->load_block = load_block;
      tile->task = task;
      /* The thread may be at work, for another context. */
      p_atomic_set(&task->thread_data.kbuf_tile, tile);
   }
   return true;
}


void
lp_kbuf_tiles_destroy(struct lp_rasterizer *rast)
{
   for (unsigned i = 0; i < MAX2(1, rast->num_threads); i++) {
      struct lp_kbuf_tile *tile = rast->tasks[i].thread_data.kbuf_tile;

      if (tile) {
         align_free(tile->data);
         FREE(tile);
      }
   }
}
