/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file sp_quad_peel.c
 * The quad stage of depth peeling (pipe/p_kbuffer.h), in the place of the
 * depth and stencil tests and of blending.
 *
 * It comes after the fragment shader, which therefore always runs in full, and
 * works on the attachments themselves, for the reasons that sp_quad_kbuffer.c
 * gives.  All k layers of a pixel are one list, sorted by depth and in each
 * attachment alike: a fragment is stored by moving what is behind it back.
 */

#include "sp_context.h"
#include "sp_kbuffer.h"
#include "sp_peel.h"
#include "sp_quad.h"
#include "sp_quad_pipe.h"
#include "sp_tile_cache.h"

#include "tgsi/tgsi_exec.h"
#include "util/format/u_format.h"
#include "util/u_memory.h"

/** An attachment. */
struct plane
{
   enum pipe_format format;
   uint8_t **layers;
   unsigned stride;
   unsigned pixel_bytes;
   int color;        /**< fragment shader output, -1: none */

   /** Bits that move; all others stay where they are. */
   uint8_t bits[SP_MAX_PIXEL_BYTES];
   bool all_bits;
};

struct peel_stage
{
   struct quad_stage base;

   unsigned num_layers;
   struct plane depth;
   unsigned num_colors;
   struct plane colors[PIPE_MAX_COLOR_BUFS];

   struct sp_depth_layout layout;
   double empty;
};

static inline struct peel_stage *
peel_stage(struct quad_stage *base)
{
   return container_of(base, struct peel_stage, base);
}

/**
 * Interpolate as the ordinary depth test does for Z16, which steps in integers
 * from the first quad on: one layer shall be the ordinary depth buffer.
 */
static void
step_depth16(struct quad_header *quads[], unsigned q,
             uint32_t depth[TGSI_QUAD_SIZE])
{
   const struct quad_header_input *first = &quads[0]->input;
   const float dzdx = quads[0]->posCoef->dadx[2];
   const float dzdy = quads[0]->posCoef->dady[2];
   const float z0 = quads[0]->posCoef->a0[2] + dzdx * (float)first->x0 +
                    dzdy * (float)first->y0;
   const float z[TGSI_QUAD_SIZE] = {
      z0, z0 + dzdx, z0 + dzdy, z0 + dzdx + dzdy,
   };
   const uint16_t step = (int)(dzdx * 65535.0f);
   const int dx = quads[q]->input.x0 - first->x0;

   for (unsigned j = 0; j < TGSI_QUAD_SIZE; j++)
      depth[j] = (uint16_t)((int)(z[j] * 65535.0f) + dx * step);
}

/**
 * The depth of the four fragments as the buffer stores it, not yet shifted.
 *
 * \return the fragments that have one: NaN is none
 */
static unsigned
load_depth(const struct peel_stage *stage, struct quad_header *quads[],
           unsigned q, unsigned viewport_index, uint32_t depth[TGSI_QUAD_SIZE])
{
   const struct softpipe_context *sp = stage->base.softpipe;
   const bool interpolated = !sp_kbuffer_shader_writes_depth(sp);
   const bool clamped = !sp->rasterizer->depth_clip_near;
   unsigned mask = 0;
   float z[TGSI_QUAD_SIZE];

   sp_kbuffer_load_depth(sp, quads[q], z);
   for (unsigned j = 0; j < TGSI_QUAD_SIZE; j++) {
      if (!isnan(z[j]))
         mask |= 1 << j;
   }

   if (stage->layout.format == PIPE_FORMAT_Z16_UNORM && interpolated &&
       !clamped && !sp->depth_stencil->alpha_enabled) {
      step_depth16(quads, q, depth);
      return mask;
   }

   sp_kbuffer_clamp_depth(sp, viewport_index, z);

   u_foreach_bit(j, mask) {
      if (stage->layout.is_float)
         depth[j] = fui(z[j]);
      else if (stage->layout.max == 0xffffffff)
         depth[j] = (uint32_t)(z[j] * (double)stage->layout.max);
      else
         depth[j] = (uint32_t)(z[j] * (float)stage->layout.max);
   }

   return mask;
}

static uint8_t *
pixel_address(const struct plane *plane, unsigned layer, unsigned x,
              unsigned y)
{
   return plane->layers[layer] + (size_t)y * plane->stride +
          x * plane->pixel_bytes;
}

/** Whether the fragment is behind the bound, where its arrival counts. */
static bool
is_behind_bound(const struct peel_stage *stage, unsigned x, unsigned y,
                double z)
{
   const struct pipe_peel_state *state = &stage->base.softpipe->kbuffer.peel;
   const struct sp_peel_object *peel = state->object;

   if (!peel->bounds)
      return true;

   struct sp_peel_bound *bound = &peel->bounds[(size_t)y * peel->width + x];

   if (z == bound->depth)
      return bound->arrived++ >= bound->kept;

   return sp_depth_is_nearer(state->func, bound->depth, z);
}

