/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_kbuf.h
 * The k-buffer stage (pipe/p_kbuffer.h) outside the generated code: program
 * objects, context state, and its way through the scene to the rasterizer.
 *
 * The stage is on for a draw when the bound blend state says so
 * (pipe_blend_state::kbuffer_mode, which is part of the variant key).
 */

#ifndef LP_KBUF_H
#define LP_KBUF_H

#include <stdbool.h>
#include <stdint.h>

#include "pipe/p_kbuffer.h"
#include "util/u_inlines.h"
#include "util/u_math.h"
#include "gallivm/lp_bld_jit_types.h"

#include "lp_peel.h"
#include "lp_tile_layout.h"

struct llvmpipe_context;
struct lp_fragment_shader_variant_key;
struct lp_sampler_static_state;
struct lp_setup_context;
struct nir_shader;

/** Entries that a program can name. */
#define LP_MAX_KBUF_ENTRIES 64

/** A program belongs to no context, and is never changed. */
struct lp_kbuf_program
{
   struct pipe_reference reference;
   struct nir_shader *nir;
   unsigned num_colors;   /**< last fragment color read, plus 1 */
   unsigned num_entries;  /**< last entry named, plus 1 */
   uint64_t written;      /**< entries that are stored to */
   unsigned num_samplers; /**< last texture or sampler used, plus 1 */
   uint8_t sha1[20];
};

/** The pipe_kbuffer_state of a context, with references of its own. */
struct lp_kbuf_state
{
   struct lp_kbuf_program *program;
   unsigned num_color_buffers;
   void *constants;
   unsigned constants_size; /**< in bytes */
   unsigned num_sampler_views;
   struct pipe_sampler_view *sampler_views[PIPE_MAX_SAMPLERS];
   struct pipe_sampler_state samplers[PIPE_MAX_SAMPLERS];
   struct pipe_peel_state peel;
};

/** What the generated code depends on.  All zero when the stage is off. */
struct lp_kbuf_key
{
   uint8_t num_colors;  /**< fragment colors to keep for the program */
   uint8_t num_entries; /**< entries that exist, of those named */
   bool tiled;          /**< works in the tile store, see lp_tile_store.h */
   uint8_t sha1[20];    /**< program, layout, sampler and texture state */
   struct lp_peel_key peel;
};

/**
 * The fields of struct lp_jit_resources, in its order, so that the code of
 * texture lookups and constant loads applies; only shorter.
 */
struct lp_jit_kbuf_resources
{
   struct lp_jit_buffer constants[1];
   struct lp_jit_buffer ssbos[1];
   struct lp_jit_texture textures[PIPE_MAX_SAMPLERS];
   struct lp_jit_sampler samplers[PIPE_MAX_SAMPLERS];
   struct lp_jit_image images[1];
};

/** Lies in the scene; the generated code finds it by the tile store. */
struct lp_jit_kbuf
{
   uint64_t layer_stride[PIPE_MAX_COLOR_BUFS];
   struct lp_jit_kbuf_resources resources;

   /* For the tile store only. */
   struct lp_tile_layout layout;
   uint64_t written;    /**< entries that are stored to */
};

void
lp_kbuf_init(struct llvmpipe_context *lp);

void
lp_kbuf_destroy(struct llvmpipe_context *lp);

/** As pipe_kbuffer_funcs::set_state, without the memory for depth peeling. */
bool
llvmpipe_set_kbuffer_state(struct pipe_context *pipe,
                           const struct pipe_kbuffer_state *state);

/** Add the stage to a key that holds the framebuffer and blend state. */
void
lp_kbuf_make_key(const struct llvmpipe_context *lp,
                 struct lp_fragment_shader_variant_key *key);

/** Layers of a pixel that hold its entries. */
static inline unsigned
lp_kbuf_num_layers(unsigned num_entries, unsigned num_color_buffers)
{
   return num_entries ? DIV_ROUND_UP(num_entries, num_color_buffers) : 0;
}

void
lp_kbuf_static_samplers(const struct lp_kbuf_state *kbuf,
                        struct lp_sampler_static_state *samplers);

/** Put what the stage reads into the scene; false if that is full. */
bool
lp_kbuf_update_scene(struct lp_setup_context *setup, bool new_scene);

#endif /* LP_KBUF_H */
