/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_peel.h
 * Depth peeling (pipe/p_kbuffer.h) outside the generated code: the objects,
 * and the way of the state to the rasterizer.
 */

#ifndef LP_PEEL_H
#define LP_PEEL_H

#include <stdbool.h>
#include <stdint.h>

#include "pipe/p_kbuffer.h"

#include "lp_peel_depth.h"
#include "lp_tile_layout.h"

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
   struct lp_tile_layout layout;
   bool bounded;
   int32_t empty;    /**< in comparable form */
   bool stream;      /**< all of it is more than the caches hold */
};

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
