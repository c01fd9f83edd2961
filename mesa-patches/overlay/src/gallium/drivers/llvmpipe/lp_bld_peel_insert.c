/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_bld_peel_context.h"

#include "gallivm/lp_bld_flow.h"

/** Layers that are moved at once where all lanes agree. */
#define STEP 4


/** The loop from the last layer to the front. */
struct insert_loop
{
   LLVMBasicBlockRef head;
   LLVMValueRef ptr;              /**< to the layer that is looked at */
   LLVMValueRef active;           /**< lanes in which the fragment goes before it */
   LLVMValueRef words[MAX_WORDS]; /**< of that layer */
};


/** Store new words of a layer in the lanes of active; the others keep theirs. */
static void
store_layer(struct peel_context *ctx, LLVMValueRef ptr, LLVMValueRef active,
            const LLVMValueRef *words, const LLVMValueRef *old)
{
   for (unsigned w = 0; w < ctx->num_words; w++) {
      if (ctx->bits[w]) {
         lp_build_tile_store(&ctx->tile,
                             lp_build_merge_bits(&ctx->tile.bld, active,
                                                 ctx->bits[w], words[w], old[w]),
                             ptr, w * LP_TILE_WORD_SIZE);
      }
   }
}


static void
load_layer(struct peel_context *ctx, LLVMValueRef ptr, LLVMValueRef *words)
{
   for (unsigned w = 0; w < ctx->num_words; w++)
      words[w] = lp_build_tile_load(&ctx->tile, ptr, w * LP_TILE_WORD_SIZE);
}


static int
layer_size(const struct peel_context *ctx)
{
   return ctx->num_words * LP_TILE_WORD_SIZE;
}


/** What the loop has when it comes to its head from the current block. */
static void
add_incoming(struct peel_context *ctx, struct insert_loop *loop,
             LLVMValueRef ptr, LLVMValueRef active, LLVMValueRef *words)
{
   LLVMBasicBlockRef block = LLVMGetInsertBlock(ctx->gallivm->builder);

   LLVMAddIncoming(loop->ptr, &ptr, &block, 1);
   LLVMAddIncoming(loop->active, &active, &block, 1);
   for (unsigned w = 0; w < ctx->num_words; w++)
      LLVMAddIncoming(loop->words[w], &words[w], &block, 1);
}


static void
begin_loop(struct peel_context *ctx, struct insert_loop *loop,
           LLVMValueRef active, LLVMValueRef *last)
{
   LLVMBuilderRef builder = ctx->gallivm->builder;
   LLVMTypeRef vec_type = ctx->tile.bld.vec_type;
   LLVMBasicBlockRef start = LLVMGetInsertBlock(builder);

   loop->head = lp_build_insert_new_block(ctx->gallivm, "peel_loop");
   LLVMPositionBuilderAtEnd(builder, loop->head);
   loop->ptr = LLVMBuildPhi(builder, LLVMTypeOf(ctx->layers), "");
   loop->active = LLVMBuildPhi(builder, vec_type, "");
   for (unsigned w = 0; w < ctx->num_words; w++)
      loop->words[w] = LLVMBuildPhi(builder, vec_type, "");

   LLVMPositionBuilderAtEnd(builder, start);
   add_incoming(ctx, loop, ctx->last_ptr, active, last);
   LLVMBuildBr(builder, loop->head);
   LLVMPositionBuilderAtEnd(builder, loop->head);
}


/**
 * Move several layers at once, if the fragment goes before all of them in all
 * lanes that are active; else go on at the block `one`.
 */
