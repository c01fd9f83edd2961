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
#include "gallivm/lp_bld_struct.h"

#include "lp_bld_kbuf_format.h"
#include "lp_jit.h"


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


/**
 * Have the block loaded if no fragment has come to it before.
 *
 * \param func  offset in lp_peel_tile
 */
static void
load_block(struct peel_context *ctx, enum lp_peel_valid needed, size_t func)
{
   struct gallivm_state *gallivm = ctx->gallivm;
   LLVMTypeRef int8_type = LLVMInt8TypeInContext(gallivm->context);
   LLVMTypeRef arg_types[2] = {
      LLVMPointerType(int8_type, 0), LLVMInt32TypeInContext(gallivm->context)
   };
   LLVMTypeRef func_type =
      LLVMFunctionType(LLVMVoidTypeInContext(gallivm->context), arg_types, 2, 0);
   struct lp_build_if_state invalid;

   LLVMValueRef valid =
      const_offset(ctx, ctx->tile, offsetof(struct lp_peel_tile, valid));
   valid = LLVMBuildLoad2(ctx->builder, int8_type,
                          byte_offset(ctx, valid, ctx->block), "valid");
   lp_build_if(&invalid, gallivm,
               LLVMBuildICmp(ctx->builder, LLVMIntULT, valid,
                             LLVMConstInt(int8_type, needed, 0), ""));
   {
      LLVMValueRef args[2] = { ctx->tile, ctx->block };

      LLVMBuildCall2(ctx->builder, func_type, load_ptr(ctx, ctx->tile, func),
                     args, 2, "");
   }
   lp_build_endif(&invalid);
}


/** Which words a pixel has, and which bits of them move. */
static void
init_words(struct peel_context *ctx)
{
   const struct lp_fragment_shader_variant_key *key = ctx->params->key;

   ctx->num_words = 1;
   ctx->bits[0] = ~0u;
   for (unsigned i = 0; i < key->nr_cbufs; i++) {
      const unsigned num_words = lp_peel_color_words(key->cbuf_format[i]);

      if (num_words) {
         const struct util_format_description *desc =
            util_format_description(key->cbuf_format[i]);
         const unsigned colormask = key->blend.rt[i].colormask;
         uint32_t *bits = &ctx->bits[ctx->num_words];

         /* Padding moves with all components, for speed. */
         if (util_format_colormask_full(desc, colormask))
            memset(bits, 0xff, num_words * sizeof *bits);
         else
            lp_kbuf_format_bits(desc, colormask, bits);
         ctx->num_words += num_words;
      }
   }
}


/** Find the group's pixels in the thread's tile. */
static void
peel_begin(struct peel_context *ctx, struct gallivm_state *gallivm,
           const struct lp_build_kbuf_params *params,
           enum lp_peel_valid needed)
{
   LLVMBuilderRef builder = gallivm->builder;

   memset(ctx, 0, sizeof *ctx);
   ctx->gallivm = gallivm;
   ctx->builder = builder;
   ctx->params = params;
   ctx->key = &params->key->kbuf.peel;
   ctx->type = lp_int_type(params->type);
   ctx->vec_type = lp_build_vec_type(gallivm, ctx->type);
   init_words(ctx);

   ctx->tile = load_ptr(ctx, params->thread_data_ptr,
                        offsetof(struct lp_jit_thread_data, peel_tile));

   /* block = y / 4 % 16 * 16 + x / 4 % 16 */
   LLVMValueRef y = LLVMBuildShl(builder, params->y,
                                 lp_build_const_int32(gallivm, 2), "");
   LLVMValueRef x = LLVMBuildLShr(builder, params->x,
                                  lp_build_const_int32(gallivm, 2), "");
   y = LLVMBuildAnd(builder, y, lp_build_const_int32(gallivm, 0xf0), "");
   x = LLVMBuildAnd(builder, x, lp_build_const_int32(gallivm, 0xf), "");
   STATIC_ASSERT(TILE_SIZE == 64);
   ctx->block = LLVMBuildOr(builder, y, x, "block");

