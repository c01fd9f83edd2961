/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_bld_tile.h"

#include "gallivm/lp_bld_flow.h"
#include "gallivm/lp_bld_logic.h"

#include "lp_bld_kbuf.h"
#include "lp_jit.h"


/*
 * The pointer has no place in the LLVM type of the thread data, as that is in
 * the code of variants that do not use it, which stays as it is without it.
 */
LLVMValueRef
lp_build_tile_store_ptr(struct gallivm_state *gallivm,
                        LLVMValueRef thread_data_ptr)
{
   return lp_build_load_ptr_at(gallivm, thread_data_ptr,
                               offsetof(struct lp_jit_thread_data, tile_store));
}


/** Number of the block of 4x4 pixels that begins at x, y of the framebuffer. */
static LLVMValueRef
block_number(struct gallivm_state *gallivm, LLVMValueRef x, LLVMValueRef y)
{
   LLVMBuilderRef builder = gallivm->builder;

   /* y / 4 % 16 * 16 + x / 4 % 16 */
   STATIC_ASSERT(TILE_SIZE == 64);
   y = LLVMBuildShl(builder, y, lp_build_const_int32(gallivm, 2), "");
   x = LLVMBuildLShr(builder, x, lp_build_const_int32(gallivm, 2), "");
   y = LLVMBuildAnd(builder, y, lp_build_const_int32(gallivm, 0xf0), "");
   x = LLVMBuildAnd(builder, x, lp_build_const_int32(gallivm, 0xf), "");
   return LLVMBuildOr(builder, y, x, "block");
}


/** Have the block loaded if no fragment has come to it before. */
static void
load_block(struct lp_build_tile *tile, enum lp_tile_valid needed)
{
   struct gallivm_state *gallivm = tile->gallivm;
   LLVMBuilderRef builder = gallivm->builder;
   LLVMTypeRef int8_type = LLVMInt8TypeInContext(gallivm->context);
   LLVMTypeRef arg_types[2] = {
      LLVMPointerType(int8_type, 0), LLVMInt32TypeInContext(gallivm->context)
   };
   LLVMTypeRef func_type =
      LLVMFunctionType(LLVMVoidTypeInContext(gallivm->context), arg_types, 2, 0);
   const int func_offset = needed == LP_TILE_LAST ?
      offsetof(struct lp_tile_store, load_last) :
      offsetof(struct lp_tile_store, load_block);
   struct lp_build_if_state missing;

   LLVMValueRef valid =
      lp_build_const_offset(gallivm, tile->store,
                            offsetof(struct lp_tile_store, valid));
   valid = LLVMBuildLoad2(builder, int8_type,
                          lp_build_byte_offset(gallivm, valid, tile->block),
                          "valid");
   lp_build_if(&missing, gallivm,
               LLVMBuildICmp(builder, LLVMIntULT, valid,
                             LLVMConstInt(int8_type, needed, 0), ""));
   {
      LLVMValueRef args[2] = { tile->store, tile->block };
      LLVMValueRef func =
         lp_build_load_ptr_at(gallivm, tile->store, func_offset);

      LLVMBuildCall2(builder, func_type, func, args, 2, "");
   }
   lp_build_endif(&missing);
}


void
lp_build_tile_begin(struct lp_build_tile *tile, struct gallivm_state *gallivm,
                    const struct lp_build_kbuf_params *params,
                    enum lp_tile_valid needed)
{
   tile->gallivm = gallivm;
   lp_build_context_init(&tile->bld, gallivm, lp_int_type(params->type));
   tile->store = lp_build_tile_store_ptr(gallivm, params->thread_data_ptr);
   tile->block = block_number(gallivm, params->x, params->y);
   load_block(tile, needed);
}


LLVMValueRef
lp_build_tile_words(const struct lp_build_tile *tile, LLVMValueRef group,
                    LLVMValueRef block_size)
{
   struct gallivm_state *gallivm = tile->gallivm;
   LLVMBuilderRef builder = gallivm->builder;
   LLVMTypeRef int64_type = LLVMInt64TypeInContext(gallivm->context);
   LLVMValueRef words =
      lp_build_load_ptr_at(gallivm, tile->store,
                           offsetof(struct lp_tile_store, data));

   /* Offsets need more than 32 bits with many layers. */
   words = lp_build_byte_offset(gallivm, words,
                                LLVMBuildMul(builder,
                                             LLVMBuildZExt(builder, tile->block,
                                                           int64_type, ""),
                                             LLVMBuildZExt(builder, block_size,
                                                           int64_type, ""), ""));
   return lp_build_byte_offset(gallivm, words,
                               LLVMBuildMul(builder, group,
                                            lp_build_const_int32(gallivm,
                                                                 tile->bld.type.length * 4),
                                            ""));
}


LLVMValueRef
lp_build_tile_load(const struct lp_build_tile *tile, LLVMValueRef ptr,
                   int offset)
{
   LLVMValueRef value =
      LLVMBuildLoad2(tile->gallivm->builder, tile->bld.vec_type,
                     lp_build_const_offset(tile->gallivm, ptr, offset), "");

   LLVMSetAlignment(value, tile->bld.type.length * 4);
   return value;
}


void
lp_build_tile_store(const struct lp_build_tile *tile, LLVMValueRef value,
                    LLVMValueRef ptr, int offset)
{
   LLVMValueRef instr =
      LLVMBuildStore(tile->gallivm->builder, value,
                     lp_build_const_offset(tile->gallivm, ptr, offset));

   LLVMSetAlignment(instr, tile->bld.type.length * 4);
}


LLVMValueRef
lp_build_merge_bits(const struct lp_build_context *bld, LLVMValueRef mask,
                    uint32_t bits, LLVMValueRef new_word,
                    LLVMValueRef old_word)
{
   LLVMBuilderRef builder = bld->gallivm->builder;

   if (!bits)
      return old_word;

   if (!~bits) {
      /* The sign, because that is what a blend instruction looks at. */
      mask = LLVMBuildICmp(builder, LLVMIntSLT, mask,
                           LLVMConstNull(LLVMTypeOf(mask)), "");
      return LLVMBuildSelect(builder, mask, new_word, old_word, "");
   }

   /* Lanes by bits, too: LLVM 19 gets a select between the old value and bits
    * of it wrong with AVX-512 (a masked vpternlog).
    */
   LLVMValueRef changed =
      LLVMBuildAnd(builder, mask,
                   lp_build_const_int_vec(bld->gallivm, bld->type, bits), "");
   LLVMValueRef word = LLVMBuildXor(builder, old_word, new_word, "");
   word = LLVMBuildAnd(builder, word, changed, "");
   return LLVMBuildXor(builder, word, old_word, "");
}
