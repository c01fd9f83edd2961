/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file p_kbuffer.h
 * The k-buffer stage: what stands in the place of fixed-function blending and
 * owns all k entries of a sample.  It is a program, or depth peeling.
 *
 * K-buffer programs
 * -----------------
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
 * create_program takes the NIR over, also when it fails.  Any context of
 * the screen may set and delete the program; it stays until no context has it
 * set.
 *
 * Depth peeling
 * -------------
 *
 * With kbuffer_mode PIPE_KBUFFER_PEEL the stage stands in the place of the
 * depth and stencil tests, too, the state of which is ignored (the alpha test
 * is not).  The depth buffer and all color buffers are arrays of k layers,
 * which hold the k nearest fragments of each sample, nearest first.  "Nearer"
 * is pipe_peel_state::func, applied to depths as the depth buffer would store
 * them: clamped, and in its precision.
 *
 * A fragment takes part if depths are written, its depth is no NaN and is
 * nearer, by the strict form of func, than the empty depth.  It is inserted
 * before the first layer whose depth it passes func against: so fragments of
 * equal depth stay in the order of arrival with LESS and GREATER, and are in
 * the reverse with LEQUAL and GEQUAL.  The layers behind move back by one,
 * colors in their stored form, and the last falls out.  A fragment that
 * passes func against no layer falls out itself.  A layer whose depth is not
 * nearer than the empty depth is empty.  Stencil bits stay as they are.
 * Components that pipe_rt_blend_state::colormask leaves out stay as they are
 * in all layers, those of all other layers move.
 *
 * The peel object of a framebuffer says at which rank layer 0 begins.  It is
 * created at rank 0.  advance_peel_object adds k to the rank: from now on a
 * sample takes only the fragments behind a bound,
 *    d: the depth of its last layer at this moment,
 *    n: how many fragments of depth d this and earlier passes have kept in
 *       layers,
 * that is, those that d is strictly nearer than, and of those at exactly d
 * (which are counted from here on, in order of arrival, if they take part)
 * the ones after the first n.  If no sample could take anything any more then
 * nothing is inserted, and nothing overflows.  A sample could not if its last
 * layer is empty, or if that is no further back than the last bound and holds
 * nothing new at that depth.
 *
 * An object overflows when a fragment behind the bound falls out that was
 * nearer than the empty depth; a fragment that is refused early may count as
 * such although a later test would have discarded it.
 *
 * Occlusion queries count the samples at which a fragment was inserted.
 */

#ifndef P_KBUFFER_H
#define P_KBUFFER_H

#include "pipe/p_state.h"

struct pipe_context;
struct pipe_sampler_view;
struct pipe_shader_state;
struct pipe_surface;

enum pipe_kbuffer_mode
{
   PIPE_KBUFFER_OFF = 0,
   PIPE_KBUFFER_PROGRAM = 1,
   PIPE_KBUFFER_PEEL = 2,
};

struct pipe_peel_state
{
   /**
    * From pipe_kbuffer_funcs::create_peel_object; belongs to the context, and
    * is not deleted while it is set.  It is not set when there was no memory for
    * the state.
    */
   void *object;

   enum pipe_compare_func func;  /**< LESS, LEQUAL, GREATER or GEQUAL */
   bool writemask;               /**< false: nothing is inserted */
   double empty_depth;           /**< what depths are cleared to */
};

struct pipe_kbuffer_state
{
   /** From pipe_kbuffer_funcs::create_program; NULL: no program. */
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

   /** For PIPE_KBUFFER_PEEL only; what is above is then 0. */
   struct pipe_peel_state peel;
};

/**
 * What a context can do with the stage.  All of it is NULL in drivers that have
 * none, and in contexts that wrap those of other drivers.
 */
struct pipe_kbuffer_funcs
{
   void *(*create_program)(struct pipe_context *,
                           const struct pipe_shader_state *);
   void (*delete_program)(struct pipe_context *, void *);

   /**
    * \return false if there is no memory for the state; until the next one,
    *         draws through the stage change nothing then
    */
   bool (*set_state)(struct pipe_context *, const struct pipe_kbuffer_state *);

   /** What depth peeling keeps of a framebuffer between draws. */
   void *(*create_peel_object)(struct pipe_context *);
   void (*delete_peel_object)(struct pipe_context *, void *);

   /**
    * Go on behind the layers that zsbuf holds now, or start over if that is
    * NULL; in either case clear the overflow.  The rest is as in
    * pipe_peel_state.
    *
    * \return false if there is no memory; the object is then as it was
    */
   bool (*advance_peel_object)(struct pipe_context *, void *,
                               struct pipe_surface *zsbuf,
                               enum pipe_compare_func func,
                               double empty_depth);

   /** Whether the object has overflowed; waits for all draws. */
   bool (*get_peel_overflow)(struct pipe_context *, void *);
};

#endif /* P_KBUFFER_H */
