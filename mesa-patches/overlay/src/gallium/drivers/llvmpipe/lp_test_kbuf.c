/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_test_kbuf.c
 * Unit tests of the generated code of the k-buffer stage: how pixels of each
 * format are loaded and stored, in color buffers and in the tile store, and how
 * fragments are inserted among layers, each compared with C.
 */

#include "util/format/u_format.h"
#include "util/format_r11g11b10f.h"
#include "util/format_srgb.h"
#include "util/half_float.h"
#include "util/u_memory.h"

#include "gallivm/lp_bld_const.h"
#include "gallivm/lp_bld_init.h"

#include "lp_bld_kbuf_format.h"
#include "lp_bld_peel_context.h"
#include "lp_test.h"

#define MAX_LANES 8
#define MAX_BYTES 16  /**< of a pixel */
#define ROUNDS 32     /**< with other values, of each function */


/** The pixels of a group, in one of the forms that they can have. */
struct group
{
   alignas(64) uint8_t rows[2][MAX_LANES / 2 * MAX_BYTES];
   alignas(64) uint32_t words[4 * 16];
};

typedef void (*load_func)(float *rgba, struct group *group);
typedef void (*store_func)(const float *rgba, const int32_t *mask,
                           struct group *group);

/** What is compiled and tested. */
struct format_case
{
   const struct util_format_description *desc;
   unsigned length;      /**< lanes */
   unsigned write_mask;  /**< of components; 0: a load */
   bool tile;            /**< in the tile store */
};


void
write_tsv_header(FILE *fp)
{
   fprintf(fp, "result\ttest\n");
   fflush(fp);
}


static bool
report(unsigned verbose, FILE *fp, bool success, const char *name)
{
   if (fp)
      fprintf(fp, "%s\t%s\n", success ? "pass" : "fail", name);
   if (verbose || !success)
      printf("%s %s\n", success ? "pass" : "FAIL", name);
   return success;
}


/*
 * Formats.
 */

/** Formats that llvmpipe can draw to, see llvmpipe_is_format_supported(). */
static bool
is_tested(const struct util_format_description *desc)
{
   if (desc->format == PIPE_FORMAT_R11G11B10_FLOAT)
      return true;
   if (desc->layout != UTIL_FORMAT_LAYOUT_PLAIN ||
       desc->block.bits > 8 * MAX_BYTES || desc->is_mixed ||
       (!desc->is_array && !desc->is_bitmask) ||
       (desc->is_array && desc->nr_channels == 3 && desc->block.bits != 96))
      return false;
   if (desc->colorspace == UTIL_FORMAT_COLORSPACE_SRGB)
      return desc->block.bits == 32;
   if (desc->colorspace != UTIL_FORMAT_COLORSPACE_RGB)
      return false;

   for (unsigned c = 0; c < desc->nr_channels; c++) {
      const struct util_format_channel_description *chan = &desc->channel[c];

      switch (chan->type) {
      case UTIL_FORMAT_TYPE_VOID:
         break;
      case UTIL_FORMAT_TYPE_FLOAT:
         if (chan->size != 16 && chan->size != 32)
            return false;
         break;
      case UTIL_FORMAT_TYPE_UNSIGNED:
      case UTIL_FORMAT_TYPE_SIGNED:
         if (!(chan->normalized && chan->size <= 16) &&
             !(chan->pure_integer && chan->size <= 32))
            return false;
         break;
      default:
         return false;
      }
   }
   return true;
}


static bool
is_integer(const struct util_format_description *desc)
{
   return util_format_is_pure_integer(desc->format);
}


/** The bytes of the pixel of a lane, which the caller copies in or out. */
static void
copy_pixel(const struct format_case *test, struct group *group, unsigned lane,
           uint8_t *pixel, bool in)
{
   const unsigned bytes = test->desc->block.bits / 8;
   const unsigned x = lane / 4 * 2 + lane % 2, y = lane / 2 % 2;

   for (unsigned i = 0; i < bytes; i++) {
      uint8_t *byte = test->tile ?
         (uint8_t *)&group->words[i / 4 * 16 + lane] + i % 4 :
         &group->rows[y][x * bytes + i];

      if (in)
         *byte = pixel[i];
      else
         pixel[i] = *byte;
   }
}