   load_block(ctx, needed,
              needed == LP_PEEL_LAST ? offsetof(struct lp_peel_tile, load_last) :
                                       offsetof(struct lp_peel_tile, load_block));

   /* Offsets need more than 32 bits with many layers. */
   LLVMTypeRef int64_type = LLVMInt64TypeInContext(gallivm->context);
   LLVMValueRef offset =
      LLVMBuildMul(builder,
                   LLVMBuildZExt(builder, ctx->block, int64_type, ""),
                   LLVMBuildZExt(builder,
                                 load_int32(ctx, ctx->tile,
                                            offsetof(struct lp_peel_tile, block_size)),
                                 int64_type, ""), "");
   ctx->layers = byte_offset(ctx, load_ptr(ctx, ctx->tile,
                                           offsetof(struct lp_peel_tile, data)),
                             offset);

   LLVMValueRef index = ctx->block;
   const unsigned num_samples = MAX2(params->key->zsbuf_nr_samples, 1);
   if (num_samples > 1) {
      LLVMValueRef sample_size =
         load_int32(ctx, ctx->tile, offsetof(struct lp_peel_tile, sample_size));

      ctx->layers = byte_offset(ctx, ctx->layers,
                                LLVMBuildMul(builder, params->sample,
                                             sample_size, ""));
      index = LLVMBuildMul(builder, index,
                           lp_build_const_int32(gallivm, num_samples), "");
      index = LLVMBuildAdd(builder, index, params->sample, "");
   }

   offset = LLVMBuildMul(builder, params->group,
                         lp_build_const_int32(gallivm, ctx->type.length * 4), "");
   ctx->layers = byte_offset(ctx, ctx->layers, offset);

   index = LLVMBuildMul(builder, index,
                        lp_build_const_int32(gallivm, LP_PEEL_GROUPS), "");
   index = LLVMBuildAdd(builder, index, params->group, "");
   index = LLVMBuildMul(builder, index, lp_build_const_int32(gallivm, 4), "");
   ctx->count_ptr = byte_offset(ctx, load_ptr(ctx, ctx->tile,
                                              offsetof(struct lp_peel_tile, counts)),
                                index);
   ctx->last = load_int32(ctx, ctx->count_ptr, 0);
   ctx->last_ptr =
      byte_offset(ctx, ctx->layers,
                  LLVMBuildMul(builder, ctx->last,
                               lp_build_const_int32(gallivm,
                                                    ctx->num_words * LP_PEEL_WORD_SIZE),
                               ""));
}


/** Fragments of these lanes fall behind the last layer, or fell out of it. */
static void
note_overflow(struct peel_context *ctx, LLVMValueRef mask)
{
   struct lp_build_if_state overflow;

   lp_build_if(&overflow, ctx->gallivm, any(ctx, mask));
   LLVMBuildStore(ctx->builder, lp_build_const_int32(ctx->gallivm, 1),
                  const_offset(ctx, ctx->tile,
                               offsetof(struct lp_peel_tile, overflow)));
   lp_build_endif(&overflow);
}


/** The group's part of its lp_peel_bound. */
static LLVMValueRef
bound_ptr(struct peel_context *ctx)
{
   struct gallivm_state *gallivm = ctx->gallivm;
   LLVMBuilderRef builder = ctx->builder;
   const struct lp_build_kbuf_params *params = ctx->params;
   const unsigned num_samples = MAX2(params->key->zsbuf_nr_samples, 1);
   LLVMTypeRef int64_type = LLVMInt64TypeInContext(gallivm->context);

   LLVMValueRef x = LLVMBuildAnd(builder, ctx->block,
                                 lp_build_const_int32(gallivm, 0xf), "");
   LLVMValueRef y = LLVMBuildLShr(builder, ctx->block,
                                  lp_build_const_int32(gallivm, 4), "");
   LLVMValueRef index =
      LLVMBuildMul(builder, y,
                   load_int32(ctx, ctx->tile,
                              offsetof(struct lp_peel_tile, bound_blocks_x)), "");
   index = LLVMBuildAdd(builder, index, x, "");
   if (num_samples > 1) {
      index = LLVMBuildMul(builder, index,
                           lp_build_const_int32(gallivm, num_samples), "");
      index = LLVMBuildAdd(builder, index, params->sample, "");
   }
   index = LLVMBuildMul(builder, LLVMBuildZExt(builder, index, int64_type, ""),
                        LLVMConstInt(int64_type, sizeof(struct lp_peel_bound), 0),
                        "");

   LLVMValueRef ptr =
      byte_offset(ctx, load_ptr(ctx, ctx->tile,
                                offsetof(struct lp_peel_tile, bounds)), index);
   return byte_offset(ctx, ptr,
                      LLVMBuildMul(builder, params->group,
                                   lp_build_const_int32(gallivm, ctx->type.length * 4),
                                   ""));
}


