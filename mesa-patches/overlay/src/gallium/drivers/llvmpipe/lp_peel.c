/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_peel.h"

#include "compiler/nir/nir.h"
#include "util/format/u_format.h"
#include "util/u_atomic.h"
#include "util/u_debug.h"
#include "util/u_framebuffer.h"
#include "util/u_memory.h"

#include "lp_context.h"
#include "lp_flush.h"
#include "lp_kbuf.h"
#include "lp_scene.h"
#include "lp_screen.h"
#include "lp_setup_context.h"
#include "lp_state.h"
#include "lp_state_fs.h"
#include "lp_texture.h"
#include "lp_tile_store.h"


/** From this size on layers go to memory past the caches. */
#define STREAM_SIZE (64 << 20)


/* Off: every fragment is shaded.  Makes no difference to images. */
DEBUG_GET_ONCE_BOOL_OPTION(kbuf_cull, "LP_KBUF_CULL", true)


static bool
is_reversed(enum pipe_compare_func func)
{
   return func == PIPE_FUNC_GREATER || func == PIPE_FUNC_GEQUAL;
}


static unsigned
num_layers(const struct pipe_surface *surf)
{
   return surf->u.tex.last_layer - surf->u.tex.first_layer + 1;
}


/*
 * Objects.
 */

static void *
llvmpipe_create_peel_object(struct pipe_context *pipe)
{
   return CALLOC_STRUCT(lp_peel_object);
}


static void
llvmpipe_delete_peel_object(struct pipe_context *pipe, void *state)
{
   struct lp_peel_object *object = state;

   /* Scenes do not count their references. */
   llvmpipe_finish(pipe, "peel object");
   align_free(object->bounds);
   FREE(object);
}


/** Where the layers of a depth buffer are in memory. */
struct depth_layers
{
   const uint8_t *map;
   unsigned width, height;
   size_t stride, layer_stride, sample_stride;
   unsigned num_layers;
   struct lp_peel_depth_format format;
};


static int32_t
read_depth(const struct depth_layers *layers, unsigned x, unsigned y,
           unsigned layer, unsigned sample)
{
   const uint8_t *pixel = layers->map +
                          layer * layers->layer_stride +
                          sample * layers->sample_stride +
                          y * layers->stride +
                          x * layers->format.bytes;
   uint32_t word = 0;

   memcpy(&word, pixel, MIN2(layers->format.bytes, 4));
   word >>= layers->format.shift;
   if (layers->format.width < 32)
      word &= (1u << layers->format.width) - 1;
   return lp_peel_compare_bits(&layers->format, word);
}


/**
 * The bound of one sample from what its layers hold now.
 *
 * \param old  what bounded this pass, or NULL
 * \return whether the sample could take a fragment behind the new bound
 */
static bool
advance_sample(const struct depth_layers *layers, int32_t empty,
               unsigned x, unsigned y, unsigned sample, unsigned i,
               const struct lp_peel_bound *old, struct lp_peel_bound *bound)
{
   const int32_t depth =
      read_depth(layers, x, y, layers->num_layers - 1, sample);
   bool more = depth < empty;
   uint32_t kept = 0;

   /* Layers are sorted: the first other depth ends it, mostly at once. */
   if (more) {
      for (unsigned layer = layers->num_layers; layer--; kept++) {
         if (read_depth(layers, x, y, layer, sample) != depth)
            break;
      }
   }

   if (old && depth <= old->depth[i]) {
      const uint32_t arrived = old->seen[i] > old->kept[i] ?
                               old->seen[i] - old->kept[i] : 0;
      uint32_t new_kept =
         depth == old->depth[i] ? MIN2(arrived, kept) : 0;

      more &= new_kept > 0;
      if (depth == old->depth[i])
         kept = old->kept[i] + new_kept;
   }

   bound->depth[i] = depth;
   bound->kept[i] = kept;
   bound->seen[i] = 0;
   return more;
}


/** Bounds of an object, for all samples of a depth buffer. */
struct new_bounds
{
   unsigned num_samples, blocks_x, blocks_y;
   struct lp_peel_bound *bounds;
};


static bool
allocate_bounds(struct new_bounds *bounds, const struct pipe_surface *zsbuf)
{
   bounds->num_samples = util_res_sample_count(zsbuf->texture);
   bounds->blocks_x = DIV_ROUND_UP(zsbuf->width, 4);
   bounds->blocks_y = DIV_ROUND_UP(zsbuf->height, 4);

   const size_t size = (size_t)bounds->blocks_x * bounds->blocks_y *
                       bounds->num_samples * sizeof(struct lp_peel_bound);
   bounds->bounds = align_malloc(size, 64);
   if (bounds->bounds)
      memset(bounds->bounds, 0, size);
   return bounds->bounds != NULL;
}


