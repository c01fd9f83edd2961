/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_bld_kbuf.h"

#include "compiler/nir/nir.h"
#include "gallivm/lp_bld_arit.h"
#include "gallivm/lp_bld_const.h"
#include "gallivm/lp_bld_debug.h"
#include "gallivm/lp_bld_flow.h"
#include "gallivm/lp_bld_init.h"
#include "gallivm/lp_bld_nir.h"
#include "gallivm/lp_bld_struct.h"
#include "gallivm/lp_bld_tgsi.h"

#include "lp_bld_kbuf_format.h"
#include "lp_bld_tile.h"
#include "lp_jit.h"
#include "lp_kbuf.h"
#include "lp_state_fs.h"
#include "lp_tex_sample.h"


struct kbuf_context
{
   struct lp_build_fs_iface base;
   struct gallivm_state *gallivm;
   const struct lp_build_kbuf_params *params;
   struct lp_build_mask_context mask;
   struct lp_build_tile tile;
   struct lp_kbuf_pixels pixels[LP_MAX_KBUF_ENTRIES];
};


/** The LLVM type of struct lp_jit_kbuf_resources. */
static LLVMTypeRef
resources_type(struct gallivm_state *gallivm, LLVMTypeRef jit_resources_type)
{
   static const unsigned lengths[LP_JIT_RES_COUNT] = {
      [LP_JIT_RES_CONSTANTS] = 1,
      [LP_JIT_RES_SSBOS] = 1,
      [LP_JIT_RES_TEXTURES] = PIPE_MAX_SAMPLERS,
      [LP_JIT_RES_SAMPLERS] = PIPE_MAX_SAMPLERS,
      [LP_JIT_RES_IMAGES] = 1,
   };
   LLVMTypeRef fields[LP_JIT_RES_COUNT];

   for (unsigned i = 0; i < LP_JIT_RES_COUNT; i++) {
      LLVMTypeRef array = LLVMStructGetTypeAtIndex(jit_resources_type, i);

      fields[i] = LLVMArrayType(LLVMGetElementType(array), lengths[i]);
   }

   LLVMTypeRef type = LLVMStructTypeInContext(gallivm->context, fields,
                                              LP_JIT_RES_COUNT, 0);
   LP_CHECK_MEMBER_OFFSET(struct lp_jit_kbuf_resources, textures,
                          gallivm->target, type, LP_JIT_RES_TEXTURES);
   LP_CHECK_MEMBER_OFFSET(struct lp_jit_kbuf_resources, samplers,
                          gallivm->target, type, LP_JIT_RES_SAMPLERS);
   LP_CHECK_MEMBER_OFFSET(struct lp_jit_kbuf_resources, images,
                          gallivm->target, type, LP_JIT_RES_IMAGES);
   LP_CHECK_STRUCT_SIZE(struct lp_jit_kbuf_resources, gallivm->target, type);
   return type;
}


/**
 * Texture functions are found by name, which tells the units only: keep those
 * of the fragment shader, which has units of its own, from being found.  Those
 * of a program would be found by a second function of the module.
 */
static void
rename_texture_functions(struct gallivm_state *gallivm)
{
   static const char prefix[] = "texfunc_";

   for (LLVMValueRef func = LLVMGetFirstFunction(gallivm->module); func;
        func = LLVMGetNextFunction(func)) {
      size_t len;
      const char *name = LLVMGetValueName2(func, &len);

      assert(strncmp(name, "fs_texfunc_", 11) != 0);
      if (strncmp(name, prefix, sizeof prefix - 1) == 0) {
         char new_name[80];

         snprintf(new_name, sizeof new_name, "fs_%s", name);
         LLVMSetValueName2(func, new_name, strlen(new_name));
      }
   }
}


/** The pixels of an entry of which the place is not known yet. */
static void
init_pixels(struct kbuf_context *ctx, unsigned entry)
{
   const struct lp_build_kbuf_params *params = ctx->params;
   const unsigned cbuf = entry % params->kbuf->num_color_buffers;
   struct lp_kbuf_pixels *pixels = &ctx->pixels[entry];

   pixels->gallivm = ctx->gallivm;
   pixels->type = params->type;
   pixels->desc = util_format_description(params->key->cbuf_format[cbuf]);
}