LLVMValueRef
lp_build_peel_cull(struct gallivm_state *gallivm,
                   const struct lp_build_kbuf_params *params)
{
   LLVMValueRef depth = params->pos[2];
   struct peel_context ctx;

   peel_begin(&ctx, gallivm, params, LP_PEEL_LAST);

   LLVMValueRef empty =
      broadcast(&ctx, load_int32(&ctx, ctx.tile,
                                 offsetof(struct lp_peel_tile, empty)));
   LLVMValueRef mask = and(&ctx, params->mask, less(&ctx, depth, empty));
   LLVMValueRef counted = NULL;

   if (ctx.key->bounded) {
      LLVMValueRef bound =
         load_vec(&ctx, bound_ptr(&ctx), offsetof(struct lp_peel_bound, depth));

      mask = and_not(&ctx, mask, less(&ctx, depth, bound));
      /* Each one at this depth has to be counted. */
      counted = and(&ctx, mask, equal(&ctx, depth, bound));
   }

   LLVMValueRef taken = passes(&ctx, depth, load_vec(&ctx, ctx.last_ptr, 0));
   if (counted)
      taken = LLVMBuildOr(ctx.builder, taken, counted, "");
   note_overflow(&ctx, and_not(&ctx, mask, taken));
   return and(&ctx, mask, taken);
}


/**
 * The lanes of which the fragment takes part: nearer than an empty layer, and
 * behind the bound.  Counts those that arrive at it.
 */
static LLVMValueRef
take_part(struct peel_context *ctx, LLVMValueRef depth)
{
   LLVMValueRef empty =
      broadcast(ctx, load_int32(ctx, ctx->tile,
                                offsetof(struct lp_peel_tile, empty)));
   LLVMValueRef mask = and(ctx, ctx->params->mask, less(ctx, depth, empty));

   if (!ctx->key->bounded)
      return mask;

   LLVMValueRef ptr = bound_ptr(ctx);
   LLVMValueRef bound =
      load_vec(ctx, ptr, offsetof(struct lp_peel_bound, depth));
   LLVMValueRef kept = load_vec(ctx, ptr, offsetof(struct lp_peel_bound, kept));
   LLVMValueRef seen = load_vec(ctx, ptr, offsetof(struct lp_peel_bound, seen));

   LLVMValueRef arrived = and(ctx, mask, equal(ctx, depth, bound));
   LLVMValueRef is_new = and_not(ctx, arrived, less(ctx, seen, kept));
   LLVMValueRef behind = and(ctx, mask, less(ctx, bound, depth));

   /* The mask is -1. */
   store_vec(ctx, LLVMBuildSub(ctx->builder, seen, arrived, ""), ptr,
             offsetof(struct lp_peel_bound, seen));
   return LLVMBuildOr(ctx->builder, behind, is_new, "");
}


