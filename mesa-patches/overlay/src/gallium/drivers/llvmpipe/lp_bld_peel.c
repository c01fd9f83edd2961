/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_bld_peel_context.h"

#include "util/format/u_format.h"
#include "gallivm/lp_bld_arit.h"
#include "gallivm/lp_bld_const.h"
#include "gallivm/lp_bld_conv.h"
#include "gallivm/lp_bld_flow.h"
#include "gallivm/lp_bld_init.h"
#include "gallivm/lp_bld_logic.h"
#include "gallivm/lp_bld_swizzle.h"

#include "lp_bld_kbuf_format.h"


LLVMValueRef
lp_build_peel_depth(struct gallivm_state *gallivm,
                    const struct lp_fragment_shader_variant_key *key,
                    struct lp_type type, LLVMValueRef z)
{
   LLVMBuilderRef builder = gallivm->builder;
   const struct lp_type int_type = lp_int_type(type);
   LLVMTypeRef vec_type = lp_build_vec_type(gallivm, int_type);
   struct lp_peel_depth_format format;

   lp_peel_depth_format_init(&format, key->zsbuf_format,
                             key->kbuf.peel.reversed);

   /* The same conversion as in lp_build_depth_stencil_test(). */
   if (!format.floating) {
      if (key->restrict_depth_values) {
         type.sign = false;
         type.norm = true;
      }
      z = lp_build_clamped_float_to_unsigned_norm(gallivm, type,
                                                  format.width, z);
      if (format.width == 32) {
         z = LLVMBuildXor(builder, z,
                          lp_build_const_int_vec(gallivm, int_type, 0x80000000),
                          "");
      }
   } else {
      z = LLVMBuildBitCast(builder, z, vec_type, "");

      /* Zeros are equal. */
      LLVMValueRef negative_zero =
         LLVMBuildICmp(builder, LLVMIntEQ, z,
                       lp_build_const_int_vec(gallivm, int_type, 0x80000000), "");
      z = LLVMBuildSelect(builder, negative_zero, LLVMConstNull(vec_type), z, "");

      LLVMValueRef flip =
         LLVMBuildAShr(builder, z,
                       lp_build_const_int_vec(gallivm, int_type, 31), "");
      flip = LLVMBuildAnd(builder, flip,
                          lp_build_const_int_vec(gallivm, int_type, 0x7fffffff),
                          "");
      z = LLVMBuildXor(builder, z, flip, "");
   }
   return format.reversed ? LLVMBuildNot(builder, z, "") : z;
}


/** Which words a pixel has, and which bits of them move. */
static void
init_words(struct peel_context *ctx)
{
   const struct lp_fragment_shader_variant_key *key = ctx->params->key;

   ctx->num_words = 1;
   ctx->bits[0] = ~0u;
   for (unsigned i = 0; i < key->nr_cbufs; i++) {
      const struct util_format_description *desc =
         util_format_description(key->cbuf_format[i]);
      const unsigned colormask = key->blend.rt[i].colormask;
      uint32_t *bits = &ctx->bits[ctx->num_words];

      if (key->cbuf_format[i] == PIPE_FORMAT_NONE)
         continue;

      /* Padding moves with all components, for speed. */
      const unsigned num_words = DIV_ROUND_UP(desc->block.bits, 32);
      if (util_format_colormask_full(desc, colormask))
         memset(bits, 0xff, num_words * sizeof *bits);
      else
         lp_kbuf_format_bits(desc, colormask, bits);
      ctx->num_words += num_words;
   }
}


/** A number for each sample of blocks, in the order in which they lie. */
static LLVMValueRef
sample_index(struct peel_context *ctx, LLVMValueRef block)
{
   struct gallivm_state *gallivm = ctx->gallivm;
   LLVMBuilderRef builder = gallivm->builder;
   const unsigned num_samples = ctx->params->key->zsbuf_nr_samples;

   if (num_samples <= 1)
      return block;

   block = LLVMBuildMul(builder, block,
                        lp_build_const_int32(gallivm, num_samples), "");
   return LLVMBuildAdd(builder, block, ctx->params->sample, "");
}