/** \return the layer that the fragment goes to, num_layers for none */
static unsigned
find_layer(const struct peel_stage *stage, unsigned x, unsigned y, double z)
{
   const struct pipe_peel_state *state = &stage->base.softpipe->kbuffer.peel;
   struct sp_peel_object *peel = state->object;
   unsigned layer;

   if (!sp_depth_is_nearer(state->func, z, stage->empty) ||
       !is_behind_bound(stage, x, y, z))
      return stage->num_layers;

   for (layer = 0; layer < stage->num_layers; layer++) {
      const uint8_t *pixel = pixel_address(&stage->depth, layer, x, y);

      if (sp_depth_passes(state->func, z,
                          sp_load_depth_value(&stage->layout, pixel)))
         break;
   }

   /* Either this fragment falls out or what the last layer holds. */
   const double last =
      sp_load_depth_value(&stage->layout,
                          pixel_address(&stage->depth, stage->num_layers - 1,
                                        x, y));
   if (layer == stage->num_layers ||
       sp_depth_is_nearer(state->func, last, stage->empty))
      peel->overflowed = true;

   return layer;
}

static void
store_bits(const struct plane *plane, uint8_t *dst, const uint8_t *src)
{
   if (plane->all_bits)
      memcpy(dst, src, plane->pixel_bytes);
   else
      sp_kbuffer_merge_bits(dst, src, plane->bits, plane->pixel_bytes);
}

/** Put a pixel into a layer and move that and what is behind it back. */
static void
insert_pixel(const struct peel_stage *stage, const struct plane *plane,
             unsigned layer, unsigned x, unsigned y, const uint8_t *src)
{
   uint8_t *dst = pixel_address(plane, stage->num_layers - 1, x, y);

   for (unsigned i = stage->num_layers - 1; i > layer; i--) {
      uint8_t *before = pixel_address(plane, i - 1, x, y);

      store_bits(plane, dst, before);
      dst = before;
   }
   store_bits(plane, dst, src);
}

static void
insert_depth(const struct peel_stage *stage, const struct quad_header *quad,
             const unsigned layer[TGSI_QUAD_SIZE],
             const uint32_t depth[TGSI_QUAD_SIZE])
{
   u_foreach_bit(j, quad->inout.mask) {
      const uint32_t bits = depth[j] << stage->layout.shift;
      uint8_t src[sizeof(uint64_t)] = { 0 };

      if (stage->layout.pixel_bytes == 2)
         *(uint16_t *)src = bits;
      else
         *(uint32_t *)src = bits;

      insert_pixel(stage, &stage->depth, layer[j], quad->input.x0 + (j & 1),
                   quad->input.y0 + (j >> 1), src);
   }
}

/** Pack the colors of the four fragments as blending without blending does. */
static void
pack_colors(const struct peel_stage *stage, const struct plane *plane,
            const struct quad_header *quad,
            uint8_t packed[TGSI_QUAD_SIZE * SP_MAX_PIXEL_BYTES])
{
   const bool integer = util_format_is_pure_integer(plane->format);
   struct tgsi_exec_vector color;
   uint32_t rgba[TGSI_QUAD_SIZE][TGSI_NUM_CHANNELS];

   if (integer && plane->color >= 0) {
      memcpy(&color, quad->output.color[plane->color], sizeof(color));
   } else {
      sp_kbuffer_load_color(stage->base.softpipe, quad, plane->color, &color);
      for (unsigned j = 0; integer && j < TGSI_QUAD_SIZE; j++)
         color.xyzw[3].u[j] = 1;
   }

   for (unsigned j = 0; j < TGSI_QUAD_SIZE; j++) {
      for (unsigned c = 0; c < TGSI_NUM_CHANNELS; c++)
         rgba[j][c] = color.xyzw[c].u[j];
   }

   util_format_write_4(plane->format, rgba, 2 * sizeof(rgba[0]),
                       packed, 2 * plane->pixel_bytes, 0, 0, 2, 2);
}

static void
insert_colors(const struct peel_stage *stage, const struct plane *plane,
              const struct quad_header *quad,
              const unsigned layer[TGSI_QUAD_SIZE])
{
   uint8_t packed[TGSI_QUAD_SIZE * SP_MAX_PIXEL_BYTES];

   pack_colors(stage, plane, quad, packed);

   u_foreach_bit(j, quad->inout.mask) {
      insert_pixel(stage, plane, layer[j], quad->input.x0 + (j & 1),
                   quad->input.y0 + (j >> 1),
                   packed + j * plane->pixel_bytes);
   }
}