/**
 * Bound all samples by what their layers hold now.
 *
 * \param old  what bounded this pass, or NULL
 * \return whether any sample could take a fragment behind its new bound
 */
static bool
advance_samples(const struct depth_layers *layers, int32_t empty,
                const struct lp_peel_bound *old,
                const struct new_bounds *bounds)
{
   bool more = false;

   for (unsigned y = 0; y < layers->height; y++) {
      for (unsigned x = 0; x < layers->width; x++) {
         const unsigned i = (y & 2) * 4 + (x & 2) * 2 + (y & 1) * 2 + (x & 1);
         const size_t block = (size_t)(y / 4) * bounds->blocks_x + x / 4;

         for (unsigned s = 0; s < bounds->num_samples; s++) {
            const size_t b = block * bounds->num_samples + s;

            more |= advance_sample(layers, empty, x, y, s, i,
                                   old ? &old[b] : NULL, &bounds->bounds[b]);
         }
      }
   }
   return more;
}


static bool
llvmpipe_advance_peel_object(struct pipe_context *pipe, void *state,
                             struct pipe_surface *zsbuf,
                             enum pipe_compare_func func,
                             double empty_depth)
{
   struct llvmpipe_context *lp = llvmpipe_context(pipe);
   struct lp_peel_object *object = state;
   struct new_bounds bounds;

   llvmpipe_finish(pipe, "peel object");
   lp->dirty |= LP_NEW_BLEND;

   if (!zsbuf) {
      align_free(object->bounds);
      memset(object, 0, sizeof *object);
      return true;
   }
   if (!allocate_bounds(&bounds, zsbuf))
      return false;

   const unsigned level = zsbuf->u.tex.level;
   struct depth_layers layers = {
      .map = llvmpipe_resource_map(zsbuf->texture, level,
                                   zsbuf->u.tex.first_layer,
                                   LP_TEX_USAGE_READ),
      .width = zsbuf->width,
      .height = zsbuf->height,
      .stride = llvmpipe_resource_stride(zsbuf->texture, level),
      .layer_stride = llvmpipe_layer_stride(zsbuf->texture, level),
      .sample_stride = llvmpipe_sample_stride(zsbuf->texture),
      .num_layers = num_layers(zsbuf),
   };
   lp_peel_depth_format_init(&layers.format, zsbuf->format, is_reversed(func));
   const int32_t empty = lp_peel_compare_depth(&layers.format, zsbuf->format,
                                               empty_depth);
   const bool same_size = object->num_samples == bounds.num_samples &&
                          object->blocks_x == bounds.blocks_x &&
                          object->blocks_y == bounds.blocks_y;
   const bool more =
      advance_samples(&layers, empty, same_size ? object->bounds : NULL,
                      &bounds);
   llvmpipe_resource_unmap(zsbuf->texture, level, zsbuf->u.tex.first_layer);

   align_free(object->bounds);
   object->num_samples = bounds.num_samples;
   object->blocks_x = bounds.blocks_x;
   object->blocks_y = bounds.blocks_y;
   object->bounds = bounds.bounds;
   object->exhausted = !more;
   object->overflow = 0;
   return true;
}


static bool
llvmpipe_get_peel_overflow(struct pipe_context *pipe, void *state)
{
   const struct lp_peel_object *object = state;

   llvmpipe_finish(pipe, "peel overflow");
   return p_atomic_read(&object->overflow) != 0;
}


/*
 * Draws.
 */

/** Refusing early must not change what the shader does otherwise. */
static bool
can_cull(const struct nir_shader *fs)
{
   return debug_get_option_kbuf_cull() &&
          !(fs->info.outputs_written & BITFIELD64_BIT(FRAG_RESULT_DEPTH)) &&
          !fs->info.writes_memory;
}


/** Whether the bound that an object has is one of this framebuffer. */
static bool
fits_framebuffer(const struct lp_peel_object *object,
                 const struct pipe_framebuffer_state *fb)
{
   return object->num_samples == util_res_sample_count(fb->zsbuf->texture) &&
          object->blocks_x >= DIV_ROUND_UP(fb->width, 4) &&
          object->blocks_y >= DIV_ROUND_UP(fb->height, 4);
}


static bool
has_depth(const struct pipe_framebuffer_state *fb)
{
   return fb->zsbuf &&
          util_format_has_depth(util_format_description(fb->zsbuf->format));
}


static bool
can_insert(const struct llvmpipe_context *lp,
           const struct pipe_framebuffer_state *fb)
{
   const struct pipe_peel_state *peel = &lp->kbuf.peel;
   const struct lp_peel_object *object = peel->object;

   return object && peel->writemask && has_depth(fb) &&
          !(object->bounds &&
            (object->exhausted || !fits_framebuffer(object, fb)));
}