/** Find the layers of the group. */
static void
locate_layers(struct peel_context *ctx)
{
   struct gallivm_state *gallivm = ctx->gallivm;
   LLVMBuilderRef builder = gallivm->builder;
   const struct lp_build_kbuf_params *params = ctx->params;
   LLVMValueRef store = ctx->tile.store;

   ctx->layers =
      lp_build_tile_words(&ctx->tile, params->group,
                          lp_build_load_int32_at(gallivm, store,
                                                 offsetof(struct lp_tile_store,
                                                          block_size)));
   if (params->key->zsbuf_nr_samples > 1) {
      LLVMValueRef sample_size =
         lp_build_load_int32_at(gallivm, store,
                                offsetof(struct lp_tile_store, sample_size));

      ctx->layers =
         lp_build_byte_offset(gallivm, ctx->layers,
                              LLVMBuildMul(builder, params->sample, sample_size,
                                           ""));
   }
}


/** Find the last layer of the group that is there. */
static void
locate_last_layer(struct peel_context *ctx)
{
   struct gallivm_state *gallivm = ctx->gallivm;
   LLVMBuilderRef builder = gallivm->builder;
   LLVMValueRef counts =
      lp_build_load_ptr_at(gallivm, ctx->tile.store,
                           offsetof(struct lp_tile_store, counts));
   LLVMValueRef index = sample_index(ctx, ctx->tile.block);

   index = LLVMBuildMul(builder, index,
                        lp_build_const_int32(gallivm, LP_TILE_GROUPS), "");
   index = LLVMBuildAdd(builder, index, ctx->params->group, "");
   index = LLVMBuildMul(builder, index, lp_build_const_int32(gallivm, 4), "");
   ctx->count_ptr = lp_build_byte_offset(gallivm, counts, index);
   ctx->last = lp_build_load_int32_at(gallivm, ctx->count_ptr, 0);

   LLVMValueRef layer_size =
      lp_build_const_int32(gallivm, ctx->num_words * LP_TILE_WORD_SIZE);
   ctx->last_ptr =
      lp_build_byte_offset(gallivm, ctx->layers,
                           LLVMBuildMul(builder, ctx->last, layer_size, ""));
}


/** Find the group in the tile store. */
static void
peel_begin(struct peel_context *ctx, struct gallivm_state *gallivm,
           const struct lp_build_kbuf_params *params,
           enum lp_tile_valid needed)
{
   memset(ctx, 0, sizeof *ctx);
   ctx->gallivm = gallivm;
   ctx->params = params;
   ctx->key = &params->key->kbuf.peel;
   init_words(ctx);
   lp_build_tile_begin(&ctx->tile, gallivm, params, needed);
   locate_layers(ctx);
   locate_last_layer(ctx);
   ctx->empty =
      lp_build_broadcast_scalar(&ctx->tile.bld,
                                lp_build_load_int32_at(gallivm, ctx->tile.store,
                                                       offsetof(struct lp_tile_store,
                                                                empty)));
}


/** Fragments of these lanes fall behind the last layer, or fell out of it. */
static void
note_overflow(struct peel_context *ctx, LLVMValueRef mask)
{
   struct gallivm_state *gallivm = ctx->gallivm;
   struct lp_build_if_state overflow;

   lp_build_if(&overflow, gallivm, any_lane(ctx, mask));
   LLVMBuildStore(gallivm->builder, lp_build_const_int32(gallivm, 1),
                  lp_build_const_offset(gallivm, ctx->tile.store,
                                        offsetof(struct lp_tile_store, overflow)));
   lp_build_endif(&overflow);
}


/** The group in the lp_peel_bound of its block and sample. */
static LLVMValueRef
bound_ptr(struct peel_context *ctx)
{
   struct gallivm_state *gallivm = ctx->gallivm;
   LLVMBuilderRef builder = gallivm->builder;
   LLVMTypeRef int64_type = LLVMInt64TypeInContext(gallivm->context);
   LLVMValueRef store = ctx->tile.store;

   LLVMValueRef x = LLVMBuildAnd(builder, ctx->tile.block,
                                 lp_build_const_int32(gallivm, 0xf), "");
   LLVMValueRef y = LLVMBuildLShr(builder, ctx->tile.block,
                                  lp_build_const_int32(gallivm, 4), "");
   LLVMValueRef blocks_x =
      lp_build_load_int32_at(gallivm, store,
                             offsetof(struct lp_tile_store, bound_blocks_x));
   LLVMValueRef index =
      LLVMBuildAdd(builder, LLVMBuildMul(builder, y, blocks_x, ""), x, "");

   index = LLVMBuildZExt(builder, sample_index(ctx, index), int64_type, "");
   index = LLVMBuildMul(builder, index,
                        LLVMConstInt(int64_type, sizeof(struct lp_peel_bound), 0),
                        "");

   LLVMValueRef ptr =
      lp_build_byte_offset(gallivm,
                           lp_build_load_ptr_at(gallivm, store,
                                                offsetof(struct lp_tile_store,
                                                         bounds)), index);
   return lp_build_byte_offset(gallivm, ptr,
                               LLVMBuildMul(builder, ctx->params->group,
                                            lp_build_const_int32(gallivm,
                                                                 ctx->tile.bld.type.length * 4),
                                            ""));
}


