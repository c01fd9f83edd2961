/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_bld_peel_context.h"

#include "gallivm/lp_bld_flow.h"


/** Store new words of a layer in the lanes of active; the others keep theirs. */
static void
store_layer(struct peel_context *ctx, LLVMValueRef ptr, LLVMValueRef active,
            const LLVMValueRef *words, const LLVMValueRef *old)
{
   for (unsigned w = 0; w < ctx->num_words; w++) {
      LLVMValueRef value;

      if (!ctx->bits[w])
         continue;
      if (!~ctx->bits[w]) {
         value = select_lanes(ctx, active, words[w], old[w]);
      } else {
         /* See store_words() in lp_bld_kbuf_format.c. */
         LLVMValueRef changed =
            and(ctx, active, lp_build_const_int_vec(ctx->gallivm, ctx->type,
                                                    ctx->bits[w]));
         value = LLVMBuildXor(ctx->builder, old[w], words[w], "");
         value = LLVMBuildXor(ctx->builder, and(ctx, value, changed), old[w], "");
      }
      store_vec(ctx, value, ptr, w * LP_PEEL_WORD_SIZE);
   }
}


static void
load_layer(struct peel_context *ctx, LLVMValueRef ptr, LLVMValueRef *words)
{
   for (unsigned w = 0; w < ctx->num_words; w++)
      words[w] = load_vec(ctx, ptr, w * LP_PEEL_WORD_SIZE);
}


/**
 * From the last layer to the front, move layers back by one where the
 * fragment goes before them.
 *
 * Neighboring pixels mostly agree on the place, so that several layers at
 * once can be compared by the foremost of them, and moved in all active lanes.
 */
void
lp_build_peel_insert(struct peel_context *ctx, LLVMValueRef first_active,
                     LLVMValueRef *last)
{
   enum { STEP = 4 };
   struct gallivm_state *gallivm = ctx->gallivm;
   LLVMBuilderRef builder = ctx->builder;
   const int layer_size = ctx->num_words * LP_PEEL_WORD_SIZE;
   LLVMTypeRef ptr_type = LLVMTypeOf(ctx->layers);
   LLVMValueRef old[MAX_WORDS], front[MAX_WORDS], words[MAX_WORDS];

   LLVMBasicBlockRef start = LLVMGetInsertBlock(builder);
   LLVMBasicBlockRef loop = lp_build_insert_new_block(gallivm, "peel_loop");
   LLVMBasicBlockRef try_step = lp_build_insert_new_block(gallivm, "peel_try");
   LLVMBasicBlockRef step = lp_build_insert_new_block(gallivm, "peel_step");
   LLVMBasicBlockRef one = lp_build_insert_new_block(gallivm, "peel_one");
   LLVMBasicBlockRef move = lp_build_insert_new_block(gallivm, "peel_move");
   LLVMBasicBlockRef first = lp_build_insert_new_block(gallivm, "peel_first");
   LLVMBasicBlockRef end = lp_build_insert_new_block(gallivm, "peel_end");
   LLVMValueRef step_end = const_offset(ctx, ctx->layers, STEP * layer_size);

   LLVMBuildBr(builder, loop);

   LLVMPositionBuilderAtEnd(builder, loop);
   LLVMValueRef ptr = LLVMBuildPhi(builder, ptr_type, "");
   LLVMValueRef active = LLVMBuildPhi(builder, ctx->vec_type, "");
   LLVMAddIncoming(ptr, &ctx->last_ptr, &start, 1);
   LLVMAddIncoming(active, &first_active, &start, 1);
   for (unsigned w = 0; w < ctx->num_words; w++) {
      old[w] = LLVMBuildPhi(builder, ctx->vec_type, "");
      LLVMAddIncoming(old[w], &last[w], &start, 1);
   }
   LLVMBuildCondBr(builder,
                   LLVMBuildICmp(builder, LLVMIntUGE, ptr, step_end, ""),
                   try_step, one);

   LLVMPositionBuilderAtEnd(builder, try_step);
   LLVMValueRef foremost =
      load_vec(ctx, const_offset(ctx, ptr, -STEP * layer_size), 0);
   LLVMValueRef stops =
      and_not(ctx, active, passes(ctx, ctx->fragment[0], foremost));
   LLVMBuildCondBr(builder, any(ctx, stops), one, step);

   LLVMPositionBuilderAtEnd(builder, step);
   memcpy(words, old, sizeof words);
   LLVMValueRef step_ptr = ptr;
   for (unsigned i = 0; i < STEP; i++) {
      LLVMValueRef front_ptr = const_offset(ctx, step_ptr, -layer_size);

      load_layer(ctx, front_ptr, front);
      store_layer(ctx, step_ptr, active, front, words);
      memcpy(words, front, sizeof words);
      step_ptr = front_ptr;
   }
   LLVMAddIncoming(ptr, &step_ptr, &step, 1);
   LLVMAddIncoming(active, &active, &step, 1);
   for (unsigned w = 0; w < ctx->num_words; w++)
      LLVMAddIncoming(old[w], &words[w], &step, 1);
   LLVMBuildBr(builder, loop);

   LLVMPositionBuilderAtEnd(builder, one);
   LLVMBuildCondBr(builder,
                   LLVMBuildICmp(builder, LLVMIntEQ, ptr, ctx->layers, ""),
                   first, move);

   LLVMPositionBuilderAtEnd(builder, move);
   LLVMValueRef front_ptr = const_offset(ctx, ptr, -layer_size);
   load_layer(ctx, front_ptr, front);
   LLVMValueRef moved =
      and(ctx, active, passes(ctx, ctx->fragment[0], front[0]));
   for (unsigned w = 0; w < ctx->num_words; w++)
      words[w] = select_lanes(ctx, moved, front[w], ctx->fragment[w]);
   store_layer(ctx, ptr, active, words, old);
   LLVMAddIncoming(ptr, &front_ptr, &move, 1);
   LLVMAddIncoming(active, &moved, &move, 1);
   for (unsigned w = 0; w < ctx->num_words; w++)
      LLVMAddIncoming(old[w], &front[w], &move, 1);
   LLVMBuildCondBr(builder, any(ctx, moved), loop, end);

   LLVMPositionBuilderAtEnd(builder, first);
   store_layer(ctx, ptr, active, ctx->fragment, old);
   LLVMBuildBr(builder, end);

   LLVMPositionBuilderAtEnd(builder, end);
}
