/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_bld_tile.h
 * A group of pixels in the tile store (lp_tile_store.h), in generated code.
 */

#ifndef LP_BLD_TILE_H
#define LP_BLD_TILE_H

#include "gallivm/lp_bld.h"
#include "gallivm/lp_bld_const.h"
#include "gallivm/lp_bld_init.h"
#include "gallivm/lp_bld_type.h"

#include "lp_tile_store.h"

struct lp_build_kbuf_params;

struct lp_build_tile
{
   struct gallivm_state *gallivm;
   struct lp_build_context bld;  /**< of words: vectors of signed integers */
   LLVMValueRef store;           /**< pointer to struct lp_tile_store */
   LLVMValueRef block;           /**< number of the block */
};


/*
 * Members of structures and arrays, by their offsets in bytes.
 */

static inline LLVMValueRef
lp_build_byte_offset(struct gallivm_state *gallivm, LLVMValueRef ptr,
                     LLVMValueRef offset)
{
   LLVMTypeRef int8_type = LLVMInt8TypeInContext(gallivm->context);

   return LLVMBuildGEP2(gallivm->builder, int8_type, ptr, &offset, 1, "");
}


static inline LLVMValueRef
lp_build_const_offset(struct gallivm_state *gallivm, LLVMValueRef ptr,
                      int offset)
{
   return lp_build_byte_offset(gallivm, ptr,
                               lp_build_const_int32(gallivm, offset));
}


static inline LLVMValueRef
lp_build_load_ptr_at(struct gallivm_state *gallivm, LLVMValueRef base,
                     int offset)
{
   LLVMTypeRef ptr_type =
      LLVMPointerType(LLVMInt8TypeInContext(gallivm->context), 0);

   return LLVMBuildLoad2(gallivm->builder, ptr_type,
                         lp_build_const_offset(gallivm, base, offset), "");
}


static inline LLVMValueRef
lp_build_load_int32_at(struct gallivm_state *gallivm, LLVMValueRef base,
                       int offset)
{
   return LLVMBuildLoad2(gallivm->builder,
                         LLVMInt32TypeInContext(gallivm->context),
                         lp_build_const_offset(gallivm, base, offset), "");
}


/** The thread's tile store. */
LLVMValueRef
lp_build_tile_store_ptr(struct gallivm_state *gallivm,
                        LLVMValueRef thread_data_ptr);

/**
 * Find the block of a group, and have of it in the store what is needed.
 *
 * \param params  of which type, thread_data_ptr, x and y are used
 */
void
lp_build_tile_begin(struct lp_build_tile *tile, struct gallivm_state *gallivm,
                    const struct lp_build_kbuf_params *params,
                    enum lp_tile_valid needed);

/**
 * The words of the group in the first sample and layer.
 *
 * \param block_size  in bytes, 32 bits
 */
LLVMValueRef
lp_build_tile_words(const struct lp_build_tile *tile, LLVMValueRef group,
                    LLVMValueRef block_size);

/** A vector of 32-bit words of the group. */
LLVMValueRef
lp_build_tile_load(const struct lp_build_tile *tile, LLVMValueRef ptr,
                   int offset);

void
lp_build_tile_store(const struct lp_build_tile *tile, LLVMValueRef value,
                    LLVMValueRef ptr, int offset);

/** A word in which in the lanes of mask some bits are those of new_word. */
LLVMValueRef
lp_build_merge_bits(const struct lp_build_context *bld, LLVMValueRef mask,
                    uint32_t bits, LLVMValueRef new_word,
                    LLVMValueRef old_word);

#endif /* LP_BLD_TILE_H */
