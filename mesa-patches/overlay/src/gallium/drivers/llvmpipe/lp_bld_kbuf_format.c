/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_bld_kbuf_format.h"

#include "util/u_cpu_detect.h"
#include "util/u_math.h"
#include "gallivm/lp_bld_arit.h"
#include "gallivm/lp_bld_const.h"
#include "gallivm/lp_bld_conv.h"
#include "gallivm/lp_bld_format.h"
#include "gallivm/lp_bld_init.h"
#include "gallivm/lp_bld_swizzle.h"

#include "lp_bld_kbuf_channel.h"
#include "lp_bld_tile.h"

#define MAX_LANES 8


/** 32-bit words of a pixel; a smaller pixel is extended to one. */
static unsigned
num_words(const struct lp_kbuf_pixels *pixels)
{
   return DIV_ROUND_UP(pixels->desc->block.bits, 32);
}


static LLVMTypeRef
int_type(const struct lp_kbuf_pixels *pixels, unsigned width, unsigned length)
{
   return LLVMVectorType(LLVMIntTypeInContext(pixels->gallivm->context, width),
                         length);
}


static LLVMValueRef
shuffle(const struct lp_kbuf_pixels *pixels, LLVMValueRef a, LLVMValueRef b,
        const unsigned *lanes, unsigned length)
{
   LLVMValueRef indices[MAX_LANES];

   assert(length <= MAX_LANES);
   for (unsigned i = 0; i < length; i++)
      indices[i] = lp_build_const_int32(pixels->gallivm, lanes[i]);

   return LLVMBuildShuffleVector(pixels->gallivm->builder, a, b,
                                 LLVMConstVector(indices, length), "");
}


/** The pointer to a pixel of the group. */
static LLVMValueRef
pixel_ptr(const struct lp_kbuf_pixels *pixels, unsigned row, unsigned x)
{
   LLVMValueRef offset =
      lp_build_const_int32(pixels->gallivm, x * pixels->desc->block.bits / 8);

   return LLVMBuildGEP2(pixels->gallivm->builder,
                        LLVMInt8TypeInContext(pixels->gallivm->context),
                        pixels->rows[row], &offset, 1, "");
}


/** Alignment of a run of pixels that starts at a multiple of its length. */
static unsigned
alignment(const struct lp_kbuf_pixels *pixels, unsigned num_pixels)
{
   const unsigned bytes = pixels->desc->block.bits / 8 * num_pixels;

   return bytes % 16 == 0 ? 16 : bytes & -bytes;
}


static LLVMValueRef
load(const struct lp_kbuf_pixels *pixels, LLVMTypeRef type,
     unsigned row, unsigned x, unsigned num_pixels)
{
   /* The second row of a 1D resource is never used: repeat the first. */
   LLVMValueRef value =
      LLVMBuildLoad2(pixels->gallivm->builder, type,
                     pixel_ptr(pixels, pixels->rows[row] ? row : 0, x), "");

   LLVMSetAlignment(value, alignment(pixels, num_pixels));
   return value;
}


static void
store(const struct lp_kbuf_pixels *pixels, LLVMValueRef value,
      unsigned row, unsigned x, unsigned num_pixels)
{
   if (pixels->rows[row]) {
      LLVMValueRef instr =
         LLVMBuildStore(pixels->gallivm->builder, value,
                        pixel_ptr(pixels, row, x));

      LLVMSetAlignment(instr, alignment(pixels, num_pixels));
   }
}


/*
 * Pixels of up to 32 bits: a row of the group is one vector.
 */

static void
load_1_word(const struct lp_kbuf_pixels *pixels, LLVMValueRef words[1])
{
   static const unsigned lanes[2][MAX_LANES] = {
      { 0, 1, 2, 3 }, { 0, 1, 4, 5, 2, 3, 6, 7 }
   };
   const unsigned length = pixels->type.length;
   LLVMTypeRef row_type = int_type(pixels, pixels->desc->block.bits,
                                   length / 2);
   LLVMValueRef rows[2];

   for (unsigned i = 0; i < 2; i++)
      rows[i] = load(pixels, row_type, i, 0, length / 2);

   words[0] = shuffle(pixels, rows[0], rows[1], lanes[length == 8], length);
   words[0] = LLVMBuildZExt(pixels->gallivm->builder, words[0],
                            int_type(pixels, 32, length), "");
}


static void
store_1_word(const struct lp_kbuf_pixels *pixels, const LLVMValueRef words[1])
{
   static const unsigned lanes[2][2][MAX_LANES / 2] = {
      { { 0, 1 }, { 2, 3 } }, { { 0, 1, 4, 5 }, { 2, 3, 6, 7 } }
   };
   const unsigned length = pixels->type.length;
   LLVMValueRef packed =
      LLVMBuildTrunc(pixels->gallivm->builder, words[0],
                     int_type(pixels, pixels->desc->block.bits, length), "");

   for (unsigned i = 0; i < 2; i++) {
      store(pixels, shuffle(pixels, packed, packed, lanes[length == 8][i],
                            length / 2), i, 0, length / 2);
   }
}


