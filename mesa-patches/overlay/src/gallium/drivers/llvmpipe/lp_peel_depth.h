/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_peel_depth.h
 * Depths of all formats and for all functions in one form that is compared as
 * signed integers, of which the lower is the nearer.
 */

#ifndef LP_PEEL_DEPTH_H
#define LP_PEEL_DEPTH_H

#include <stdbool.h>
#include <stdint.h>

#include "util/format/u_formats.h"

/** How a depth is stored. */
struct lp_peel_depth_format
{
   bool floating;
   bool reversed;    /**< the greater depth is the nearer */
   bool has_stencil;
   uint8_t bytes;    /**< of a pixel */
   uint8_t width;    /**< of the depth, in bits */
   uint8_t shift;
   uint32_t flip;    /**< bits that a sign inverts */
   uint32_t invert;  /**< bits that are always inverted */
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

/** A depth from 0 to 1 in comparable form. */
int32_t
lp_peel_compare_depth(const struct lp_peel_depth_format *format,
                      enum pipe_format pipe_format, double depth);

#endif /* LP_PEEL_DEPTH_H */