/** Find the group's pixels of each entry in the tile store. */
static void
locate_in_tile(struct kbuf_context *ctx)
{
   const struct lp_build_kbuf_params *params = ctx->params;
   const struct lp_fragment_shader_variant_key *key = params->key;
   struct gallivm_state *gallivm = ctx->gallivm;
   const unsigned num_cbufs = params->kbuf->num_color_buffers;
   struct lp_tile_layout layout;

   lp_tile_layout_init(&layout, false, 1,
                       lp_kbuf_num_layers(key->kbuf.num_entries, num_cbufs),
                       num_cbufs, key->cbuf_format, key->nr_cbufs);
   lp_build_tile_begin(&ctx->tile, gallivm, params, LP_TILE_ALL);

   LLVMValueRef words =
      lp_build_tile_words(&ctx->tile, params->group,
                          lp_build_const_int32(gallivm,
                                               lp_tile_block_size(&layout)));

   for (unsigned e = 0; e < key->kbuf.num_entries; e++) {
      const unsigned layer = e / num_cbufs, cbuf = e % num_cbufs;

      if (layout.color_words[cbuf]) {
         init_pixels(ctx, e);
         ctx->pixels[e].tile = &ctx->tile;
         ctx->pixels[e].words =
            lp_build_const_offset(gallivm, words,
                                  layer * lp_tile_layer_size(&layout) +
                                  lp_tile_color_word(&layout, cbuf) *
                                  LP_TILE_WORD_SIZE);
      }
   }
}


/** The first pixel of the group in a color buffer, in its first layer. */
static LLVMValueRef
group_in_buffer(struct kbuf_context *ctx, unsigned cbuf, LLVMValueRef stride)
{
   const struct lp_build_kbuf_params *params = ctx->params;
   const struct lp_fragment_shader_variant_key *key = params->key;
   struct gallivm_state *gallivm = ctx->gallivm;
   LLVMBuilderRef builder = gallivm->builder;
   LLVMTypeRef int32_type = LLVMInt32TypeInContext(gallivm->context);
   LLVMTypeRef ptr_type =
      LLVMPointerType(LLVMInt8TypeInContext(gallivm->context), 0);
   LLVMValueRef index = lp_build_const_int32(gallivm, cbuf);
   LLVMValueRef one = lp_build_const_int32(gallivm, 1);
   LLVMValueRef row = params->group;
   LLVMValueRef ptr = lp_build_pointer_get2(builder, ptr_type,
                                            params->color_ptr_ptr, index);

   /* Two groups of a single quad lie side by side. */
   if (params->type.length == 4) {
      const unsigned bits = util_format_get_blocksizebits(key->cbuf_format[cbuf]);
      LLVMValueRef column = LLVMBuildAnd(builder, row, one, "");

      row = LLVMBuildLShr(builder, row, one, "");
      ptr = lp_build_byte_offset(gallivm, ptr,
                                 LLVMBuildMul(builder, column,
                                              lp_build_const_int32(gallivm, bits / 8 * 2),
                                              ""));
   }
   ptr = lp_build_byte_offset(gallivm, ptr,
                              LLVMBuildMul(builder, stride,
                                           LLVMBuildShl(builder, row, one, ""),
                                           ""));

   if (key->cbuf_nr_samples[cbuf] > 1) {
      LLVMValueRef sample_stride =
         lp_build_pointer_get2(builder, int32_type,
                               params->color_sample_stride_ptr, index);

      ptr = lp_build_byte_offset(gallivm, ptr,
                                 LLVMBuildMul(builder, sample_stride,
                                              params->sample, ""));
   }
   return ptr;
}


/**
 * Find the group's rows of each entry in the color buffers; an entry without a
 * buffer gets none.
 */
