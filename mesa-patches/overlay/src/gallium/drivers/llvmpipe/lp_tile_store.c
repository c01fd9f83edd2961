/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_tile_store.h"

#include "util/u_atomic.h"
#include "util/u_math.h"
#include "util/u_memory.h"

#include "lp_layer_counts.h"
#include "lp_peel_depth.h"
#include "lp_rast_priv.h"
#include "lp_state_fs.h"
#include "lp_tile_blocks.h"


/*
 * Memory.
 */

static struct lp_tile_store *
create_store(struct lp_rasterizer_task *task)
{
   struct lp_tile_store *store = CALLOC_STRUCT(lp_tile_store);

   if (store) {
      store->task = task;
      store->load_block = lp_tile_load_block;
      store->load_last = lp_tile_load_last;
      /* The thread may be at work, for another context. */
      p_atomic_set(&task->thread_data.tile_store, store);
   }
   return store;
}


bool
lp_tile_stores_reserve(struct lp_rasterizer *rast, size_t block_size,
                       unsigned num_samples)
{
   const size_t block_counts = num_samples * LP_TILE_GROUPS;
   const size_t size =
      LP_TILE_BLOCKS * (block_size + block_counts * sizeof(uint32_t));

   for (unsigned i = 0; i < MAX2(1, rast->num_threads); i++) {
      struct lp_tile_store *store = rast->tasks[i].thread_data.tile_store;

      if (!store)
         store = create_store(&rast->tasks[i]);
      if (!store)
         return false;

      if (size > store->reserved) {
         uint8_t *data = align_malloc(size, 64);

         if (!data)
            return false;
         /* What the thread has not taken yet is smaller. */
         align_free(p_atomic_xchg(&store->spare, data));
         store->reserved = size;
      }
   }
   return true;
}


static void
take_spare(struct lp_tile_store *store)
{
   uint8_t *data = p_atomic_xchg(&store->spare, NULL);

   if (data) {
      align_free(store->data);
      store->data = data;
   }
}


void
lp_tile_stores_destroy(struct lp_rasterizer *rast)
{
   for (unsigned i = 0; i < MAX2(1, rast->num_threads); i++) {
      struct lp_tile_store *store = rast->tasks[i].thread_data.tile_store;

      if (store) {
         align_free(store->data);
         align_free(store->spare);
         FREE(store);
      }
   }
}


/*
 * Counts of what is in the buffers.
 */

/** Something else may write to the buffers: the counts hold no longer. */
static void
forget_counts(struct lp_tile_store *store)
{
   if (store->known_counts)
      memset(store->known_counts, 0xff, store->known_counts_size);
}


static void
remember_counts(struct lp_tile_store *store)
{
   const unsigned num_counts = store->layout->num_samples * LP_TILE_GROUPS;

   for (unsigned block = 0; block < LP_TILE_BLOCKS; block++) {
      if (store->valid[block] != LP_TILE_ALL)
         continue;
      for (unsigned i = 0; i < num_counts; i++) {
         lp_tile_known_counts(store, block, 0)[i] =
            lp_tile_counts(store, block, 0)[i];
      }
   }
}


/*
 * Clears.
 */

/** Whether all of each layer is to be cleared. */
static bool
is_cleared(const struct lp_tile_store *store)
{
   const struct pipe_framebuffer_state *fb = &store->task->scene->fb;

   for (unsigned i = 0; i < fb->nr_cbufs; i++) {
      if (fb->cbufs[i] && !(store->clears.colors & (1 << i)))
         return false;
   }
   return store->clears.depth;
}


static void
clear_colors(struct lp_tile_store *store, uint32_t cbufs)
{
   store->clears.colors &= ~cbufs;
   u_foreach_bit(i, cbufs) {
      store->dispatch[LP_RAST_OP_CLEAR_COLOR](store->task,
                                              store->clears.color[i]);
   }
}


static void
clear_zstencil(struct lp_tile_store *store)
{
   if (store->clears.depth) {
      store->clears.depth = false;
      store->dispatch[LP_RAST_OP_CLEAR_ZSTENCIL](store->task,
                                                 store->clears.zstencil);
   }
}


/** Whether the store has all layers of a color buffer. */
static bool
has_all_layers(const struct lp_tile_store *store, unsigned cbuf)
{
   const struct lp_tile_layout *layout = store->layout;

   return cbuf < layout->num_color_buffers &&
          layout->num_layers == store->task->scene->cbufs[cbuf].layer_count;
}


/** Do the clears that are noted of what the store does not have all of. */
static void
clear_buffers(struct lp_tile_store *store)
{
   u_foreach_bit(i, store->clears.colors) {
      if (!has_all_layers(store, i))
         clear_colors(store, BITFIELD_BIT(i));
   }
   if (!store->layout->has_depth)
      clear_zstencil(store);
}


static void
note_clear_zstencil(struct lp_tile_store *store,
                    const union lp_rast_cmd_arg arg)
{
   struct lp_tile_clears *clears = &store->clears;
   struct lp_peel_depth_format format;

   if (clears->depth) {
      const uint64_t mask = arg.clear_zstencil.mask;

      clears->zstencil.clear_zstencil.value &= ~mask;
      clears->zstencil.clear_zstencil.value |= arg.clear_zstencil.value & mask;
      clears->zstencil.clear_zstencil.mask |= mask;
      return;
   }

   lp_peel_depth_format_init(&format, store->task->scene->fb.zsbuf->format,
                             false);
   const uint64_t depth = (uint64_t)lp_peel_depth_mask(&format) << format.shift;
   if (depth && (arg.clear_zstencil.mask & depth) == depth) {
      clears->zstencil = arg;
      clears->depth = true;
   } else {
      store->dispatch[LP_RAST_OP_CLEAR_ZSTENCIL](store->task, arg);
   }
}


