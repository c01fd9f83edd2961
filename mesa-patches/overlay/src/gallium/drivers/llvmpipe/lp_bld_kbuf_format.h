/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_bld_kbuf_format.h
 * Pixels of a color buffer as SoA vectors of 32-bit words, and what the words
 * mean.
 *
 * A group is two rows of two or four pixels (one or two quads side by side).
 * All of it is loaded and stored, masked or not: a block of 4x4 pixels
 * belongs to one thread, and every texture is padded to whole blocks.  Only
 * an explicit 1D resource has a single row.
 *
 * In the tile store (lp_tile_store.h) pixels are such vectors already.
 */

#ifndef LP_BLD_KBUF_FORMAT_H
#define LP_BLD_KBUF_FORMAT_H

#include "gallivm/lp_bld.h"
#include "gallivm/lp_bld_type.h"
#include "util/format/u_format.h"

struct gallivm_state;
struct lp_build_tile;

struct lp_kbuf_pixels
{
   struct gallivm_state *gallivm;
   struct lp_type type;        /**< float vectors of 4 or 8 lanes */
   const struct util_format_description *desc;
   LLVMValueRef rows[2];       /**< byte pointers, [1] is NULL in 1D */
   const struct lp_build_tile *tile; /**< NULL: in the buffer itself */
   LLVMValueRef words;         /**< in the tile, in the place of rows */
};

/** Whether conversions need denormals, which are off in raster threads. */
bool
lp_kbuf_format_needs_denormals(const struct util_format_description *desc);

void
lp_build_kbuf_load(const struct lp_kbuf_pixels *pixels, LLVMValueRef rgba[4]);

/** The bits of a pixel's words that hold the components of write_mask. */
void
lp_kbuf_format_bits(const struct util_format_description *desc,
                    unsigned write_mask, uint32_t *bits);

/**
 * The words of a pixel in which the bits of lp_kbuf_format_bits() are as a color
 * is stored without blending; other bits are anything.  Uses neither rows nor
 * words of pixels.
 */
void
lp_build_kbuf_encode(const struct lp_kbuf_pixels *pixels, unsigned write_mask,
                     const LLVMValueRef rgba[4], LLVMValueRef *words);

/**
 * Store the components of write_mask in the lanes of mask; all other bits
 * keep their values.
 */
void
lp_build_kbuf_store(const struct lp_kbuf_pixels *pixels,
                    LLVMValueRef mask, unsigned write_mask,
                    const LLVMValueRef rgba[4]);

#endif /* LP_BLD_KBUF_FORMAT_H */