/*
 * Pixels of 64 bits: a row of the group is one vector, and a quad is the same
 * 128 bits of both.
 */

static void
load_2_words(const struct lp_kbuf_pixels *pixels, LLVMValueRef words[2])
{
   const unsigned length = pixels->type.length;
   LLVMTypeRef row_type = int_type(pixels, 32, length);
   LLVMValueRef rows[2];

   for (unsigned i = 0; i < 2; i++)
      rows[i] = load(pixels, row_type, i, 0, length / 2);

   for (unsigned w = 0; w < 2; w++) {
      unsigned lanes[MAX_LANES] = { 0 };

      for (unsigned quad = 0; quad < length; quad += 4) {
         lanes[quad + 0] = quad + w;
         lanes[quad + 1] = quad + w + 2;
         lanes[quad + 2] = quad + w + length;
         lanes[quad + 3] = quad + w + length + 2;
      }
      words[w] = shuffle(pixels, rows[0], rows[1], lanes, length);
   }
}


static void
store_2_words(const struct lp_kbuf_pixels *pixels, const LLVMValueRef words[2])
{
   const unsigned length = pixels->type.length;

   for (unsigned i = 0; i < 2; i++) {
      unsigned lanes[MAX_LANES];

      for (unsigned quad = 0; quad < length; quad += 4) {
         lanes[quad + 0] = quad + 2 * i;
         lanes[quad + 1] = quad + 2 * i + length;
         lanes[quad + 2] = quad + 2 * i + 1;
         lanes[quad + 3] = quad + 2 * i + 1 + length;
      }
      store(pixels, shuffle(pixels, words[0], words[1], lanes, length),
            i, 0, length / 2);
   }
}


/*
 * Pixels of 96 and 128 bits: one vector is the same pixel of both quads.
 */

static void
load_aos(const struct lp_kbuf_pixels *pixels, LLVMValueRef aos[4])
{
   static const unsigned lanes[MAX_LANES] = { 0, 1, 2, 3, 4, 5, 6, 7 };
   const unsigned words = num_words(pixels);

   for (unsigned i = 0; i < 4; i++) {
      LLVMValueRef quads[2];

      for (unsigned q = 0; q < pixels->type.length / 4; q++) {
         quads[q] = load(pixels, int_type(pixels, 32, words),
                         i / 2, 2 * q + i % 2, 1);
         if (words < 4)
            quads[q] = shuffle(pixels, quads[q], LLVMGetUndef(LLVMTypeOf(quads[q])),
                               lanes, 4);
      }
      aos[i] = pixels->type.length == 4 ? quads[0] :
         shuffle(pixels, quads[0], quads[1], lanes, 8);
   }
}


static void
store_aos(const struct lp_kbuf_pixels *pixels, const LLVMValueRef aos[4])
{
   const unsigned words = num_words(pixels);

   for (unsigned i = 0; i < 4; i++) {
      for (unsigned q = 0; q < pixels->type.length / 4; q++) {
         unsigned lanes[4];

         for (unsigned w = 0; w < words; w++)
            lanes[w] = 4 * q + w;
         store(pixels, shuffle(pixels, aos[i], aos[i], lanes, words),
               i / 2, 2 * q + i % 2, 1);
      }
   }
}


/*
 * Words of pixels, wherever they are.
 */

static void
load_words(const struct lp_kbuf_pixels *pixels, LLVMValueRef words[4])
{
   LLVMValueRef aos[4];

   if (pixels->tile) {
      for (unsigned w = 0; w < num_words(pixels); w++)
         words[w] = lp_build_tile_load(pixels->tile, pixels->words,
                                       w * LP_TILE_WORD_SIZE);
      return;
   }

   switch (num_words(pixels)) {
   case 1:
      load_1_word(pixels, words);
      break;
   case 2:
      load_2_words(pixels, words);
      break;
   default:
      load_aos(pixels, aos);
      lp_build_transpose_aos(pixels->gallivm, lp_int_type(pixels->type),
                             aos, words);
      break;
   }
}