static void
flush(struct lp_tile_store *store)
{
   if (store->num_valid) {
      lp_tile_store_blocks(store);
      if (store->peel && store->known_counts)
         remember_counts(store);
      memset(store->valid, 0, sizeof store->valid);
      memset(store->changed, 0, sizeof store->changed);
      store->num_valid = 0;
      store->farthest = INT32_MAX;
      memset(&store->clears, 0, offsetof(struct lp_tile_clears, color));
   } else {
      if (store->known_counts && is_cleared(store))
         memset(store->known_counts, 0, store->known_counts_size);
      clear_colors(store, store->clears.colors);
      clear_zstencil(store);
   }

   if (store->overflow)
      p_atomic_set(&store->peel->object->overflow, 1);
   store->overflow = 0;
}


void
lp_tile_store_clear(struct lp_tile_store *store, unsigned cmd,
                    const union lp_rast_cmd_arg arg)
{
   const struct lp_rasterizer_task *task = store->task;
   const bool is_color = cmd == LP_RAST_OP_CLEAR_COLOR;

   /* The store has no depths of k-buffer programs. */
   if (!is_color && (!task->scene->peels ||
                     (store->layout && !store->layout->has_depth))) {
      store->dispatch[cmd](store->task, arg);
      return;
   }

   forget_counts(store);
   if (store->num_valid)
      flush(store);

   /* The rest of a block at the edge may belong to the texture. */
   if (store->bypassed || task->width % 4 || task->height % 4 ||
       (is_color && store->layout &&
        !has_all_layers(store, arg.clear_rb->cbuf))) {
      store->dispatch[cmd](store->task, arg);
   } else if (is_color) {
      store->clears.color[arg.clear_rb->cbuf] = arg;
      store->clears.colors |= 1 << arg.clear_rb->cbuf;
   } else {
      note_clear_zstencil(store, arg);
   }
}


/*
 * State.
 */

struct lp_tile_store *
lp_tile_store_begin(struct lp_rasterizer_task *task,
                    const lp_rast_cmd_func *dispatch)
{
   struct lp_tile_store *store = p_atomic_read(&task->thread_data.tile_store);
   struct lp_layer_counts *counts = task->scene->layer_counts;

   store->dispatch = dispatch;
   store->layout = NULL;
   store->peel = NULL;
   store->bypassed = false;
   store->written = 0;
   store->farthest = INT32_MAX;
   store->known_counts = NULL;
   if (counts) {
      store->known_counts = lp_layer_counts_tile(counts, task->x, task->y);
      store->known_counts_size =
         counts->tile_counts * sizeof *store->known_counts;
   }
   return store;
}


static bool
is_same_state(const struct lp_tile_store *store,
              const struct lp_tile_layout *layout,
              const struct lp_rast_peel *peel)
{
   return !memcmp(layout, store->layout, sizeof *layout) &&
          (!peel ||
           (peel->depth.reversed == store->peel->depth.reversed &&
            peel->object == store->peel->object));
}


static void
set_peel_state(struct lp_tile_store *store, const struct lp_rast_peel *peel)
{
   const struct lp_rasterizer_task *task = store->task;
   const struct lp_peel_object *object = peel->object;
   const unsigned group_quads = task->state->variant->group_quads;

   assert(!store->num_valid || store->group_quads == group_quads);
   store->group_quads = group_quads;
   store->last_layer = peel->layout.num_layers - 1;
   store->empty = peel->empty;
   if (peel->bounded) {
      store->bounds = object->bounds +
                      ((size_t)task->y / 4 * object->blocks_x + task->x / 4) *
                      object->num_samples;
      store->bound_blocks_x = object->blocks_x;
   }
}


/*
 * A state may still have what draws before it needed: the variant tells whether
 * its draws do.
 */

static const struct lp_rast_peel *
peel_of_state(const struct lp_rast_state *state)
{
   return state->variant->key.kbuf.peel.insert ? state->peel : NULL;
}


/** The layout that the state has in the store, or NULL. */
static const struct lp_tile_layout *
layout_of_state(const struct lp_rast_state *state)
{
   const struct lp_rast_peel *peel = peel_of_state(state);

   if (peel)
      return &peel->layout;
   return state->variant->key.kbuf.tiled ? &state->kbuf->layout : NULL;
}


void
lp_tile_store_set_state(struct lp_tile_store *store)
{
   struct lp_rasterizer_task *task = store->task;
   const struct lp_rast_state *state = task->state;
   const struct lp_tile_layout *layout = layout_of_state(state);
   const struct lp_rast_peel *peel = peel_of_state(state);

   if (!layout ||
       (store->layout && !is_same_state(store, layout, peel))) {
      flush(store);
      forget_counts(store);
      store->written = 0;
   }
   store->kbuf = state->kbuf;
   store->layout = layout;
   store->peel = peel;
   store->bypassed = !layout;
   /* Programs that use the store are not told where the buffers are. */
   task->nr_cbufs = layout && !peel ? 0 : task->scene->fb.nr_cbufs;
   if (!layout)
      return;

   if (!store->num_valid)
      take_spare(store);
   store->sample_size = lp_tile_sample_size(layout);
   store->block_size = lp_tile_block_size(layout);
   store->counts = (uint32_t *)(store->data + (size_t)LP_TILE_BLOCKS *
                                              store->block_size);
   if (peel)
      set_peel_state(store, peel);
   else
      store->written |= state->kbuf->written;
   clear_buffers(store);
}


void
lp_tile_store_end(struct lp_tile_store *store)
{
   flush(store);
}
