/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_bld_kbuf_channel.h"

#include "util/u_math.h"
#include "gallivm/lp_bld_arit.h"
#include "gallivm/lp_bld_const.h"
#include "gallivm/lp_bld_conv.h"
#include "gallivm/lp_bld_type.h"


static LLVMTypeRef
int_type(const struct lp_kbuf_pixels *pixels, unsigned width)
{
   return LLVMVectorType(LLVMIntTypeInContext(pixels->gallivm->context, width),
                         pixels->type.length);
}


/** Integers are in the guise of floats.  They are clamped. */
static LLVMValueRef
encode_integer(const struct lp_kbuf_pixels *pixels,
               const struct util_format_channel_description *chan,
               LLVMValueRef value)
{
   struct gallivm_state *gallivm = pixels->gallivm;
   LLVMBuilderRef builder = gallivm->builder;
   const bool sign = chan->type == UTIL_FORMAT_TYPE_SIGNED;
   struct lp_type type = lp_int_type(pixels->type);
   struct lp_build_context bld;

   type.sign = sign;
   lp_build_context_init(&bld, gallivm, type);
   value = LLVMBuildBitCast(builder, value, bld.vec_type, "");
   if (chan->size == 32)
      return value;

   const uint32_t mask = (1u << chan->size) - 1;
   const int32_t max = sign ? mask >> 1 : mask;
   value = lp_build_min(&bld, value, lp_build_const_int_vec(gallivm, type, max));
   if (sign) {
      value = lp_build_max(&bld, value,
                           lp_build_const_int_vec(gallivm, type, -max - 1));
      value = LLVMBuildAnd(builder, value,
                           lp_build_const_int_vec(gallivm, type, mask), "");
   }
   return value;
}


/**
 * Bits of an unsigned channel that a color has on its way to the buffer without
 * the k-buffer stage, see lp_blend_type_from_format_desc().
 */
static unsigned
store_bits(const struct util_format_description *desc,
           const struct util_format_channel_description *chan)
{
   bool packed = false;
   unsigned most = 0;

   for (unsigned i = 0; i < desc->nr_channels; i++) {
      packed |= desc->channel[i].size != desc->channel[0].size;
      packed |= desc->channel[i].size % 8 != 0;
      most = MAX2(most, desc->channel[i].size);
   }
   return packed && most <= 16 ? (most <= 8 ? 8 : 16) : chan->size;
}


/** As scale_bits() in lp_state_fs.c rounds. */
static LLVMValueRef
scale_down(const struct lp_kbuf_pixels *pixels, LLVMValueRef value,
           unsigned src_bits, unsigned dst_bits)
{
   struct gallivm_state *gallivm = pixels->gallivm;
   LLVMBuilderRef builder = gallivm->builder;
   const struct lp_type type = lp_int_type(pixels->type);
   const unsigned delta = src_bits - dst_bits;
   LLVMValueRef delta_vec = lp_build_const_int_vec(gallivm, type, delta);

   if (!delta)
      return value;
   if (delta <= dst_bits && dst_bits == 4) {
      value = lp_build_unsigned_norm_to_float(gallivm, src_bits, pixels->type,
                                              value);
      return lp_build_clamped_float_to_unsigned_norm(gallivm, pixels->type,
                                                     dst_bits, value);
   }
   if (delta <= dst_bits)
      return LLVMBuildLShr(builder, value, delta_vec, "");

   value = LLVMBuildLShr(builder, value,
                         lp_build_const_int_vec(gallivm, type, dst_bits), "");
   value = LLVMBuildMul(builder, value,
                        lp_build_const_int_vec(gallivm, type,
                                               (1u << dst_bits) - 1), "");
   value = LLVMBuildAdd(builder, value,
                        lp_build_const_int_vec(gallivm, type,
                                               1u << (delta - 1)), "");
   return LLVMBuildLShr(builder, value, delta_vec, "");
}


LLVMValueRef
lp_build_kbuf_encode_channel(const struct lp_kbuf_pixels *pixels,
                             const struct util_format_channel_description *chan,
                             LLVMValueRef value)
{
   struct gallivm_state *gallivm = pixels->gallivm;
   LLVMBuilderRef builder = gallivm->builder;
   const struct lp_type type = pixels->type;
   const struct lp_type itype = lp_int_type(type);
   LLVMTypeRef int_vec_type = int_type(pixels, 32);
   struct lp_build_context bld;

   lp_build_context_init(&bld, gallivm, type);

   if (chan->pure_integer)
      return encode_integer(pixels, chan, value);

   switch (chan->type) {
   case UTIL_FORMAT_TYPE_UNSIGNED: {
      const unsigned bits = store_bits(pixels->desc, chan);

      value = lp_build_clamp_zero_one_nanzero(&bld, value);
      if (bits > 16) {
         return lp_build_clamped_float_to_unsigned_norm(gallivm, type, bits,
                                                        value);
      }
      value = lp_build_mul(&bld, value,
                           lp_build_const_vec(gallivm, type, (1u << bits) - 1));
      value = lp_build_iround(&bld, value);
      return scale_down(pixels, value, bits, chan->size);
   }

   case UTIL_FORMAT_TYPE_SIGNED: {
      const double max = (1u << (chan->size - 1)) - 1;

      /* A NaN becomes -1, a signaling one, too: the product is a quiet one.
       * LLVM makes FMAXNM of the maximum on ARM, of which the other operand is
       * the result for a quiet NaN only.
       */
      value = lp_build_mul(&bld, value, lp_build_const_vec(gallivm, type, max));
      value = lp_build_max_ext(&bld, value,
                               lp_build_const_vec(gallivm, type, -max),
                               GALLIVM_NAN_RETURN_OTHER_SECOND_NONNAN);
      value = lp_build_min(&bld, value, lp_build_const_vec(gallivm, type, max));
      value = lp_build_iround(&bld, value);
      return LLVMBuildAnd(builder, value,
                          lp_build_const_int_vec(gallivm, itype,
                                                 BITFIELD_MASK(chan->size)), "");
   }

   default:
      assert(chan->type == UTIL_FORMAT_TYPE_FLOAT);
      if (chan->size == 16) {
         value = lp_build_float_to_half(gallivm, value);
         value = LLVMBuildBitCast(builder, value,
                                  int_type(pixels, 16), "");
         return LLVMBuildZExt(builder, value, int_vec_type, "");
      }
      return LLVMBuildBitCast(builder, value, int_vec_type, "");
   }
}
