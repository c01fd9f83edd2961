/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_peel.h
 * Depth peeling (pipe/p_kbuffer.h) outside the generated code: the objects,
 * and the way of the state to the rasterizer.
 *
 * Depths are compared in a form that serves all formats and functions: as
 * signed integers, of which the lower is the nearer.
 */

#ifndef LP_PEEL_H
#define LP_PEEL_H

#include <stdbool.h>
#include <stdint.h>

#include "pipe/p_kbuffer.h"
#include "util/format/u_formats.h"

struct llvmpipe_context;
struct lp_fragment_shader_variant_key;
struct lp_setup_context;

#define LP_MAX_PEEL_LAYERS 256

/** What the generated code depends on.  All zero when nothing is peeled. */
struct lp_peel_key
{
   bool insert;   /**< false: all fragments are refused */
   bool reversed; /**< the greater depth is the nearer */
   bool equal;    /**< fragments go in front of those of equal depth */
   bool bounded;  /**< only what is behind the bound */
   bool cull;     /**< refuse fragments before they are shaded */
};

/** How a depth is stored. */
struct lp_peel_depth_format
{
   bool floating;
   bool reversed;    /**< see lp_peel_key */
   bool has_stencil;
   uint8_t bytes;    /**< of a pixel */
   uint8_t width;    /**< of the depth, in bits */
   uint8_t shift;
   uint32_t flip;    /**< bits that a sign inverts */
   uint32_t invert;  /**< bits that are always inverted */
};

/** A word for each of the 16 pixels of a 4x4 block, in the order of quads. */
struct lp_peel_bound
{
   int32_t depth[16];  /**< in comparable form */
   uint32_t kept[16];  /**< that earlier passes have kept at this depth */
   uint32_t seen[16];  /**< that have arrived at it in this pass */
};

struct lp_peel_object
{
   unsigned num_samples;
   unsigned blocks_x, blocks_y;
   struct lp_peel_bound *bounds; /**< of block, sample; NULL: rank 0 */
   bool exhausted;               /**< no sample takes anything any more */
   uint32_t overflow;
};

/** Lies in the scene. */
struct lp_rast_peel
{
   struct lp_peel_object *object;
   struct lp_peel_depth_format depth;
   bool bounded;
   int32_t empty;    /**< in comparable form */
   unsigned num_layers;
   unsigned num_samples;
   unsigned num_words;  /**< of a pixel in a layer: depth and colors */
   bool stream;         /**< all of it is more than the caches hold */
};

/** Which bits are the depth's, the lowest of them at 0. */
static inline uint32_t
lp_peel_depth_mask(const struct lp_peel_depth_format *format)
{
   return format->width == 32 ? ~0u : (1u << format->width) - 1;
}

/** Depth bits, the lowest of them at 0, to comparable form, and back. */
static inline int32_t
lp_peel_compare_bits(const struct lp_peel_depth_format *format, uint32_t bits)
{
   bits ^= (uint32_t)((int32_t)bits >> 31) & format->flip;
   return bits ^ format->invert;
}

static inline uint32_t
lp_peel_depth_bits(const struct lp_peel_depth_format *format, int32_t depth)
{
   const uint32_t bits = depth ^ format->invert;

   return bits ^ ((uint32_t)((int32_t)bits >> 31) & format->flip);
}

void
lp_peel_depth_format_init(struct lp_peel_depth_format *depth,
                          enum pipe_format format, bool reversed);

/** 32-bit words of a pixel of a color buffer, 0 if there is none. */
unsigned
lp_peel_color_words(enum pipe_format format);

void
lp_peel_init(struct llvmpipe_context *lp);

/** Add peeling to a key that holds the framebuffer and blend state. */
void
lp_peel_make_key(const struct llvmpipe_context *lp,
                 struct lp_fragment_shader_variant_key *key);

/** Put what peeling needs into the scene; false if that is full. */
bool
lp_peel_update_scene(struct lp_setup_context *setup);

#endif /* LP_PEEL_H */