/** Store the given bits of the words in the lanes of mask. */
static void
store_words(const struct lp_kbuf_pixels *pixels, LLVMValueRef mask,
            const LLVMValueRef new_words[4], const uint32_t bits[4])
{
   LLVMValueRef old[4], words[4];
   struct lp_build_context bld;

   lp_build_context_init(&bld, pixels->gallivm, lp_int_type(pixels->type));
   load_words(pixels, old);
   for (unsigned w = 0; w < num_words(pixels); w++)
      words[w] = lp_build_merge_bits(&bld, mask, bits[w], new_words[w], old[w]);

   if (pixels->tile) {
      for (unsigned w = 0; w < num_words(pixels); w++) {
         if (bits[w]) {
            lp_build_tile_store(pixels->tile, words[w], pixels->words,
                                w * LP_TILE_WORD_SIZE);
         }
      }
   } else if (num_words(pixels) == 1) {
      store_1_word(pixels, words);
   } else {
      store_2_words(pixels, words);
   }
}


/**
 * Store the given bits of words in the lanes of mask, where a pixel has so many
 * words that it is cheaper to select whole pixels as they lie in memory.
 */
static void
store_words_aos(const struct lp_kbuf_pixels *pixels, LLVMValueRef mask,
                const LLVMValueRef new_words[4], const uint32_t bits[4])
{
   struct gallivm_state *gallivm = pixels->gallivm;
   const unsigned length = pixels->type.length;
   LLVMValueRef words[4], old[4], aos[4], written[MAX_LANES];
   LLVMTypeRef vec_type = int_type(pixels, 32, length);
   struct lp_build_context bld;

   lp_build_context_init(&bld, gallivm, lp_int_type(pixels->type));
   for (unsigned w = 0; w < 4; w++) {
      assert(!bits[w] || !~bits[w]);
      words[w] = bits[w] ? new_words[w] : LLVMGetUndef(vec_type);
      for (unsigned q = 0; q < length; q += 4)
         written[q + w] = lp_build_const_int32(gallivm, bits[w]);
   }

   load_aos(pixels, old);
   lp_build_transpose_aos(gallivm, lp_int_type(pixels->type), words, aos);
   for (unsigned i = 0; i < 4; i++) {
      unsigned lanes[MAX_LANES];

      for (unsigned lane = 0; lane < length; lane++)
         lanes[lane] = (lane & ~3) + i;

      LLVMValueRef pixel_mask = shuffle(pixels, mask, mask, lanes, length);
      pixel_mask = LLVMBuildAnd(gallivm->builder, pixel_mask,
                                LLVMConstVector(written, length), "");
      aos[i] = lp_build_merge_bits(&bld, pixel_mask, ~0u, aos[i], old[i]);
   }
   store_aos(pixels, aos);
}


bool
lp_kbuf_format_needs_denormals(const struct util_format_description *desc)
{
   if (desc->format == PIPE_FORMAT_R11G11B10_FLOAT)
      return true;

   /* The instructions that convert halves do not look at the mode. */
   return desc->channel[0].type == UTIL_FORMAT_TYPE_FLOAT &&
          desc->channel[0].size == 16 && !util_get_cpu_caps()->has_f16c;
}


/**
 * A format of 32 bits of which each word of a larger pixel is one: all channels
 * of such a pixel are alike, and each has 16 or 32 bits.
 */
static enum pipe_format
word_format(const struct util_format_description *desc)
{
   const struct util_format_channel_description *chan = &desc->channel[0];

   if (chan->size == 32)
      return PIPE_FORMAT_R32_FLOAT;

   assert(chan->size == 16);
   switch (chan->type) {
   case UTIL_FORMAT_TYPE_FLOAT:
      return PIPE_FORMAT_R16G16_FLOAT;
   case UTIL_FORMAT_TYPE_SIGNED:
      return PIPE_FORMAT_R16G16_SNORM;
   default:
      return PIPE_FORMAT_R16G16_UNORM;
   }
}


/** Components of a pixel of several words. */
static void
unpack_words(const struct lp_kbuf_pixels *pixels, const LLVMValueRef *words,
             LLVMValueRef rgba[4])
{
   const struct util_format_description *desc = pixels->desc;
   const struct util_format_description *word =
      util_format_description(word_format(desc));
   LLVMValueRef channels[8];
   struct lp_build_context bld;

   for (unsigned w = 0; w < num_words(pixels); w++) {
      LLVMValueRef components[4];

      lp_build_unpack_rgba_soa(pixels->gallivm, word, pixels->type, words[w],
                               components);
      memcpy(&channels[w * word->nr_channels], components,
             word->nr_channels * sizeof components[0]);
   }
   lp_build_context_init(&bld, pixels->gallivm, pixels->type);
   lp_build_format_swizzle_soa(desc, &bld, channels, rgba);
}