static void
init_pixels(const struct format_case *test, struct gallivm_state *gallivm,
            LLVMValueRef group, struct lp_build_tile *tile,
            struct lp_kbuf_pixels *pixels)
{
   memset(pixels, 0, sizeof *pixels);
   pixels->gallivm = gallivm;
   pixels->type = lp_type_float_vec(32, 32 * test->length);
   pixels->desc = test->desc;
   if (test->tile) {
      memset(tile, 0, sizeof *tile);
      tile->gallivm = gallivm;
      lp_build_context_init(&tile->bld, gallivm, lp_int_type(pixels->type));
      pixels->tile = tile;
      pixels->words =
         lp_build_const_offset(gallivm, group, offsetof(struct group, words));
   } else {
      for (unsigned i = 0; i < 2; i++) {
         pixels->rows[i] =
            lp_build_const_offset(gallivm, group,
                                  offsetof(struct group, rows) +
                                  i * sizeof ((struct group *)0)->rows[0]);
      }
   }
}


/** A function of some pointers, of which the body is to follow. */
static LLVMValueRef
add_function(struct gallivm_state *gallivm, const char *name,
             unsigned num_pointers)
{
   LLVMTypeRef args[4];

   assert(num_pointers <= ARRAY_SIZE(args));
   for (unsigned i = 0; i < num_pointers; i++)
      args[i] = LLVMPointerType(LLVMInt8TypeInContext(gallivm->context), 0);

   LLVMValueRef func =
      LLVMAddFunction(gallivm->module, name,
                      LLVMFunctionType(LLVMVoidTypeInContext(gallivm->context),
                                       args, num_pointers, 0));
   LLVMSetFunctionCallConv(func, LLVMCCallConv);
   LLVMPositionBuilderAtEnd(gallivm->builder,
                            LLVMAppendBasicBlockInContext(gallivm->context, func,
                                                          "entry"));
   return func;
}


static func_pointer
finish_function(struct gallivm_state *gallivm, LLVMValueRef func,
                const char *name)
{
   LLVMBuildRetVoid(gallivm->builder);
   gallivm_verify_function(gallivm, func);
   gallivm_compile_module(gallivm);

   func_pointer compiled = gallivm_jit_function(gallivm, func, name);
   gallivm_free_ir(gallivm);
   return compiled;
}


static LLVMValueRef
component_ptr(struct gallivm_state *gallivm, LLVMValueRef rgba, unsigned c)
{
   return lp_build_const_offset(gallivm, rgba, c * MAX_LANES * sizeof(float));
}


static func_pointer
compile_format_case(const struct format_case *test,
                    struct gallivm_state *gallivm)
{
   LLVMBuilderRef builder = gallivm->builder;
   const unsigned num_args = test->write_mask ? 3 : 2;
   LLVMValueRef func = add_function(gallivm, "test", num_args);
   LLVMValueRef rgba_ptr = LLVMGetParam(func, 0);
   struct lp_build_tile tile;
   struct lp_kbuf_pixels pixels;
   LLVMValueRef rgba[4];

   init_pixels(test, gallivm, LLVMGetParam(func, num_args - 1), &tile, &pixels);
   LLVMTypeRef vec_type = lp_build_vec_type(gallivm, pixels.type);

   if (test->write_mask) {
      for (unsigned c = 0; c < 4; c++) {
         rgba[c] = LLVMBuildLoad2(builder, vec_type,
                                  component_ptr(gallivm, rgba_ptr, c), "");
      }
      LLVMValueRef mask =
         LLVMBuildLoad2(builder, lp_build_int_vec_type(gallivm, pixels.type),
                        LLVMGetParam(func, 1), "");
      lp_build_kbuf_store(&pixels, mask, test->write_mask, rgba);
   } else {
      lp_build_kbuf_load(&pixels, rgba);
      for (unsigned c = 0; c < 4; c++) {
         LLVMBuildStore(builder, rgba[c],
                        component_ptr(gallivm, rgba_ptr, c));
      }
   }
   return finish_function(gallivm, func, "test");
}