void
lp_peel_make_key(const struct llvmpipe_context *lp,
                 struct lp_fragment_shader_variant_key *key)
{
   const struct pipe_peel_state *peel = &lp->kbuf.peel;
   const struct lp_peel_object *object = peel->object;
   struct lp_peel_key *peel_key = &key->kbuf.peel;

   /* The stage is there instead of these tests, too. */
   memset(&key->depth, 0, sizeof key->depth);
   memset(key->stencil, 0, sizeof key->stencil);
   key->zsbuf_format = PIPE_FORMAT_NONE;

   if (!can_insert(lp, &lp->framebuffer))
      return;

   key->zsbuf_format = lp->framebuffer.zsbuf->format;
   key->kbuf.num_colors = key->nr_cbufs;
   peel_key->insert = true;
   peel_key->reversed = is_reversed(peel->func);
   peel_key->equal =
      peel->func == PIPE_FUNC_LEQUAL || peel->func == PIPE_FUNC_GEQUAL;
   peel_key->bounded = object->bounds != NULL;
   peel_key->cull = can_cull(lp->fs->base.ir.nir) &&
                    key->coverage_samples >= key->zsbuf_nr_samples;
}


static void
init_layout(struct lp_tile_layout *layout,
            const struct pipe_framebuffer_state *fb)
{
   lp_tile_layout_init_fb(layout, true, util_res_sample_count(fb->zsbuf->texture),
                          num_layers(fb->zsbuf), fb->nr_cbufs, fb);
}


/** Have the memory that draws need with a state; false if there is none. */
static bool
reserve_stores(const struct llvmpipe_context *lp,
               const struct pipe_kbuffer_state *state)
{
   struct llvmpipe_screen *screen = llvmpipe_screen(lp->pipe.screen);
   struct lp_tile_layout layout;

   if (!state || !state->peel.object || !has_depth(&lp->framebuffer))
      return true;

   init_layout(&layout, &lp->framebuffer);
   mtx_lock(&screen->rast_mutex);
   const bool reserved =
      lp_tile_stores_reserve(screen->rast, lp_tile_block_size(&layout),
                             layout.num_samples);
   mtx_unlock(&screen->rast_mutex);
   return reserved;
}


/** A state without its memory is not set: draws would rely on it. */
static bool
llvmpipe_set_peel_state(struct pipe_context *pipe,
                        const struct pipe_kbuffer_state *state)
{
   const bool reserved = reserve_stores(llvmpipe_context(pipe), state);

   return llvmpipe_set_kbuffer_state(pipe, reserved ? state : NULL) && reserved;
}


void
lp_peel_init(struct llvmpipe_context *lp)
{
   lp->pipe.kbuffer.create_peel_object = llvmpipe_create_peel_object;
   lp->pipe.kbuffer.delete_peel_object = llvmpipe_delete_peel_object;
   lp->pipe.kbuffer.advance_peel_object = llvmpipe_advance_peel_object;
   lp->pipe.kbuffer.get_peel_overflow = llvmpipe_get_peel_overflow;
   lp->pipe.kbuffer.set_state = llvmpipe_set_peel_state;
}


bool
lp_peel_update_scene(struct lp_setup_context *setup)
{
   struct llvmpipe_context *lp = llvmpipe_context(setup->pipe);
   const struct pipe_framebuffer_state *fb = &setup->fb;
   const struct pipe_peel_state *peel = &lp->kbuf.peel;
   struct lp_peel_object *object = peel->object;

   setup->dirty |= LP_SETUP_NEW_FS;
   setup->fs.current.peel = NULL;

   /*
    * A query can begin a scene before any state is bound, and a clear can do
    * so when the state is bound already that comes with the next framebuffer.
    */
   if (!lp->blend || lp->blend->kbuffer_mode != PIPE_KBUFFER_PEEL ||
       !can_insert(lp, fb))
      return true;

   struct lp_rast_peel *stored = lp_scene_alloc(setup->scene, sizeof *stored);
   if (!stored)
      return false;
   memset(stored, 0, sizeof *stored);

   stored->object = object;
   lp_peel_depth_format_init(&stored->depth, fb->zsbuf->format,
                             is_reversed(peel->func));
   stored->bounded = object->bounds != NULL;
   stored->empty = lp_peel_compare_depth(&stored->depth, fb->zsbuf->format,
                                         peel->empty_depth);
   init_layout(&stored->layout, fb);

   const uint64_t size = (uint64_t)fb->width * fb->height / 16 *
                         lp_tile_block_size(&stored->layout);
   stored->stream = size > STREAM_SIZE;

   setup->fs.current.peel = stored;
   setup->scene->peels = true;
   setup->scene->uses_tile_store = true;
   return true;
}
