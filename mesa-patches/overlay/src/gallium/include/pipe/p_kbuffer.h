/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file p_kbuffer.h
 * The k-buffer stage: a program in the place of fixed-function blending that
 * owns all k entries of a sample.
 *
 * Entry e is color buffer (e mod A) in layer (e div A), A being
 * pipe_kbuffer_state::num_color_buffers.  The stage runs, in primitive order
 * and once for each covered sample, when the bound blend state has
 * kbuffer_mode PIPE_KBUFFER_PROGRAM; blending and logic op are then off and
 * pipe_rt_blend_state::colormask applies per color buffer.  The layer that a
 * primitive selects is ignored.
 *
 * The program is a NIR fragment shader without outputs.  It reads
 *  - shader inputs: VARYING_SLOT_POS is window x, y, the sample's depth as
 *    the fragment stage left it, 1/w; VARYING_SLOT_VAR0 + n is color output n
 *    of the fragment shader;
 *  - load_kbuffer_mesa: an entry as it stood before this fragment;
 * and writes entries by store_kbuffer_mesa, all at the end of the program.
 * An entry or component that is not stored keeps its bits, as do all entries
 * of a fragment that the program discards.  Uniforms are UBO 0, textures and
 * samplers are numbered as in pipe_kbuffer_state.
 *
 * create_kbuffer_state takes the NIR over, also when it fails.  Any context of
 * the screen may set and delete the program; it stays until no context has it
 * set.
 */

#ifndef P_KBUFFER_H
#define P_KBUFFER_H

#include "pipe/p_state.h"

struct pipe_sampler_view;

enum pipe_kbuffer_mode
{
   PIPE_KBUFFER_OFF = 0,
   PIPE_KBUFFER_PROGRAM = 1,
};

struct pipe_kbuffer_state
{
   /** From pipe_context::create_kbuffer_state; NULL: no program. */
   void *program;

   /** A: color draw buffers of the framebuffer, missing ones included. */
   unsigned num_color_buffers;

   /**
    * UBO 0 of the program, user memory that the driver copies during the
    * call; the size is in bytes.
    */
   const void *constants;
   unsigned constants_size;

   /** Holes are NULL.  The driver takes references of its own. */
   unsigned num_sampler_views;
   struct pipe_sampler_view *sampler_views[PIPE_MAX_SAMPLERS];

   /** As many as there are views; copied. */
   struct pipe_sampler_state samplers[PIPE_MAX_SAMPLERS];
};

#endif /* P_KBUFFER_H */