static bool
is_close(double a, double b, double tolerance)
{
   return (isnan(a) && isnan(b)) || a == b || fabs(a - b) <= tolerance;
}


static bool
check_load(const struct format_case *test, func_pointer func)
{
   const struct util_format_description *desc = test->desc;

   /* A product with a rounded reciprocal; or lp_build_srgb_to_linear(), which
    * is exact to 0.35 of 255 steps, of which the last has a slope of 2.4 / 1.055.
    */
   const double tolerance = desc->colorspace == UTIL_FORMAT_COLORSPACE_SRGB ?
      0.35 / 255 * 2.4 / 1.055 : 2e-7;

   for (unsigned round = 0; round < ROUNDS; round++) {
      struct group group;
      uint8_t pixels[MAX_LANES][MAX_BYTES];
      alignas(32) float rgba[4][MAX_LANES];

      memset(&group, 0, sizeof group);
      for (unsigned lane = 0; lane < test->length; lane++) {
         for (unsigned i = 0; i < MAX_BYTES; i++)
            pixels[lane][i] = rand() >> 8;
         copy_pixel(test, &group, lane, pixels[lane], true);
      }
      ((load_func)func)(rgba[0], &group);

      for (unsigned lane = 0; lane < test->length; lane++) {
         float expected[4];

         util_format_unpack_rgba(desc->format, expected, pixels[lane], 1);
         for (unsigned c = 0; c < 4; c++) {
            if (!is_close(rgba[c][lane], expected[c],
                          tolerance * MAX2(1, fabs(expected[c]))))
               return false;
         }
      }
   }
   return true;
}


/** A value that a component can have in a fragment. */
static float
random_component(bool integer)
{
   static const float special[] = {
      0.0f, -0.0f, 1.0f, -1.0f, 0.5f, 2.0f, -3.0f, 1e-6f, 65504.0f, 1e9f,
      INFINITY, -INFINITY, NAN,
   };

   if (integer) {
      const uint32_t bits = (uint32_t)rand() << (rand() % 3 * 8);

      return uif(rand() % 2 ? bits : -bits);
   }
   if (rand() % 4 == 0)
      return special[rand() % ARRAY_SIZE(special)];
   return rand() / (float)RAND_MAX * 3.0f - 1.5f;
}


/** Whether the bits of a channel are what becomes of a component. */
static bool
is_stored_value(const struct util_format_channel_description *chan,
                uint32_t bits, float value)
{
   const uint32_t max = BITFIELD_MASK(chan->size);

   if (chan->pure_integer) {
      const bool sign = chan->type == UTIL_FORMAT_TYPE_SIGNED;

      if (chan->size == 32)
         return bits == fui(value);
      if (sign) {
         const int32_t limit = max >> 1;

         return bits == (CLAMP((int32_t)fui(value), -limit - 1, limit) & max);
      }
      return bits == MIN2(fui(value), max);
   }

   switch (chan->type) {
   case UTIL_FORMAT_TYPE_FLOAT:
      if (chan->size == 32)
         return bits == fui(value);
      return isnan(value) ? (bits & 0x7fff) > 0x7c00 :
                            bits == _mesa_float_to_float16_rtz(value);
   case UTIL_FORMAT_TYPE_SIGNED: {
      const double limit = max >> 1;
      const double exact = isnan(value) ? -limit : CLAMP(value, -1.0, 1.0) * limit;

      return fabs(util_sign_extend(bits, chan->size) - exact) < 0.502;
   }
   default: {
      const double exact = isnan(value) ? 0 : CLAMP(value, 0.0, 1.0) * max;

      /* Channels of other sizes are rounded twice on their way to a buffer. */
      return fabs(bits - exact) < (chan->size % 8 ? 1.0 : 0.502);
   }
   }
}


