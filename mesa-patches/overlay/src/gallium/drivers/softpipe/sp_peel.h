/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file sp_peel.h
 * Depth peeling (pipe/p_kbuffer.h): what is kept of a framebuffer between
 * draws, and the values of a depth buffer.  The stage that fills the layers
 * is sp_quad_peel.c.
 */

#ifndef SP_PEEL_H
#define SP_PEEL_H

#include "pipe/p_defines.h"
#include "util/format/u_format.h"
#include "util/u_math.h"
#include "util/u_pack_color.h"

struct quad_stage;
struct softpipe_context;

/** Where the depth is in the first 16 or 32 bits of a pixel. */
struct sp_depth_layout
{
   enum pipe_format format;
   unsigned pixel_bytes;
   unsigned shift;
   uint32_t max;     /**< largest depth; the depth's bits, once shifted */
   bool is_float;
};

struct sp_depth_layout
sp_get_depth_layout(enum pipe_format format);

/**
 * Depths of one buffer as numbers that compare exactly as these do: what is
 * stored as an integer stays one, for it may not have a float of its own.
 */
static inline double
sp_depth_value(const struct sp_depth_layout *layout, uint32_t bits)
{
   return layout->is_float ? uif(bits) : (bits >> layout->shift) & layout->max;
}

static inline double
sp_load_depth_value(const struct sp_depth_layout *layout, const uint8_t *pixel)
{
   if (layout->pixel_bytes == 2)
      return *(const uint16_t *)pixel;

   return sp_depth_value(layout, *(const uint32_t *)pixel);
}

/** The value that clears store. */
static inline double
sp_cleared_depth_value(const struct sp_depth_layout *layout, double depth)
{
   return sp_depth_value(layout,
                         util_pack64_z_stencil(layout->format, depth, 0));
}

/** The order of the layers. */
static inline bool
sp_depth_is_nearer(enum pipe_compare_func func, double a, double b)
{
   return func == PIPE_FUNC_LESS || func == PIPE_FUNC_LEQUAL ? a < b : a > b;
}

/** Whether a fragment goes before a layer. */
static inline bool
sp_depth_passes(enum pipe_compare_func func, double z, double layer)
{
   const bool or_equal = func == PIPE_FUNC_LEQUAL || func == PIPE_FUNC_GEQUAL;

   return sp_depth_is_nearer(func, z, layer) || (or_equal && z == layer);
}

/** Only what is behind it, in depth or else in order of arrival, is taken. */
struct sp_peel_bound
{
   double depth;
   uint32_t kept;     /**< fragments of that depth in the layers before */
   uint32_t arrived;  /**< fragments of that depth since then */
};

struct sp_peel_object
{
   /** One for each pixel, or NULL: the first layer begins at rank 0. */
   struct sp_peel_bound *bounds;
   unsigned width, height;

   bool exhausted;    /**< no pixel can take anything any more */
   bool overflowed;
};

/** Set the pipe_context functions of peel objects. */
void
sp_init_peel(struct softpipe_context *sp);

/** In the place of the depth and stencil tests and of blending. */
struct quad_stage *
sp_quad_peel_stage(struct softpipe_context *sp);

#endif /* SP_PEEL_H */