static void
locate_in_buffers(struct kbuf_context *ctx, LLVMValueRef jit_kbuf)
{
   const struct lp_build_kbuf_params *params = ctx->params;
   const struct lp_fragment_shader_variant_key *key = params->key;
   struct gallivm_state *gallivm = ctx->gallivm;
   LLVMBuilderRef builder = gallivm->builder;
   LLVMTypeRef int32_type = LLVMInt32TypeInContext(gallivm->context);
   LLVMTypeRef int64_type = LLVMInt64TypeInContext(gallivm->context);
   const unsigned num_cbufs = params->kbuf->num_color_buffers;

   for (unsigned cbuf = 0; cbuf < MIN2(num_cbufs, key->nr_cbufs); cbuf++) {
      LLVMValueRef index = lp_build_const_int32(gallivm, cbuf);

      if (key->cbuf_format[cbuf] == PIPE_FORMAT_NONE)
         continue;

      LLVMValueRef stride =
         lp_build_pointer_get2(builder, int32_type, params->color_stride_ptr,
                               index);
      LLVMValueRef layer_stride = lp_build_pointer_get2(builder, int64_type,
                                                        jit_kbuf, index);
      LLVMValueRef first = group_in_buffer(ctx, cbuf, stride);

      for (unsigned e = cbuf; e < key->kbuf.num_entries; e += num_cbufs) {
         LLVMValueRef layer = LLVMConstInt(int64_type, e / num_cbufs, 0);
         struct lp_kbuf_pixels *pixels = &ctx->pixels[e];

         init_pixels(ctx, e);
         pixels->rows[0] =
            lp_build_byte_offset(gallivm, first,
                                 LLVMBuildMul(builder, layer_stride, layer, ""));
         if (!key->resource_1d) {
            pixels->rows[1] = lp_build_byte_offset(gallivm, pixels->rows[0],
                                                   stride);
         }
      }
   }
}


static void
load_entry(const struct lp_build_fs_iface *iface, unsigned entry,
           LLVMValueRef result[4])
{
   const struct kbuf_context *ctx = (const struct kbuf_context *)iface;

   if (ctx->pixels[entry].desc) {
      lp_build_kbuf_load(&ctx->pixels[entry], result);
   } else {
      for (unsigned chan = 0; chan < 4; chan++)
         result[chan] = lp_build_zero(ctx->gallivm, ctx->params->type);
   }
}


static void
store_entry(const struct lp_build_fs_iface *iface, unsigned entry,
            unsigned write_mask, const LLVMValueRef value[4])
{
   struct kbuf_context *ctx = (struct kbuf_context *)iface;

   if (ctx->pixels[entry].desc) {
      const unsigned cbuf = entry % ctx->params->kbuf->num_color_buffers;

      lp_build_kbuf_store(&ctx->pixels[entry], lp_build_mask_value(&ctx->mask),
                          write_mask & ctx->params->key->blend.rt[cbuf].colormask,
                          value);
   }
}


/**
 * Store each entry as soon as its value is there, every load of it is done and
 * nothing can discard the fragment any more, so that few values live at a
 * time.
 */
static void
hoist_stores(nir_function_impl *impl)
{
   nir_block *block = nir_start_block(impl);
   nir_instr *last_load[LP_MAX_KBUF_ENTRIES] = { NULL };
   nir_instr *last_discard = NULL;

   if (block != nir_impl_last_block(impl))
      return;

   nir_foreach_instr(instr, block) {
      if (instr->type != nir_instr_type_intrinsic)
         continue;

      nir_intrinsic_instr *intr = nir_instr_as_intrinsic(instr);
      switch (intr->intrinsic) {
      case nir_intrinsic_load_kbuffer_mesa:
         last_load[nir_intrinsic_base(intr)] = instr;
         break;
      case nir_intrinsic_terminate:
      case nir_intrinsic_terminate_if:
         last_discard = instr;
         break;
      default:
         break;
      }
   }

   nir_index_instrs(impl);
   nir_foreach_instr_safe(instr, block) {
      if (instr->type != nir_instr_type_intrinsic)
         continue;

      nir_intrinsic_instr *intr = nir_instr_as_intrinsic(instr);
      if (intr->intrinsic != nir_intrinsic_store_kbuffer_mesa)
         continue;

      nir_instr *after = intr->src[0].ssa->parent_instr;
      nir_instr *load = last_load[nir_intrinsic_base(intr)];
      if (load && load->index > after->index)
         after = load;
      if (last_discard && last_discard->index > after->index)
         after = last_discard;
      nir_instr_move(nir_after_instr(after), instr);
   }
}