/** Whether each of the three values is that of another conversion, or next. */
static bool
is_r11g11b10(uint32_t bits, const float rgb[4])
{
   static const unsigned sizes[3] = { 11, 11, 10 }, shifts[3] = { 0, 11, 22 };
   const uint32_t expected = float3_to_r11g11b10f(rgb);

   for (unsigned i = 0; i < 3; i++) {
      const int32_t a = bits >> shifts[i] & BITFIELD_MASK(sizes[i]);
      const int32_t b = expected >> shifts[i] & BITFIELD_MASK(sizes[i]);

      if (abs(a - b) > 1 && !isnan(rgb[i]))
         return false;
   }
   return true;
}


/** The bits of a channel, which does not cross words. */
static uint32_t
channel_bits(const struct util_format_channel_description *chan,
             const uint8_t *pixel)
{
   uint32_t word;

   memcpy(&word, pixel + chan->shift / 32 * 4, sizeof word);
   return word >> chan->shift % 32 & BITFIELD_MASK(chan->size);
}


static bool
is_stored_pixel(const struct format_case *test, const uint8_t *old_pixel,
                const uint8_t *pixel, const float rgba[4], bool written)
{
   const struct util_format_description *desc = test->desc;
   uint32_t bits[4] = { 0 }, words[4], old_words[4];

   /* All other bits stay as they are. */
   lp_kbuf_format_bits(desc, written ? test->write_mask : 0, bits);
   memcpy(words, pixel, sizeof words);
   memcpy(old_words, old_pixel, sizeof old_words);
   for (unsigned w = 0; w < DIV_ROUND_UP(desc->block.bits, 32); w++) {
      if ((words[w] ^ old_words[w]) & ~bits[w])
         return false;
   }
   if (!written)
      return true;
   if (desc->format == PIPE_FORMAT_R11G11B10_FLOAT)
      return test->write_mask != 0xf || is_r11g11b10(words[0], rgba);

   unsigned seen = 0;
   for (unsigned c = 0; c < 4; c++) {
      const unsigned s = desc->swizzle[c];

      if (s > PIPE_SWIZZLE_W || seen & (1 << s))
         continue;
      seen |= 1 << s;
      if (!(test->write_mask & (1 << c)))
         continue;

      const uint32_t stored = channel_bits(&desc->channel[s], pixel);
      if (desc->colorspace == UTIL_FORMAT_COLORSPACE_SRGB && c < 3) {
         const int expected = isnan(rgba[c]) ? 0 :
            util_format_linear_float_to_srgb_8unorm(rgba[c]);

         if (abs((int)stored - expected) > 1)
            return false;
      } else if (!is_stored_value(&desc->channel[s], stored, rgba[c])) {
         return false;
      }
   }
   return true;
}


static bool
check_store(const struct format_case *test, func_pointer func)
{
   for (unsigned round = 0; round < ROUNDS; round++) {
      struct group group;
      uint8_t old[MAX_LANES][MAX_BYTES] = { { 0 } };
      alignas(32) float rgba[4][MAX_LANES];
      alignas(32) int32_t mask[MAX_LANES];

      memset(&group, 0, sizeof group);
      for (unsigned lane = 0; lane < test->length; lane++) {
         for (unsigned i = 0; i < test->desc->block.bits / 8; i++)
            old[lane][i] = rand() >> 8;
         copy_pixel(test, &group, lane, old[lane], true);
         for (unsigned c = 0; c < 4; c++)
            rgba[c][lane] = random_component(is_integer(test->desc));
         mask[lane] = rand() % 4 ? -1 : 0;
      }
      ((store_func)func)(rgba[0], mask, &group);

      for (unsigned lane = 0; lane < test->length; lane++) {
         const float fragment[4] = {
            rgba[0][lane], rgba[1][lane], rgba[2][lane], rgba[3][lane]
         };
         uint8_t pixel[MAX_BYTES] = { 0 };

         copy_pixel(test, &group, lane, pixel, false);
         if (!is_stored_pixel(test, old[lane], pixel, fragment, mask[lane]))
            return false;
      }
   }
   return true;
}


