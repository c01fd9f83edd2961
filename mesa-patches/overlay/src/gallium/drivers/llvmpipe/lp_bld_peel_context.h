/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_bld_peel_context.h
 * What the parts of depth peeling in the fragment function share.
 */

#ifndef LP_BLD_PEEL_CONTEXT_H
#define LP_BLD_PEEL_CONTEXT_H

#include "lp_bld_peel.h"

#include "gallivm/lp_bld_const.h"
#include "gallivm/lp_bld_init.h"
#include "gallivm/lp_bld_swizzle.h"

#include "lp_peel.h"
#include "lp_peel_tile.h"
#include "lp_state_fs.h"

/** The depth, and of each color buffer up to 4. */
#define MAX_WORDS (1 + 4 * PIPE_MAX_COLOR_BUFS)


/** The layers of a group of pixels, in one sample. */
struct peel_context
{
   struct gallivm_state *gallivm;
   LLVMBuilderRef builder;
   const struct lp_build_kbuf_params *params;
   const struct lp_peel_key *key;
   struct lp_type type;        /**< of words */
   LLVMTypeRef vec_type;

   LLVMValueRef tile;
   LLVMValueRef block;         /**< number of the block in the tile */
   LLVMValueRef layers;        /**< pointer to the nearest */
   LLVMValueRef count_ptr;
   LLVMValueRef last;          /**< number of the last layer that is there */
   LLVMValueRef last_ptr;

   unsigned num_words;
   uint32_t bits[MAX_WORDS];   /**< those that move */
   LLVMValueRef fragment[MAX_WORDS];
};


static inline LLVMValueRef
byte_offset(struct peel_context *ctx, LLVMValueRef ptr, LLVMValueRef offset)
{
   LLVMTypeRef int8_type = LLVMInt8TypeInContext(ctx->gallivm->context);

   return LLVMBuildGEP2(ctx->builder, int8_type, ptr, &offset, 1, "");
}


static inline LLVMValueRef
const_offset(struct peel_context *ctx, LLVMValueRef ptr, int offset)
{
   return byte_offset(ctx, ptr, lp_build_const_int32(ctx->gallivm, offset));
}


static inline LLVMValueRef
load_ptr(struct peel_context *ctx, LLVMValueRef base, size_t offset)
{
   LLVMTypeRef ptr_type =
      LLVMPointerType(LLVMInt8TypeInContext(ctx->gallivm->context), 0);

   return LLVMBuildLoad2(ctx->builder, ptr_type,
                         const_offset(ctx, base, offset), "");
}


static inline LLVMValueRef
load_int32(struct peel_context *ctx, LLVMValueRef base, size_t offset)
{
   return LLVMBuildLoad2(ctx->builder,
                         LLVMInt32TypeInContext(ctx->gallivm->context),
                         const_offset(ctx, base, offset), "");
}


static inline LLVMValueRef
load_vec(struct peel_context *ctx, LLVMValueRef ptr, int offset)
{
   LLVMValueRef value = LLVMBuildLoad2(ctx->builder, ctx->vec_type,
                                       const_offset(ctx, ptr, offset), "");

   LLVMSetAlignment(value, ctx->type.length * 4);
   return value;
}


static inline void
store_vec(struct peel_context *ctx, LLVMValueRef value, LLVMValueRef ptr,
          int offset)
{
   LLVMValueRef instr = LLVMBuildStore(ctx->builder, value,
                                       const_offset(ctx, ptr, offset));

   LLVMSetAlignment(instr, ctx->type.length * 4);
}


static inline LLVMValueRef
broadcast(struct peel_context *ctx, LLVMValueRef scalar)
{
   return lp_build_broadcast(ctx->gallivm, ctx->vec_type, scalar);
}


/** Masks are vectors of 0 and -1, of which only the sign is looked at. */
static inline LLVMValueRef
less(struct peel_context *ctx, LLVMValueRef a, LLVMValueRef b)
{
   return LLVMBuildSExt(ctx->builder,
                        LLVMBuildICmp(ctx->builder, LLVMIntSLT, a, b, ""),
                        ctx->vec_type, "");
}


static inline LLVMValueRef
equal(struct peel_context *ctx, LLVMValueRef a, LLVMValueRef b)
{
   return LLVMBuildSExt(ctx->builder,
                        LLVMBuildICmp(ctx->builder, LLVMIntEQ, a, b, ""),
                        ctx->vec_type, "");
}


static inline LLVMValueRef
and(struct peel_context *ctx, LLVMValueRef a, LLVMValueRef b)
{
   return LLVMBuildAnd(ctx->builder, a, b, "");
}


static inline LLVMValueRef
and_not(struct peel_context *ctx, LLVMValueRef a, LLVMValueRef b)
{
   return LLVMBuildAnd(ctx->builder, a, LLVMBuildNot(ctx->builder, b, ""), "");
}


static inline LLVMValueRef
any(struct peel_context *ctx, LLVMValueRef mask)
{
   LLVMTypeRef bits_type = LLVMIntTypeInContext(ctx->gallivm->context,
                                                ctx->type.length);
   LLVMValueRef bits =
      LLVMBuildICmp(ctx->builder, LLVMIntSLT, mask,
                    LLVMConstNull(ctx->vec_type), "");

   bits = LLVMBuildBitCast(ctx->builder, bits, bits_type, "");
   return LLVMBuildICmp(ctx->builder, LLVMIntNE, bits,
                        LLVMConstNull(bits_type), "");
}


static inline LLVMValueRef
select_lanes(struct peel_context *ctx, LLVMValueRef mask,
             LLVMValueRef a, LLVMValueRef b)
{
   mask = LLVMBuildICmp(ctx->builder, LLVMIntSLT, mask,
                        LLVMConstNull(ctx->vec_type), "");
   return LLVMBuildSelect(ctx->builder, mask, a, b, "");
}


/** Whether a fragment of the first depth goes in front of the second. */
static inline LLVMValueRef
passes(struct peel_context *ctx, LLVMValueRef depth, LLVMValueRef layer)
{
   if (!ctx->key->equal)
      return less(ctx, depth, layer);

   return LLVMBuildSExt(ctx->builder,
                        LLVMBuildICmp(ctx->builder, LLVMIntSLE, depth, layer, ""),
                        ctx->vec_type, "");
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
