/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_bld_peel_context.h
 * What the pieces of depth peeling in the fragment function share.
 */

#ifndef LP_BLD_PEEL_CONTEXT_H
#define LP_BLD_PEEL_CONTEXT_H

#include "lp_bld_peel.h"

#include "gallivm/lp_bld_bitarit.h"
#include "gallivm/lp_bld_logic.h"

#include "lp_bld_tile.h"
#include "lp_peel.h"
#include "lp_state_fs.h"

/** The depth and the colors. */
#define MAX_WORDS (1 + LP_TILE_COLOR_WORDS * PIPE_MAX_COLOR_BUFS)


/** The layers of a group of pixels, in one sample. */
struct peel_context
{
   struct gallivm_state *gallivm;
   const struct lp_build_kbuf_params *params;
   const struct lp_peel_key *key;
   struct lp_build_tile tile;

   LLVMValueRef layers;        /**< pointer to the nearest */
   LLVMValueRef count_ptr;
   LLVMValueRef last;          /**< number of the last layer that is there */
   LLVMValueRef last_ptr;
   LLVMValueRef empty;         /**< depth of a layer without a fragment */

   unsigned num_words;
   uint32_t bits[MAX_WORDS];   /**< those that fragments take along */
   LLVMValueRef fragment[MAX_WORDS];
};


/** Whether any lane of a mask of 0 and -1 is set. */
static inline LLVMValueRef
any_lane(struct peel_context *ctx, LLVMValueRef mask)
{
   struct lp_build_context *bld = &ctx->tile.bld;

   return lp_build_any_true_range(bld, bld->type.length, mask);
}


/** Whether a fragment of the first depth goes in front of the second. */
static inline LLVMValueRef
is_nearer(struct peel_context *ctx, LLVMValueRef depth, LLVMValueRef layer)
{
   return lp_build_cmp(&ctx->tile.bld,
                       ctx->key->equal ? PIPE_FUNC_LEQUAL : PIPE_FUNC_LESS,
                       depth, layer);
}


/**
 * Insert the fragment.
 *
 * \param active  lanes in which it goes before the last layer
 * \param last    the words of that layer
 */
void
lp_build_peel_insert(struct peel_context *ctx, LLVMValueRef active,
                     LLVMValueRef *last);

#endif /* LP_BLD_PEEL_CONTEXT_H */