static void
peel_quad(struct peel_stage *stage, struct quad_header *quads[], unsigned q,
          unsigned viewport_index)
{
   struct softpipe_context *sp = stage->base.softpipe;
   struct quad_header *quad = quads[q];
   uint32_t depth[TGSI_QUAD_SIZE];
   unsigned layer[TGSI_QUAD_SIZE];

   quad->inout.mask &= load_depth(stage, quads, q, viewport_index, depth);

   u_foreach_bit(j, quad->inout.mask) {
      layer[j] = find_layer(stage, quad->input.x0 + (j & 1),
                            quad->input.y0 + (j >> 1),
                            sp_depth_value(&stage->layout,
                                           depth[j] << stage->layout.shift));
      if (layer[j] == stage->num_layers)
         quad->inout.mask &= ~(1 << j);
   }

   if (!quad->inout.mask)
      return;

   insert_depth(stage, quad, layer, depth);
   for (unsigned i = 0; i < stage->num_colors; i++)
      insert_colors(stage, &stage->colors[i], quad, layer);

   if (sp->active_query_count)
      sp->occlusion_count += util_bitcount(quad->inout.mask);
}

static void
run(struct quad_stage *qs, struct quad_header *quads[], unsigned nr)
{
   struct peel_stage *stage = peel_stage(qs);
   const struct softpipe_context *sp = qs->softpipe;
   const struct pipe_peel_state *state = &sp->kbuffer.peel;
   const struct sp_peel_object *peel = state->object;

   /* Only the first quad of a primitive has it. */
   const unsigned viewport_index = quads[0]->input.viewport_index;

   if (!peel || peel->exhausted || !state->writemask || !stage->num_layers)
      return;

   if (sp->depth_stencil->alpha_enabled)
      nr = sp_alpha_test_quads(qs, quads, nr);

   for (unsigned q = 0; q < nr; q++)
      peel_quad(stage, quads, q, viewport_index);
}

/** \return false if there is nothing to write to */
static bool
setup_plane(struct plane *plane, struct softpipe_tile_cache *tc,
            unsigned components)
{
   /* Afterwards no tile is cached and no clear is pending. */
   sp_flush_tile_cache(tc);

   plane->format = tc->surface->format;
   plane->layers = (uint8_t **)tc->transfer_map;
   plane->stride = tc->transfer[0]->stride;
   plane->pixel_bytes = util_format_get_blocksize(plane->format);

   sp_kbuffer_component_bits(plane->format, components, plane->bits);

   plane->all_bits = true;
   bool any_bits = false;
   for (unsigned i = 0; i < plane->pixel_bytes; i++) {
      plane->all_bits &= plane->bits[i] == 0xff;
      any_bits |= plane->bits[i] != 0;
   }

   return any_bits;
}

static void
setup_colors(struct peel_stage *stage)
{
   struct softpipe_context *sp = stage->base.softpipe;
   const struct pipe_blend_state *blend = sp->blend;
   int8_t color[PIPE_MAX_COLOR_BUFS];

   sp_kbuffer_find_colors(sp, color);

   stage->num_colors = 0;
   for (unsigned i = 0; i < sp->framebuffer.nr_cbufs; i++) {
      struct softpipe_tile_cache *tc = sp->cbuf_cache[i];
      const unsigned rt = blend->independent_blend_enable ? i : 0;
      struct plane *plane = &stage->colors[stage->num_colors];

      if (!sp->framebuffer.cbufs[i])
         continue;

      assert(tc->num_maps == stage->num_layers);
      if (setup_plane(plane, tc, blend->rt[rt].colormask)) {
         plane->color = color[i];
         stage->num_colors++;
      }
   }
}

static void
begin(struct quad_stage *qs)
{
   struct peel_stage *stage = peel_stage(qs);
   struct softpipe_context *sp = qs->softpipe;
   const struct pipe_peel_state *state = &sp->kbuffer.peel;

   stage->num_layers = 0;
   if (!state->object || !sp->framebuffer.zsbuf)
      return;

   stage->num_layers = sp->zsbuf_cache->num_maps;
   stage->layout = sp_get_depth_layout(sp->framebuffer.zsbuf->format);
   stage->empty = sp_cleared_depth_value(&stage->layout, state->empty_depth);

   /* The depth is the first component, stencil the second. */
   setup_plane(&stage->depth, sp->zsbuf_cache, 0x1);
   setup_colors(stage);
}

static void
destroy(struct quad_stage *qs)
{
   FREE(peel_stage(qs));
}

struct quad_stage *
sp_quad_peel_stage(struct softpipe_context *softpipe)
{
   struct peel_stage *stage = CALLOC_STRUCT(peel_stage);

   if (!stage)
      return NULL;

   stage->base.softpipe = softpipe;
   stage->base.begin = begin;
   stage->base.run = run;
   stage->base.destroy = destroy;

   return &stage->base;
}