/** The words of the fragment, as the buffers store them. */
static void
encode_fragment(struct peel_context *ctx, LLVMValueRef depth)
{
   const struct lp_build_kbuf_params *params = ctx->params;
   const struct lp_fragment_shader_variant_key *key = params->key;
   LLVMValueRef fpstate = NULL;
   bool denormals = false;

   for (unsigned i = 0; i < key->nr_cbufs; i++) {
      denormals |=
         lp_kbuf_format_needs_denormals(util_format_description(key->cbuf_format[i]));
   }
   if (denormals) {
      fpstate = lp_build_fpstate_get(ctx->gallivm);
      lp_build_fpstate_set_denorms_zero(ctx->gallivm, false);
   }

   ctx->fragment[0] = depth;
   for (unsigned i = 0, w = 1; i < key->nr_cbufs; i++) {
      if (key->cbuf_format[i] == PIPE_FORMAT_NONE)
         continue;

      const struct lp_kbuf_pixels pixels = {
         .gallivm = ctx->gallivm,
         .type = params->type,
         .desc = util_format_description(key->cbuf_format[i]),
      };
      lp_build_kbuf_encode(&pixels, 0xf, params->colors[i], &ctx->fragment[w]);
      w += lp_peel_color_words(key->cbuf_format[i]);
   }

   if (denormals)
      lp_build_fpstate_set(ctx->gallivm, fpstate);
}


LLVMValueRef
lp_build_peel_stage(struct gallivm_state *gallivm,
                    const struct lp_build_kbuf_params *params)
{
   LLVMBuilderRef builder = gallivm->builder;
   LLVMValueRef depth = params->pos[2];
   LLVMTypeRef int8_type = LLVMInt8TypeInContext(gallivm->context);
   struct lp_build_if_state alive, inserted, not_full;
   struct peel_context ctx;
   LLVMValueRef last[MAX_WORDS];

   LLVMTypeRef mask_type = LLVMTypeOf(params->mask);
   LLVMValueRef result = lp_build_alloca(gallivm, mask_type, "peel_inserted");
   LLVMBuildStore(builder, LLVMConstNull(mask_type), result);

   memset(&ctx, 0, sizeof ctx);
   ctx.gallivm = gallivm;
   ctx.builder = builder;
   ctx.type = lp_int_type(params->type);
   ctx.vec_type = mask_type;

   lp_build_if(&alive, gallivm, any(&ctx, params->mask));

   peel_begin(&ctx, gallivm, params, LP_PEEL_ALL);
   last[0] = load_vec(&ctx, ctx.last_ptr, 0);

   LLVMValueRef mask = take_part(&ctx, depth);
   LLVMValueRef empty =
      broadcast(&ctx, load_int32(&ctx, ctx.tile,
                                 offsetof(struct lp_peel_tile, empty)));
   LLVMValueRef active = and(&ctx, mask, passes(&ctx, depth, last[0]));

   /* Either the fragment falls out, or what is in the last layer. */
   note_overflow(&ctx, and(&ctx, mask, less(&ctx, last[0], empty)));
   LLVMBuildStore(builder, active, result);

   lp_build_if(&inserted, gallivm, any(&ctx, active));
   {
      const int layer_size = ctx.num_words * LP_PEEL_WORD_SIZE;

      for (unsigned w = 1; w < ctx.num_words; w++)
         last[w] = load_vec(&ctx, ctx.last_ptr, w * LP_PEEL_WORD_SIZE);
      encode_fragment(&ctx, depth);

      LLVMValueRef last_layer =
         load_int32(&ctx, ctx.tile, offsetof(struct lp_peel_tile, last_layer));
      lp_build_if(&not_full, gallivm,
                  LLVMBuildICmp(builder, LLVMIntULT, ctx.last, last_layer, ""));
      {
         LLVMValueRef count =
            LLVMBuildAdd(builder, ctx.last, lp_build_const_int32(gallivm, 1), "");

         LLVMBuildStore(builder, count, ctx.count_ptr);
         for (unsigned w = 0; w < ctx.num_words; w++) {
            store_vec(&ctx, last[w], ctx.last_ptr,
                      layer_size + w * LP_PEEL_WORD_SIZE);
         }
      }
      lp_build_endif(&not_full);

      LLVMValueRef changed =
         const_offset(&ctx, ctx.tile, offsetof(struct lp_peel_tile, changed));
      LLVMBuildStore(builder,
                     LLVMConstInt(int8_type, LP_PEEL_CHANGED | LP_PEEL_UNKNOWN, 0),
                     byte_offset(&ctx, changed, ctx.block));

      lp_build_peel_insert(&ctx, active, last);
   }
   lp_build_endif(&inserted);
   lp_build_endif(&alive);

   return LLVMBuildLoad2(builder, mask_type, result, "");
}
