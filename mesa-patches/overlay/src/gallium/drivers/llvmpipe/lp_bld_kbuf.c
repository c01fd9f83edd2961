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
#include "lp_jit.h"
#include "lp_kbuf.h"
#include "lp_kbuf_tile.h"
#include "lp_state_fs.h"
#include "lp_tex_sample.h"


struct kbuf_context
{
   struct lp_build_fs_iface base;
   struct gallivm_state *gallivm;
   const struct lp_build_kbuf_params *params;
   struct lp_build_mask_context mask;
   struct lp_kbuf_pixels pixels[LP_MAX_KBUF_ENTRIES];
};


static LLVMValueRef
byte_offset(struct gallivm_state *gallivm, LLVMValueRef ptr,
            LLVMValueRef offset)
{
   LLVMTypeRef int8_type = LLVMInt8TypeInContext(gallivm->context);

   return LLVMBuildGEP2(gallivm->builder, int8_type, ptr, &offset, 1, "");
}


/**
 * Load a pointer that lies in a structure.  The two in lp_jit_thread_data have
 * no place in its LLVM type because that is in the code of variants without
 * the stage, too.
 */
static LLVMValueRef
load_ptr(struct gallivm_state *gallivm, LLVMValueRef base, size_t offset)
{
   LLVMTypeRef ptr_type =
      LLVMPointerType(LLVMInt8TypeInContext(gallivm->context), 0);

   return LLVMBuildLoad2(gallivm->builder, ptr_type,
                         byte_offset(gallivm, base,
                                     lp_build_const_int32(gallivm, offset)), "");
}


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


/** Have the block copied if no fragment has come to it before. */
static void
load_tile_block(struct gallivm_state *gallivm, LLVMValueRef tile,
                LLVMValueRef block)
{
   LLVMBuilderRef builder = gallivm->builder;
   LLVMTypeRef int8_type = LLVMInt8TypeInContext(gallivm->context);
   LLVMTypeRef arg_types[2] = {
      LLVMPointerType(int8_type, 0), LLVMInt32TypeInContext(gallivm->context)
   };
   LLVMTypeRef func_type =
      LLVMFunctionType(LLVMVoidTypeInContext(gallivm->context), arg_types, 2, 0);
   LLVMValueRef valid =
      byte_offset(gallivm, tile,
                  lp_build_const_int32(gallivm,
                                       offsetof(struct lp_kbuf_tile, valid)));
   struct lp_build_if_state invalid;

   valid = LLVMBuildLoad2(builder, int8_type,
                          byte_offset(gallivm, valid, block), "valid");
   lp_build_if(&invalid, gallivm,
               LLVMBuildICmp(builder, LLVMIntEQ, valid,
                             LLVMConstInt(int8_type, 0, 0), ""));
   {
      LLVMValueRef args[2] = { tile, block };
      LLVMValueRef func = load_ptr(gallivm, tile,
                                   offsetof(struct lp_kbuf_tile, load_block));

      LLVMBuildCall2(builder, func_type, func, args, 2, "");
   }
   lp_build_endif(&invalid);
}


/** The pointers to the group's pixels in the thread's copy of the tile. */
static void
locate_tile_entries(struct kbuf_context *ctx)
{
   const struct lp_build_kbuf_params *params = ctx->params;
   const struct lp_fragment_shader_variant_key *key = params->key;
   struct gallivm_state *gallivm = ctx->gallivm;
   LLVMBuilderRef builder = gallivm->builder;
   const unsigned num_cbufs = params->kbuf->num_color_buffers;
   struct lp_kbuf_layout layout;

   lp_kbuf_layout_init(&layout, key->kbuf.num_entries, num_cbufs,
                       key->cbuf_format, key->nr_cbufs);

   LLVMValueRef tile =
      load_ptr(gallivm, params->thread_data_ptr,
               offsetof(struct lp_jit_thread_data, kbuf_tile));

   /* block = y / 4 % 16 * 16 + x / 4 % 16 */
   LLVMValueRef y = LLVMBuildShl(builder, params->y,
                                 lp_build_const_int32(gallivm, 2), "");
   LLVMValueRef x = LLVMBuildLShr(builder, params->x,
                                  lp_build_const_int32(gallivm, 2), "");
   y = LLVMBuildAnd(builder, y, lp_build_const_int32(gallivm, 0xf0), "");
   x = LLVMBuildAnd(builder, x, lp_build_const_int32(gallivm, 0xf), "");
   STATIC_ASSERT(TILE_SIZE == 64);
   LLVMValueRef block = LLVMBuildOr(builder, y, x, "block");

   load_tile_block(gallivm, tile, block);

   LLVMValueRef words = load_ptr(gallivm, tile,
                                 offsetof(struct lp_kbuf_tile, data));
   LLVMValueRef offset =
      LLVMBuildMul(builder, block,
                   lp_build_const_int32(gallivm,
                                        layout.size * LP_KBUF_WORD_SIZE), "");
   words = byte_offset(gallivm, words, offset);
   offset = LLVMBuildMul(builder, params->group,
                         lp_build_const_int32(gallivm, params->type.length * 4), "");
   words = byte_offset(gallivm, words, offset);

   for (unsigned e = 0; e < key->kbuf.num_entries; e++) {
      struct lp_kbuf_pixels *pixels = &ctx->pixels[e];
      const unsigned cbuf = e % num_cbufs;

      if (cbuf >= key->nr_cbufs || key->cbuf_format[cbuf] == PIPE_FORMAT_NONE)
         continue;

      pixels->gallivm = gallivm;
      pixels->type = params->type;
      pixels->desc = util_format_description(key->cbuf_format[cbuf]);
      pixels->words =
         byte_offset(gallivm, words,
                     lp_build_const_int32(gallivm,
                                          layout.offset[e] * LP_KBUF_WORD_SIZE));
   }
}