static void
build_step(struct peel_context *ctx, struct insert_loop *loop,
           LLVMBasicBlockRef one)
{
   struct gallivm_state *gallivm = ctx->gallivm;
   LLVMBuilderRef builder = gallivm->builder;
   LLVMBasicBlockRef try_step = lp_build_insert_new_block(gallivm, "peel_try");
   LLVMBasicBlockRef step = lp_build_insert_new_block(gallivm, "peel_step");
   LLVMValueRef step_end =
      lp_build_const_offset(gallivm, ctx->layers, STEP * layer_size(ctx));

   LLVMBuildCondBr(builder,
                   LLVMBuildICmp(builder, LLVMIntUGE, loop->ptr, step_end, ""),
                   try_step, one);

   LLVMPositionBuilderAtEnd(builder, try_step);
   LLVMValueRef foremost = lp_build_tile_load(&ctx->tile, loop->ptr,
                                              -STEP * layer_size(ctx));
   LLVMValueRef stops =
      lp_build_andnot(&ctx->tile.bld, loop->active,
                      is_nearer(ctx, ctx->fragment[0], foremost));
   LLVMBuildCondBr(builder, any_lane(ctx, stops), one, step);

   LLVMPositionBuilderAtEnd(builder, step);
   LLVMValueRef ptr = loop->ptr;
   LLVMValueRef words[MAX_WORDS], front[MAX_WORDS];
   memcpy(words, loop->words, sizeof words);
   for (unsigned i = 0; i < STEP; i++) {
      LLVMValueRef front_ptr =
         lp_build_const_offset(gallivm, ptr, -layer_size(ctx));

      load_layer(ctx, front_ptr, front);
      store_layer(ctx, ptr, loop->active, front, words);
      memcpy(words, front, sizeof words);
      ptr = front_ptr;
   }
   add_incoming(ctx, loop, ptr, loop->active, words);
   LLVMBuildBr(builder, loop->head);
}


/**
 * Move one layer in the lanes where the fragment goes before it; in the other
 * active ones this is the fragment's place.
 */
static void
build_move(struct peel_context *ctx, struct insert_loop *loop,
           LLVMBasicBlockRef end)
{
   LLVMBuilderRef builder = ctx->gallivm->builder;
   LLVMValueRef words[MAX_WORDS], front[MAX_WORDS];
   LLVMValueRef front_ptr =
      lp_build_const_offset(ctx->gallivm, loop->ptr, -layer_size(ctx));

   load_layer(ctx, front_ptr, front);
   LLVMValueRef moved =
      lp_build_and(&ctx->tile.bld, loop->active,
                   is_nearer(ctx, ctx->fragment[0], front[0]));
   for (unsigned w = 0; w < ctx->num_words; w++) {
      words[w] = lp_build_merge_bits(&ctx->tile.bld, moved, ~0u, front[w],
                                     ctx->fragment[w]);
   }
   store_layer(ctx, loop->ptr, loop->active, words, loop->words);
   add_incoming(ctx, loop, front_ptr, moved, front);
   LLVMBuildCondBr(builder, any_lane(ctx, moved), loop->head, end);
}


/**
 * From the last layer to the front, move layers back by one where the
 * fragment goes before them.
 *
 * Neighboring pixels mostly agree on the place, so that several layers at
 * once can be compared by the foremost of them, and moved in all active lanes.
 */
void
lp_build_peel_insert(struct peel_context *ctx, LLVMValueRef active,
                     LLVMValueRef *last)
{
   struct gallivm_state *gallivm = ctx->gallivm;
   LLVMBuilderRef builder = gallivm->builder;
   struct insert_loop loop;

   begin_loop(ctx, &loop, active, last);
   LLVMBasicBlockRef one = lp_build_insert_new_block(gallivm, "peel_one");
   LLVMBasicBlockRef move = lp_build_insert_new_block(gallivm, "peel_move");
   LLVMBasicBlockRef first = lp_build_insert_new_block(gallivm, "peel_first");
   LLVMBasicBlockRef end = lp_build_insert_new_block(gallivm, "peel_end");

   build_step(ctx, &loop, one);

   LLVMPositionBuilderAtEnd(builder, one);
   LLVMBuildCondBr(builder,
                   LLVMBuildICmp(builder, LLVMIntEQ, loop.ptr, ctx->layers, ""),
                   first, move);

   LLVMPositionBuilderAtEnd(builder, move);
   build_move(ctx, &loop, end);

   LLVMPositionBuilderAtEnd(builder, first);
   store_layer(ctx, loop.ptr, loop.active, ctx->fragment, loop.words);
   LLVMBuildBr(builder, end);

   LLVMPositionBuilderAtEnd(builder, end);
}
