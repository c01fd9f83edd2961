/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file sp_peel.c
 * Peel objects: the bound that a framebuffer's layers begin behind, taken
 * from what the layers hold when the bound moves.
 */

#include "sp_peel.h"
#include "sp_context.h"
#include "sp_state.h"

#include "draw/draw_context.h"
#include "util/u_inlines.h"
#include "util/u_memory.h"

struct sp_depth_layout
sp_get_depth_layout(enum pipe_format format)
{
   struct sp_depth_layout layout = {
      .format = format,
      .pixel_bytes = util_format_get_blocksize(format),
   };

   switch (format) {
   case PIPE_FORMAT_Z16_UNORM:
      layout.max = 0xffff;
      break;
   case PIPE_FORMAT_Z24X8_UNORM:
   case PIPE_FORMAT_Z24_UNORM_S8_UINT:
      layout.max = 0xffffff;
      break;
   case PIPE_FORMAT_X8Z24_UNORM:
   case PIPE_FORMAT_S8_UINT_Z24_UNORM:
      layout.max = 0xffffff;
      layout.shift = 8;
      break;
   case PIPE_FORMAT_Z32_UNORM:
      layout.max = 0xffffffff;
      break;
   case PIPE_FORMAT_Z32_FLOAT:
   case PIPE_FORMAT_Z32_FLOAT_S8X24_UINT:
      layout.max = 0xffffffff;
      layout.is_float = true;
      break;
   default:
      unreachable("no depth format");
   }

   return layout;
}

static void *
softpipe_create_peel_object(struct pipe_context *pipe)
{
   return CALLOC_STRUCT(sp_peel_object);
}

static void
softpipe_delete_peel_object(struct pipe_context *pipe, void *object)
{
   struct sp_peel_object *peel = object;

   FREE(peel->bounds);
   FREE(peel);
}

/** The depths of all layers of a pixel. */
struct layers
{
   struct sp_depth_layout layout;
   const uint8_t *pixel;
   size_t stride;
   unsigned num;
};

static double
layer_depth(const struct layers *layers, unsigned layer)
{
   return sp_load_depth_value(&layers->layout,
                              layers->pixel + layer * layers->stride);
}

/**
 * Move a bound to the last layer.
 *
 * \param first  there was no bound before
 * \return false if nothing can be behind the new one
 */
static bool
advance_bound(struct sp_peel_bound *bound, bool first,
              const struct layers *layers, enum pipe_compare_func func,
              double empty)
{
   const double last = layer_depth(layers, layers->num - 1);
   const bool full = sp_depth_is_nearer(func, last, empty);
   unsigned kept = 0;

   /* Layers are sorted: the first other depth ends it, mostly at once. */
   if (full) {
      for (unsigned i = layers->num; i--; kept++) {
         if (layer_depth(layers, i) != last)
            break;
      }
   }

   /* Layers at the depth of the old bound are fragments that were let in
    * behind it, or, if nobody cleared the layers since, counted already.
    */
   const bool further =
      first || sp_depth_is_nearer(func, bound->depth, last);
   const bool same = !further && bound->depth == last;

   if (same) {
      const uint32_t let_in =
         bound->arrived > bound->kept ? bound->arrived - bound->kept : 0;

      kept = MIN2(kept, let_in);
   }

   const bool more = full && (further || (same && kept > 0));

   *bound = (struct sp_peel_bound) {
      .depth = last,
      .kept = same ? bound->kept + kept : kept,
   };

   return more;
}

static bool
advance_bounds(struct pipe_context *pipe, struct sp_peel_object *peel,
               struct pipe_surface *zsbuf, enum pipe_compare_func func,
               double empty_depth)
{
   const bool first = !peel->bounds || peel->width != zsbuf->width ||
                      peel->height != zsbuf->height;
   struct sp_peel_bound *bounds = peel->bounds;

   if (first) {
      bounds = MALLOC((size_t)zsbuf->width * zsbuf->height * sizeof(*bounds));
      if (!bounds)
         return false;
   }

   struct layers layers = {
      .layout = sp_get_depth_layout(zsbuf->format),
      .num = zsbuf->u.tex.last_layer - zsbuf->u.tex.first_layer + 1,
   };
   const double empty = sp_cleared_depth_value(&layers.layout, empty_depth);
   struct pipe_transfer *transfer;
   const uint8_t *map =
      pipe_texture_map_3d(pipe, zsbuf->texture, zsbuf->u.tex.level,
                          PIPE_MAP_READ, 0, 0, zsbuf->u.tex.first_layer,
                          zsbuf->width, zsbuf->height, layers.num, &transfer);
   if (!map) {
      if (first)
         FREE(bounds);
      return false;
   }
   layers.stride = transfer->layer_stride;

   bool more = false;
   struct sp_peel_bound *bound = bounds;

   for (unsigned y = 0; y < zsbuf->height; y++) {
      layers.pixel = map + (size_t)y * transfer->stride;

      for (unsigned x = 0; x < zsbuf->width; x++) {
         more |= advance_bound(bound++, first, &layers, func, empty);
         layers.pixel += layers.layout.pixel_bytes;
      }
   }

   pipe_texture_unmap(pipe, transfer);

   if (first) {
      FREE(peel->bounds);
      peel->bounds = bounds;
      peel->width = zsbuf->width;
      peel->height = zsbuf->height;
   }
   peel->exhausted = !more;

   return true;
}

static bool
softpipe_advance_peel_object(struct pipe_context *pipe, void *object,
                             struct pipe_surface *zsbuf,
                             enum pipe_compare_func func, double empty_depth)
{
   struct sp_peel_object *peel = object;

   /* What has been drawn until now shall be in the layers. */
   draw_flush(softpipe_context(pipe)->draw);

   if (zsbuf) {
      if (!advance_bounds(pipe, peel, zsbuf, func, empty_depth))
         return false;
   } else {
      FREE(peel->bounds);
      peel->bounds = NULL;
      peel->exhausted = false;
   }
   peel->overflowed = false;

   return true;
}

static bool
softpipe_get_peel_overflow(struct pipe_context *pipe, void *object)
{
   const struct sp_peel_object *peel = object;

   draw_flush(softpipe_context(pipe)->draw);

   return peel->overflowed;
}

void
sp_init_peel(struct softpipe_context *sp)
{
   sp->pipe.kbuffer.create_peel_object = softpipe_create_peel_object;
   sp->pipe.kbuffer.delete_peel_object = softpipe_delete_peel_object;
   sp->pipe.kbuffer.advance_peel_object = softpipe_advance_peel_object;
   sp->pipe.kbuffer.get_peel_overflow = softpipe_get_peel_overflow;
}