/**
 * The pointers to the group's rows in each entry; an entry without a buffer
 * gets none.
 */
static void
locate_entries(struct kbuf_context *ctx, LLVMValueRef jit_kbuf)
{
   const struct lp_build_kbuf_params *params = ctx->params;
   const struct lp_fragment_shader_variant_key *key = params->key;
   struct gallivm_state *gallivm = ctx->gallivm;
   LLVMBuilderRef builder = gallivm->builder;
   LLVMTypeRef int32_type = LLVMInt32TypeInContext(gallivm->context);
   LLVMTypeRef int64_type = LLVMInt64TypeInContext(gallivm->context);
   LLVMTypeRef ptr_type =
      LLVMPointerType(LLVMInt8TypeInContext(gallivm->context), 0);
   const unsigned num_cbufs = params->kbuf->num_color_buffers;

   for (unsigned cbuf = 0; cbuf < MIN2(num_cbufs, key->nr_cbufs); cbuf++) {
      const struct util_format_description *desc =
         util_format_description(key->cbuf_format[cbuf]);
      LLVMValueRef index = lp_build_const_int32(gallivm, cbuf);
      LLVMValueRef group = params->group;
      LLVMValueRef x_offset = NULL;

      if (key->cbuf_format[cbuf] == PIPE_FORMAT_NONE)
         continue;

      LLVMValueRef base = lp_build_pointer_get2(builder, ptr_type,
                                                params->color_ptr_ptr, index);
      LLVMValueRef stride =
         lp_build_pointer_get2(builder, int32_type, params->color_stride_ptr,
                               index);
      LLVMValueRef layer_stride = lp_build_pointer_get2(builder, int64_type,
                                                        jit_kbuf, index);

      /* Two groups of a single quad lie side by side. */
      if (params->type.length == 4) {
         LLVMValueRef one = lp_build_const_int32(gallivm, 1);

         x_offset = LLVMBuildAnd(builder, group, one, "");
         x_offset = LLVMBuildMul(builder, x_offset,
                                 lp_build_const_int32(gallivm, desc->block.bits / 8 * 2),
                                 "");
         group = LLVMBuildLShr(builder, group, one, "");
      }

      LLVMValueRef y_offset =
         LLVMBuildMul(builder, stride,
                      LLVMBuildShl(builder, group,
                                   lp_build_const_int32(gallivm, 1), ""), "");
      base = byte_offset(gallivm, base, y_offset);
      if (x_offset)
         base = byte_offset(gallivm, base, x_offset);

      if (key->cbuf_nr_samples[cbuf] > 1) {
         LLVMValueRef sample_stride =
            lp_build_pointer_get2(builder, int32_type,
                                  params->color_sample_stride_ptr, index);
         base = byte_offset(gallivm, base,
                            LLVMBuildMul(builder, sample_stride,
                                         params->sample, ""));
      }

      for (unsigned e = cbuf; e < key->kbuf.num_entries; e += num_cbufs) {
         struct lp_kbuf_pixels *pixels = &ctx->pixels[e];
         LLVMValueRef layer = LLVMConstInt(int64_type, e / num_cbufs, 0);

         pixels->gallivm = gallivm;
         pixels->type = params->type;
         pixels->desc = desc;
         pixels->rows[0] =
            byte_offset(gallivm, base,
                        LLVMBuildMul(builder, layer_stride, layer, ""));
         if (!key->resource_1d)
            pixels->rows[1] = byte_offset(gallivm, pixels->rows[0], stride);
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
      byte_offset(gallivm, jit_kbuf,
                  lp_build_const_int32(gallivm,
                                       offsetof(struct lp_jit_kbuf, resources)));
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
   LLVMValueRef fpstate = NULL;

   assert(params->type.length == 4 || params->type.length == 8);
   if (!params->kbuf->program)
      return params->mask;

   bool denormals = false;
   for (unsigned i = 0; i < key->nr_cbufs; i++) {
      const struct util_format_description *desc =
         util_format_description(key->cbuf_format[i]);

      denormals |= lp_kbuf_format_needs_denormals(desc);
   }
   if (denormals) {
      fpstate = lp_build_fpstate_get(gallivm);
      lp_build_fpstate_set_denorms_zero(gallivm, false);
   }

   lp_build_mask_begin(&ctx->mask, gallivm, params->type, params->mask);
   lp_build_mask_check(&ctx->mask);

   LLVMValueRef jit_kbuf =
      load_ptr(gallivm, params->thread_data_ptr,
               offsetof(struct lp_jit_thread_data, kbuf));
   if (key->kbuf.tiled)
      locate_tile_entries(ctx);
   else
      locate_entries(ctx, jit_kbuf);
   build_program(ctx, jit_kbuf);

   LLVMValueRef alive = lp_build_mask_end(&ctx->mask);
   if (denormals)
      lp_build_fpstate_set(gallivm, fpstate);

   return alive;
}