void
lp_build_kbuf_load(const struct lp_kbuf_pixels *pixels, LLVMValueRef rgba[4])
{
   struct gallivm_state *gallivm = pixels->gallivm;
   LLVMValueRef words[4];

   load_words(pixels, words);
   if (pixels->desc->format == PIPE_FORMAT_R11G11B10_FLOAT) {
      lp_build_r11g11b10_to_float(gallivm, words[0], rgba);
      rgba[3] = lp_build_one(gallivm, pixels->type);
   } else if (num_words(pixels) == 1) {
      lp_build_unpack_rgba_soa(gallivm, pixels->desc, pixels->type, words[0],
                               rgba);
   } else {
      unpack_words(pixels, words, rgba);
   }
}


/** The channel that a format's description has for a component, or NULL. */
static const struct util_format_channel_description *
component_channel(const struct util_format_description *desc, unsigned comp)
{
   const unsigned c = desc->swizzle[comp];

   if (c > PIPE_SWIZZLE_W)
      return NULL;

   /* The first component that a channel gives is the one that it takes. */
   for (unsigned i = 0; i < comp; i++) {
      if (desc->swizzle[i] == c)
         return NULL;
   }
   return &desc->channel[c];
}


static const struct util_format_channel_description r11g11b10_channels[3] = {
   { .size = 11, .shift = 0 },
   { .size = 11, .shift = 11 },
   { .size = 10, .shift = 22 },
};


/** The channel that holds a component in any format, or NULL. */
static const struct util_format_channel_description *
stored_channel(const struct util_format_description *desc, unsigned comp)
{
   if (desc->format == PIPE_FORMAT_R11G11B10_FLOAT)
      return comp < 3 ? &r11g11b10_channels[comp] : NULL;
   return component_channel(desc, comp);
}


void
lp_kbuf_format_bits(const struct util_format_description *desc,
                    unsigned write_mask, uint32_t *bits)
{
   memset(bits, 0, DIV_ROUND_UP(desc->block.bits, 32) * sizeof *bits);
   for (unsigned comp = 0; comp < 4; comp++) {
      const struct util_format_channel_description *chan =
         stored_channel(desc, comp);

      if (chan && write_mask & (1 << comp))
         bits[chan->shift / 32] |= u_bit_consecutive(chan->shift % 32, chan->size);
   }
}


void
lp_build_kbuf_encode(const struct lp_kbuf_pixels *pixels, unsigned write_mask,
                     const LLVMValueRef rgba[4], LLVMValueRef *words)
{
   const struct util_format_description *desc = pixels->desc;
   struct gallivm_state *gallivm = pixels->gallivm;
   LLVMBuilderRef builder = gallivm->builder;

   if (desc->format == PIPE_FORMAT_R11G11B10_FLOAT) {
      words[0] = lp_build_float_to_r11g11b10(gallivm, rgba);
      return;
   }
   if (desc->colorspace == UTIL_FORMAT_COLORSPACE_SRGB) {
      LLVMValueRef src[4] = { NULL, NULL, NULL, rgba[3] };
      struct lp_build_context bld;

      /* The conversion makes 1 of a NaN in these components. */
      lp_build_context_init(&bld, gallivm, pixels->type);
      for (unsigned c = 0; c < 3; c++) {
         src[c] = lp_build_max_ext(&bld, rgba[c], bld.zero,
                                   GALLIVM_NAN_RETURN_OTHER_SECOND_NONNAN);
      }
      words[0] = lp_build_float_to_srgb_packed(gallivm, desc, pixels->type, src);
      return;
   }

   for (unsigned w = 0; w < num_words(pixels); w++)
      words[w] = LLVMConstNull(int_type(pixels, 32, pixels->type.length));

   for (unsigned comp = 0; comp < 4; comp++) {
      const struct util_format_channel_description *chan =
         component_channel(desc, comp);

      if (!chan || !(write_mask & (1 << comp)))
         continue;

      LLVMValueRef value = lp_build_kbuf_encode_channel(pixels, chan, rgba[comp]);
      const unsigned w = chan->shift / 32, start = chan->shift % 32;
      if (start) {
         value = LLVMBuildShl(builder, value,
                              lp_build_const_int_vec(gallivm, lp_int_type(pixels->type),
                                                     start), "");
      }
      words[w] = LLVMBuildOr(builder, words[w], value, "");
   }
}


void
lp_build_kbuf_store(const struct lp_kbuf_pixels *pixels,
                    LLVMValueRef mask, unsigned write_mask,
                    const LLVMValueRef rgba[4])
{
   LLVMValueRef words[4];
   uint32_t bits[4] = { 0 };

   lp_kbuf_format_bits(pixels->desc, write_mask, bits);
   if (!(bits[0] | bits[1] | bits[2] | bits[3]))
      return;

   lp_build_kbuf_encode(pixels, write_mask, rgba, words);
   if (num_words(pixels) > 2 && !pixels->tile)
      store_words_aos(pixels, mask, words, bits);
   else
      store_words(pixels, mask, words, bits);
}