LLVMValueRef
lp_build_peel_cull(struct gallivm_state *gallivm,
                   const struct lp_build_kbuf_params *params)
{
   LLVMValueRef depth = params->pos[2];
   struct peel_context ctx;

   peel_begin(&ctx, gallivm, params, LP_TILE_LAST);

   struct lp_build_context *bld = &ctx.tile.bld;
   LLVMValueRef last = lp_build_tile_load(&ctx.tile, ctx.last_ptr, 0);
   LLVMValueRef taken = is_nearer(&ctx, depth, last);
   LLVMValueRef mask =
      lp_build_and(bld, params->mask,
                   lp_build_cmp(bld, PIPE_FUNC_LESS, depth, ctx.empty));

   if (ctx.key->bounded) {
      LLVMValueRef bound =
         lp_build_tile_load(&ctx.tile, bound_ptr(&ctx),
                            offsetof(struct lp_peel_bound, depth));

      mask = lp_build_andnot(bld, mask,
                             lp_build_cmp(bld, PIPE_FUNC_LESS, depth, bound));
      /* Each fragment at this depth has to be counted. */
      taken = lp_build_or(bld, taken,
                          lp_build_and(bld, mask,
                                       lp_build_cmp(bld, PIPE_FUNC_EQUAL, depth,
                                                    bound)));
   }
   note_overflow(&ctx, lp_build_andnot(bld, mask, taken));
   return lp_build_and(bld, mask, taken);
}


/**
 * The lanes of which the fragment is nearer than an empty layer, and behind
 * the bound.  Counts those that arrive at it.
 */
static LLVMValueRef
within_bounds(struct peel_context *ctx, LLVMValueRef depth)
{
   struct lp_build_context *bld = &ctx->tile.bld;
   LLVMValueRef mask =
      lp_build_and(bld, ctx->params->mask,
                   lp_build_cmp(bld, PIPE_FUNC_LESS, depth, ctx->empty));

   if (!ctx->key->bounded)
      return mask;

   LLVMValueRef ptr = bound_ptr(ctx);
   LLVMValueRef bound =
      lp_build_tile_load(&ctx->tile, ptr, offsetof(struct lp_peel_bound, depth));
   LLVMValueRef kept =
      lp_build_tile_load(&ctx->tile, ptr, offsetof(struct lp_peel_bound, kept));
   LLVMValueRef seen =
      lp_build_tile_load(&ctx->tile, ptr, offsetof(struct lp_peel_bound, seen));

   LLVMValueRef arrived =
      lp_build_and(bld, mask, lp_build_cmp(bld, PIPE_FUNC_EQUAL, depth, bound));
   LLVMValueRef is_new =
      lp_build_andnot(bld, arrived, lp_build_cmp(bld, PIPE_FUNC_LESS, seen, kept));
   LLVMValueRef behind =
      lp_build_and(bld, mask, lp_build_cmp(bld, PIPE_FUNC_LESS, bound, depth));

   /* The mask is -1. */
   lp_build_tile_store(&ctx->tile,
                       LLVMBuildSub(ctx->gallivm->builder, seen, arrived, ""),
                       ptr, offsetof(struct lp_peel_bound, seen));
   return lp_build_or(bld, behind, is_new);
}


/** The words of the fragment, as the buffers store them. */
static void
encode_fragment(struct peel_context *ctx, LLVMValueRef depth)
{
   const struct lp_build_kbuf_params *params = ctx->params;
   const struct lp_fragment_shader_variant_key *key = params->key;
   LLVMValueRef fpstate = lp_build_kbuf_begin_denormals(ctx->gallivm, key);

   ctx->fragment[0] = depth;
   for (unsigned i = 0, w = 1; i < key->nr_cbufs; i++) {
      const struct util_format_description *desc =
         util_format_description(key->cbuf_format[i]);
      const struct lp_kbuf_pixels pixels = {
         .gallivm = ctx->gallivm,
         .type = params->type,
         .desc = desc,
      };

      if (key->cbuf_format[i] != PIPE_FORMAT_NONE) {
         lp_build_kbuf_encode(&pixels, 0xf, params->colors[i],
                              &ctx->fragment[w]);
         w += DIV_ROUND_UP(desc->block.bits, 32);
      }
   }
   if (fpstate)
      lp_build_fpstate_set(ctx->gallivm, fpstate);
}