static bool
test_format_case(unsigned verbose, FILE *fp, const struct format_case *test)
{
   lp_context_ref context;
   char name[100];

   lp_context_create(&context);
   struct gallivm_state *gallivm =
      gallivm_create("test_module", &context, NULL);
   func_pointer func = compile_format_case(test, gallivm);
   const bool success = test->write_mask ? check_store(test, func) :
                                           check_load(test, func);

   gallivm_destroy(gallivm);
   lp_context_destroy(&context);
   snprintf(name, sizeof name, "%s %s, mask 0x%x, %s, %u lanes",
            test->write_mask ? "store" : "load", test->desc->short_name,
            test->write_mask, test->tile ? "tile" : "buffer", test->length);
   return report(verbose, fp, success, name);
}


/** All of it in one of the two forms, for one format. */
static bool
test_format(unsigned verbose, FILE *fp, enum pipe_format format, bool tile)
{
   static const unsigned write_masks[] = { 0, 0xf, 0x5, 0x8 };
   const struct util_format_description *desc =
      util_format_description(format);
   bool success = true;

   if (!desc || !is_tested(desc))
      return true;

   for (unsigned i = 0; i < ARRAY_SIZE(write_masks); i++) {
      for (unsigned length = 4; length * 32 <= lp_native_vector_width;
           length *= 2) {
         const struct format_case test = { desc, length, write_masks[i], tile };

         /* K-buffer programs do not read integers. */
         if (write_masks[i] || !is_integer(desc))
            success &= test_format_case(verbose, fp, &test);
      }
   }
   return success;
}


/*
 * Insertion.
 */

#define NUM_WORDS 3
#define NUM_LAYERS 11

static const uint32_t moving_bits[NUM_WORDS] = { ~0u, ~0u, 0x00ff00ff };

/** The layers of a group, as in the tile store, and the fragments for them. */
struct insertion
{
   alignas(64) uint32_t layers[NUM_LAYERS][NUM_WORDS][16];
   alignas(64) uint32_t fragment[NUM_WORDS][16];
   alignas(64) int32_t active[16];
   int32_t last;
};

typedef void (*insert_func)(struct insertion *insertion);


static func_pointer
compile_insertion(struct gallivm_state *gallivm, unsigned length, bool equal)
{
   const struct lp_peel_key key = { .insert = true, .equal = equal };
   const int layer_size = NUM_WORDS * LP_TILE_WORD_SIZE;
   LLVMBuilderRef builder = gallivm->builder;
   LLVMValueRef func = add_function(gallivm, "test", 1);
   LLVMValueRef arg = LLVMGetParam(func, 0);
   struct peel_context ctx = {
      .gallivm = gallivm,
      .key = &key,
      .tile.gallivm = gallivm,
      .num_words = NUM_WORDS,
   };
   LLVMValueRef last[MAX_WORDS];

   lp_build_context_init(&ctx.tile.bld, gallivm,
                         lp_type_int_vec(32, 32 * length));
   memcpy(ctx.bits, moving_bits, sizeof moving_bits);
   ctx.layers = lp_build_const_offset(gallivm, arg,
                                      offsetof(struct insertion, layers));
   ctx.last = lp_build_load_int32_at(gallivm, arg,
                                     offsetof(struct insertion, last));
   ctx.last_ptr =
      lp_build_byte_offset(gallivm, ctx.layers,
                           LLVMBuildMul(builder, ctx.last,
                                        lp_build_const_int32(gallivm, layer_size),
                                        ""));
   for (unsigned w = 0; w < NUM_WORDS; w++) {
      last[w] = lp_build_tile_load(&ctx.tile, ctx.last_ptr,
                                   w * LP_TILE_WORD_SIZE);
      ctx.fragment[w] =
         lp_build_tile_load(&ctx.tile, arg,
                            offsetof(struct insertion, fragment) +
                            w * LP_TILE_WORD_SIZE);
   }
   lp_build_peel_insert(&ctx,
                        lp_build_tile_load(&ctx.tile, arg,
                                           offsetof(struct insertion, active)),
                        last);
   return finish_function(gallivm, func, "test");
}


