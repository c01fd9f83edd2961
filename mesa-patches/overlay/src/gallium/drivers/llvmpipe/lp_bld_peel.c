/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_bld_peel.h"

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


static LLVMValueRef
byte_offset(struct peel_context *ctx, LLVMValueRef ptr, LLVMValueRef offset)
{
   LLVMTypeRef int8_type = LLVMInt8TypeInContext(ctx->gallivm->context);

   return LLVMBuildGEP2(ctx->builder, int8_type, ptr, &offset, 1, "");
}


static LLVMValueRef
const_offset(struct peel_context *ctx, LLVMValueRef ptr, int offset)
{
   return byte_offset(ctx, ptr, lp_build_const_int32(ctx->gallivm, offset));
}


static LLVMValueRef
load_ptr(struct peel_context *ctx, LLVMValueRef base, size_t offset)
{
   LLVMTypeRef ptr_type =
      LLVMPointerType(LLVMInt8TypeInContext(ctx->gallivm->context), 0);

   return LLVMBuildLoad2(ctx->builder, ptr_type,
                         const_offset(ctx, base, offset), "");
}


static LLVMValueRef
load_int32(struct peel_context *ctx, LLVMValueRef base, size_t offset)
{
   return LLVMBuildLoad2(ctx->builder,
                         LLVMInt32TypeInContext(ctx->gallivm->context),
                         const_offset(ctx, base, offset), "");
}


static LLVMValueRef
load_vec(struct peel_context *ctx, LLVMValueRef ptr, int offset)
{
   LLVMValueRef value = LLVMBuildLoad2(ctx->builder, ctx->vec_type,
                                       const_offset(ctx, ptr, offset), "");

   LLVMSetAlignment(value, ctx->type.length * 4);
   return value;
}


static void
store_vec(struct peel_context *ctx, LLVMValueRef value, LLVMValueRef ptr,
          int offset)
{
   LLVMValueRef instr = LLVMBuildStore(ctx->builder, value,
                                       const_offset(ctx, ptr, offset));

   LLVMSetAlignment(instr, ctx->type.length * 4);
}


static LLVMValueRef
broadcast(struct peel_context *ctx, LLVMValueRef scalar)
{
   return lp_build_broadcast(ctx->gallivm, ctx->vec_type, scalar);
}


/** Masks are vectors of 0 and -1, of which only the sign is looked at. */
static LLVMValueRef
less(struct peel_context *ctx, LLVMValueRef a, LLVMValueRef b)
{
   return LLVMBuildSExt(ctx->builder,
                        LLVMBuildICmp(ctx->builder, LLVMIntSLT, a, b, ""),
                        ctx->vec_type, "");
}


static LLVMValueRef
equal(struct peel_context *ctx, LLVMValueRef a, LLVMValueRef b)
{
   return LLVMBuildSExt(ctx->builder,
                        LLVMBuildICmp(ctx->builder, LLVMIntEQ, a, b, ""),
                        ctx->vec_type, "");
}


static LLVMValueRef
and(struct peel_context *ctx, LLVMValueRef a, LLVMValueRef b)
{
   return LLVMBuildAnd(ctx->builder, a, b, "");
}


static LLVMValueRef
and_not(struct peel_context *ctx, LLVMValueRef a, LLVMValueRef b)
{
   return LLVMBuildAnd(ctx->builder, a, LLVMBuildNot(ctx->builder, b, ""), "");
}


static LLVMValueRef
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


static LLVMValueRef
select_lanes(struct peel_context *ctx, LLVMValueRef mask,
             LLVMValueRef a, LLVMValueRef b)
{
   mask = LLVMBuildICmp(ctx->builder, LLVMIntSLT, mask,
                        LLVMConstNull(ctx->vec_type), "");
   return LLVMBuildSelect(ctx->builder, mask, a, b, "");
}


/** Whether a fragment of the first depth goes in front of the second. */
static LLVMValueRef
passes(struct peel_context *ctx, LLVMValueRef depth, LLVMValueRef layer)
{
   if (!ctx->key->equal)
      return less(ctx, depth, layer);

   return LLVMBuildSExt(ctx->builder,
                        LLVMBuildICmp(ctx->builder, LLVMIntSLE, depth, layer, ""),
                        ctx->vec_type, "");
}


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


/** Have the block loaded if no fragment has come to it before. */
static void
load_block(struct peel_context *ctx)
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
               LLVMBuildICmp(ctx->builder, LLVMIntEQ, valid,
                             LLVMConstInt(int8_type, 0, 0), ""));
   {
      LLVMValueRef args[2] = { ctx->tile, ctx->block };
      LLVMValueRef func = load_ptr(ctx, ctx->tile,
                                   offsetof(struct lp_peel_tile, load_block));

      LLVMBuildCall2(ctx->builder, func_type, func, args, 2, "");
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
           const struct lp_build_kbuf_params *params)
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

   load_block(ctx);

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

   peel_begin(&ctx, gallivm, params);

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
         .as_blending = true,
      };
      lp_build_kbuf_encode(&pixels, 0xf, params->colors[i], &ctx->fragment[w]);
      w += lp_peel_color_words(key->cbuf_format[i]);
   }

   if (denormals)
      lp_build_fpstate_set(ctx->gallivm, fpstate);
}


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
static void
insert(struct peel_context *ctx, LLVMValueRef first_active,
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

   peel_begin(&ctx, gallivm, params);
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
      LLVMBuildStore(builder, LLVMConstInt(int8_type, 1, 0),
                     byte_offset(&ctx, changed, ctx.block));

      insert(&ctx, active, last);
   }
   lp_build_endif(&inserted);
   lp_build_endif(&alive);

   return LLVMBuildLoad2(builder, mask_type, result, "");
}
