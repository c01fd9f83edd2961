/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file sp_kbuffer.h
 * State of the k-buffer stage (pipe/p_kbuffer.h): its programs, which any
 * context of the screen may use, and what one context has bound.  The stage
 * itself is sp_quad_kbuffer.c.
 */

#ifndef SP_KBUFFER_H
#define SP_KBUFFER_H

#include "pipe/p_kbuffer.h"

struct quad_stage;
struct softpipe_context;
struct softpipe_tex_tile_cache;
struct sp_tgsi_sampler;
struct tgsi_exec_machine;
struct tgsi_token;

#define SP_MAX_KBUFFER_ENTRIES 64

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

/** What pipe_context::set_kbuffer_state has bound. */
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

#endif /* SP_KBUFFER_H */