/** If there is room behind the last layer that is there, repeat it there. */
static void
append_layer(struct peel_context *ctx, LLVMValueRef *last)
{
   struct gallivm_state *gallivm = ctx->gallivm;
   LLVMBuilderRef builder = gallivm->builder;
   const int layer_size = ctx->num_words * LP_TILE_WORD_SIZE;
   LLVMValueRef last_layer =
      lp_build_load_int32_at(gallivm, ctx->tile.store,
                             offsetof(struct lp_tile_store, last_layer));
   struct lp_build_if_state not_full;

   lp_build_if(&not_full, gallivm,
               LLVMBuildICmp(builder, LLVMIntULT, ctx->last, last_layer, ""));
   {
      LLVMValueRef count =
         LLVMBuildAdd(builder, ctx->last, lp_build_const_int32(gallivm, 1), "");

      LLVMBuildStore(builder, count, ctx->count_ptr);
      for (unsigned w = 0; w < ctx->num_words; w++) {
         lp_build_tile_store(&ctx->tile, last[w], ctx->last_ptr,
                             layer_size + w * LP_TILE_WORD_SIZE);
      }
   }
   lp_build_endif(&not_full);
}


static void
mark_changed(struct peel_context *ctx)
{
   struct gallivm_state *gallivm = ctx->gallivm;
   LLVMTypeRef int8_type = LLVMInt8TypeInContext(gallivm->context);
   LLVMValueRef changed =
      lp_build_const_offset(gallivm, ctx->tile.store,
                            offsetof(struct lp_tile_store, changed));

   LLVMBuildStore(gallivm->builder,
                  LLVMConstInt(int8_type, LP_TILE_CHANGED | LP_TILE_UNKNOWN, 0),
                  lp_build_byte_offset(gallivm, changed, ctx->tile.block));
}


LLVMValueRef
lp_build_peel_stage(struct gallivm_state *gallivm,
                    const struct lp_build_kbuf_params *params)
{
   LLVMBuilderRef builder = gallivm->builder;
   LLVMTypeRef mask_type = LLVMTypeOf(params->mask);
   LLVMValueRef result = lp_build_alloca(gallivm, mask_type, "peel_inserted");
   struct lp_build_if_state alive, inserted;
   struct lp_build_context bld;
   struct peel_context ctx;
   LLVMValueRef last[MAX_WORDS];

   LLVMBuildStore(builder, LLVMConstNull(mask_type), result);
   lp_build_context_init(&bld, gallivm, lp_int_type(params->type));
   lp_build_if(&alive, gallivm,
               lp_build_any_true_range(&bld, bld.type.length, params->mask));
   peel_begin(&ctx, gallivm, params, LP_TILE_ALL);
   last[0] = lp_build_tile_load(&ctx.tile, ctx.last_ptr, 0);

   LLVMValueRef depth = params->pos[2];
   LLVMValueRef mask = within_bounds(&ctx, depth);
   LLVMValueRef active =
      lp_build_and(&bld, mask, is_nearer(&ctx, depth, last[0]));

   /* Either the fragment falls out, or what is in the last layer. */
   note_overflow(&ctx,
                 lp_build_and(&bld, mask,
                              lp_build_cmp(&bld, PIPE_FUNC_LESS, last[0],
                                           ctx.empty)));
   LLVMBuildStore(builder, active, result);

   lp_build_if(&inserted, gallivm, any_lane(&ctx, active));
   {
      for (unsigned w = 1; w < ctx.num_words; w++) {
         last[w] = lp_build_tile_load(&ctx.tile, ctx.last_ptr,
                                      w * LP_TILE_WORD_SIZE);
      }
      encode_fragment(&ctx, depth);
      append_layer(&ctx, last);
      mark_changed(&ctx);
      lp_build_peel_insert(&ctx, active, last);
   }
   lp_build_endif(&inserted);
   lp_build_endif(&alive);

   return LLVMBuildLoad2(builder, mask_type, result, "");
}