static void
build_program(struct kbuf_context *ctx, LLVMValueRef jit_kbuf)
{
   const struct lp_build_kbuf_params *params = ctx->params;
   const struct lp_kbuf_program *program = params->kbuf->program;
   struct gallivm_state *gallivm = ctx->gallivm;
   struct lp_sampler_static_state static_samplers[PIPE_MAX_SAMPLERS];
   LLVMValueRef inputs[PIPE_MAX_SHADER_INPUTS][4] = { { NULL } };
   LLVMValueRef outputs[PIPE_MAX_SHADER_OUTPUTS][4] = { { NULL } };

   /* The passes before code generation work in place. */
   nir_shader *nir = nir_shader_clone(NULL, program->nir);
   hoist_stores(nir_shader_get_entrypoint(nir));

   nir_foreach_shader_in_variable(var, nir) {
      const LLVMValueRef *value =
         var->data.location == VARYING_SLOT_POS ? params->pos :
         params->colors[var->data.location - VARYING_SLOT_VAR0];

      memcpy(inputs[var->data.driver_location], value, sizeof inputs[0]);
   }

   lp_kbuf_static_samplers(params->kbuf, static_samplers);
   struct lp_build_sampler_soa *sampler =
      lp_llvm_sampler_soa_create(static_samplers, program->num_samplers);
   if (program->num_samplers)
      rename_texture_functions(gallivm);

   struct lp_bld_tgsi_system_values system_values;
   memset(&system_values, 0, sizeof system_values);

   struct lp_build_tgsi_params nir_params;
   memset(&nir_params, 0, sizeof nir_params);
   nir_params.type = params->type;
   nir_params.mask = &ctx->mask;
   nir_params.fs_iface = &ctx->base;
   nir_params.system_values = &system_values;
   nir_params.inputs = (const LLVMValueRef (*)[4])inputs;
   nir_params.num_inputs = nir->num_inputs;
   nir_params.context_type = params->context_type;
   nir_params.context_ptr = params->context_ptr;
   nir_params.resources_type = resources_type(gallivm, params->resources_type);
   nir_params.resources_ptr =
      lp_build_const_offset(gallivm, jit_kbuf,
                            offsetof(struct lp_jit_kbuf, resources));
   nir_params.consts_ptr =
      lp_jit_resources_constants(gallivm, nir_params.resources_type,
                                 nir_params.resources_ptr);
   nir_params.thread_data_type = params->thread_data_type;
   nir_params.thread_data_ptr = params->thread_data_ptr;
   nir_params.sampler = sampler;

   lp_build_nir_soa(gallivm, nir, &nir_params, outputs);

   lp_bld_llvm_sampler_soa_destroy(sampler);
   ralloc_free(nir);
}


LLVMValueRef
lp_build_kbuf_begin_denormals(struct gallivm_state *gallivm,
                              const struct lp_fragment_shader_variant_key *key)
{
   bool needed = false;

   for (unsigned i = 0; i < key->nr_cbufs; i++) {
      const struct util_format_description *desc =
         util_format_description(key->cbuf_format[i]);

      needed |= lp_kbuf_format_needs_denormals(desc);
   }
   if (!needed)
      return NULL;

   LLVMValueRef fpstate = lp_build_fpstate_get(gallivm);
   lp_build_fpstate_set_denorms_zero(gallivm, false);
   return fpstate;
}


LLVMValueRef
lp_build_kbuf_stage(struct gallivm_state *gallivm,
                    const struct lp_build_kbuf_params *params)
{
   const struct lp_fragment_shader_variant_key *key = params->key;
   struct kbuf_context context = {
      .base = {
         .load_kbuffer = load_entry,
         .store_kbuffer = store_entry,
         .exit_on_discard = true,
      },
      .gallivm = gallivm,
      .params = params,
   };
   struct kbuf_context *ctx = &context;

   assert(params->type.length == 4 || params->type.length == 8);
   if (!params->kbuf->program)
      return params->mask;

   LLVMValueRef fpstate = lp_build_kbuf_begin_denormals(gallivm, key);

   lp_build_mask_begin(&ctx->mask, gallivm, params->type, params->mask);
   lp_build_mask_check(&ctx->mask);

   LLVMValueRef store =
      lp_build_tile_store_ptr(gallivm, params->thread_data_ptr);
   LLVMValueRef jit_kbuf =
      lp_build_load_ptr_at(gallivm, store,
                           offsetof(struct lp_tile_store, kbuf));
   if (key->kbuf.tiled)
      locate_in_tile(ctx);
   else
      locate_in_buffers(ctx, jit_kbuf);
   build_program(ctx, jit_kbuf);

   LLVMValueRef alive = lp_build_mask_end(&ctx->mask);
   if (fpstate)
      lp_build_fpstate_set(gallivm, fpstate);

   return alive;
}