static void
init_insertion(struct insertion *insertion, unsigned length, bool equal)
{
   memset(insertion, 0, sizeof *insertion);
   insertion->last = rand() % NUM_LAYERS;
   for (unsigned lane = 0; lane < length; lane++) {
      int32_t depth = -100;

      /* Few different depths, so that some are equal. */
      for (unsigned layer = 0; layer < NUM_LAYERS; layer++) {
         depth += rand() % 3;
         insertion->layers[layer][0][lane] = depth;
         for (unsigned w = 1; w < NUM_WORDS; w++)
            insertion->layers[layer][w][lane] = rand();
      }
      for (unsigned w = 0; w < NUM_WORDS; w++)
         insertion->fragment[w][lane] = rand();

      const int32_t fragment = -101 + rand() % (2 * NUM_LAYERS);
      const int32_t last = insertion->layers[insertion->last][0][lane];
      insertion->fragment[0][lane] = fragment;
      insertion->active[lane] =
         rand() % 4 && (fragment < last || (equal && fragment == last)) ? -1 : 0;
   }
}


/** Insert a lane's fragment into the layers, one after the other. */
static void
insert_lane(struct insertion *insertion, unsigned lane, bool equal)
{
   const int32_t depth = insertion->fragment[0][lane];
   int place = 0;

   while ((int32_t)insertion->layers[place][0][lane] < depth ||
          (!equal && (int32_t)insertion->layers[place][0][lane] == depth))
      place++;

   for (unsigned w = 0; w < NUM_WORDS; w++) {
      const uint32_t bits = moving_bits[w];

      for (int layer = insertion->last; layer >= place; layer--) {
         const uint32_t moved = layer == place ?
            insertion->fragment[w][lane] :
            insertion->layers[layer - 1][w][lane];
         uint32_t *word = &insertion->layers[layer][w][lane];

         *word = (*word & ~bits) | (moved & bits);
      }
   }
}


static bool
test_insertion(unsigned verbose, FILE *fp, unsigned length, bool equal)
{
   lp_context_ref context;
   bool success = true;
   char name[60];

   lp_context_create(&context);
   struct gallivm_state *gallivm =
      gallivm_create("test_module", &context, NULL);
   insert_func func = (insert_func)compile_insertion(gallivm, length, equal);

   for (unsigned round = 0; round < 100 * ROUNDS; round++) {
      struct insertion insertion, expected;

      init_insertion(&insertion, length, equal);
      expected = insertion;
      for (unsigned lane = 0; lane < length; lane++) {
         if (expected.active[lane])
            insert_lane(&expected, lane, equal);
      }
      func(&insertion);
      success &= !memcmp(&insertion, &expected, sizeof insertion);
   }

   gallivm_destroy(gallivm);
   lp_context_destroy(&context);
   snprintf(name, sizeof name, "insert, %s, %u lanes",
            equal ? "before equal depths" : "behind equal depths", length);
   return report(verbose, fp, success, name);
}


static bool
test_insertions(unsigned verbose, FILE *fp)
{
   bool success = true;

   for (unsigned length = 4; length * 32 <= lp_native_vector_width; length *= 2) {
      success &= test_insertion(verbose, fp, length, false);
      success &= test_insertion(verbose, fp, length, true);
   }
   return success;
}


bool
test_all(unsigned verbose, FILE *fp)
{
   bool success = test_insertions(verbose, fp);

   for (unsigned f = 0; f < PIPE_FORMAT_COUNT; f++) {
      success &= test_format(verbose, fp, f, false);
      success &= test_format(verbose, fp, f, true);
   }
   return success;
}


bool
test_some(unsigned verbose, FILE *fp, unsigned long n)
{
   return test_all(verbose, fp);
}


bool
test_single(unsigned verbose, FILE *fp)
{
   return test_insertions(verbose, fp);
}
