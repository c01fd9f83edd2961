/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file sp_kbuffer.h
 * State of the k-buffer stage (pipe/p_kbuffer.h): its programs, which any
 * context of the screen may use, and what one context has bound.  The stage
 * itself is sp_quad_kbuffer.c, or for depth peeling sp_quad_peel.c.
 */

#ifndef SP_KBUFFER_H
#define SP_KBUFFER_H

#include "pipe/p_kbuffer.h"

struct quad_header;
struct quad_stage;
struct softpipe_context;
struct softpipe_tex_tile_cache;
struct sp_tgsi_sampler;
struct tgsi_exec_machine;
struct tgsi_exec_vector;
struct tgsi_token;

#define SP_MAX_KBUFFER_ENTRIES 64
#define SP_MAX_PEEL_LAYERS 256

/** An entry and the TGSI register that a program has it in. */
struct sp_kbuffer_reg
{
   uint8_t entry;
   uint8_t reg;
   uint8_t writemask;   /**< outputs only */
};

/**
 * A k-buffer program, translated to TGSI.  What it reads are shader inputs,
 * what it writes are shader outputs.  It never changes, so that contexts can
 * share it.
 */
struct sp_kbuffer_program
{
   const struct tgsi_token *tokens;

   int8_t position;                    /**< input register, -1: not read */
   int8_t color[PIPE_MAX_COLOR_BUFS];  /**< the same for color outputs */
   bool origin_upper_left;
   bool pixel_center_integer;

   unsigned num_reads;
   struct sp_kbuffer_reg reads[SP_MAX_KBUFFER_ENTRIES];

   unsigned num_writes;
   struct sp_kbuffer_reg writes[SP_MAX_KBUFFER_ENTRIES];
};

/** What pipe_kbuffer_funcs::set_state has bound. */
struct sp_kbuffer
{
   struct sp_kbuffer_program *program;
   unsigned num_color_buffers;

   void *constants;
   unsigned constants_size;

   unsigned num_sampler_views;
   struct pipe_sampler_view *sampler_views[PIPE_MAX_SAMPLERS];
   struct softpipe_tex_tile_cache *tex_cache[PIPE_MAX_SAMPLERS];

   /* Large, so made with the first program: both NULL until then. */
   struct sp_tgsi_sampler *sampler;
   struct tgsi_exec_machine *machine;

   struct pipe_peel_state peel;
};

/** Set the pipe_context functions of the stage. */
void
sp_init_kbuffer(struct softpipe_context *sp);

void
sp_destroy_kbuffer(struct softpipe_context *sp);

/** The last stage of the quad pipeline, in the place of blending. */
struct quad_stage *
sp_quad_kbuffer_stage(struct softpipe_context *sp);

/** The first stage, which goes with it. */
struct quad_stage *
sp_quad_kbuffer_head(struct quad_stage *tail);

/* What depth peeling (sp_quad_peel.c) shares with it. */

#define SP_MAX_PIXEL_BYTES 16

/**
 * The bits of a pixel that hold the given components.  With a shared exponent
 * any component is all of them.
 */
void
sp_kbuffer_component_bits(enum pipe_format format, unsigned components,
                          uint8_t bits[SP_MAX_PIXEL_BYTES]);

static inline void
sp_kbuffer_merge_bits(uint8_t *dst, const uint8_t *src, const uint8_t *bits,
                      unsigned num_bytes)
{
   for (unsigned i = 0; i < num_bytes; i++)
      dst[i] = (dst[i] & ~bits[i]) | (src[i] & bits[i]);
}

/** Color output for each color buffer, -1: the shader has none. */
void
sp_kbuffer_find_colors(const struct softpipe_context *sp,
                       int8_t color[PIPE_MAX_COLOR_BUFS]);

/** A color output, clamped if fragment colors are; -1 gives 0, 0, 0, 1. */
void
sp_kbuffer_load_color(const struct softpipe_context *sp,
                      const struct quad_header *quad, int color,
                      struct tgsi_exec_vector *rgba);

/** Whether the depth is the shader's and not interpolated. */
bool
sp_kbuffer_shader_writes_depth(const struct softpipe_context *sp);

/** The depth of the four fragments. */
void
sp_kbuffer_load_depth(const struct softpipe_context *sp,
                      const struct quad_header *quad, float z[4]);

/** Clamp it as the depth test has to; NaN becomes a number. */
void
sp_kbuffer_clamp_depth(const struct softpipe_context *sp,
                       unsigned viewport_index, float z[4]);

#endif /* SP_KBUFFER_H */
