/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_bld_kbuf_fs.h"

#include "compiler/nir/nir.h"
#include "gallivm/lp_bld_const.h"
#include "gallivm/lp_bld_flow.h"
#include "gallivm/lp_bld_init.h"
#include "gallivm/lp_bld_logic.h"
#include "gallivm/lp_bld_struct.h"
#include "util/format/u_format.h"

#include "lp_bld_interp.h"
#include "lp_bld_kbuf.h"
#include "lp_bld_peel.h"
#include "lp_state_fs.h"


/** Load what the shader stored for this group, or sample of it. */
static LLVMValueRef
load_output(struct gallivm_state *gallivm,
            const struct lp_kbuf_fs_results *fs, LLVMValueRef store)
{
   LLVMBuilderRef builder = gallivm->builder;
   LLVMValueRef index = fs->group;

   if (fs->key->min_samples > 1) {
      index = LLVMBuildAdd(builder, index,
                           LLVMBuildMul(builder, fs->sample, fs->num_loop, ""), "");
   }
   return lp_build_pointer_get2(builder, lp_build_vec_type(gallivm, fs->type),
                                store, index);
}


/** The depth that the fragment stage left, before it is clamped. */
static LLVMValueRef
fragment_depth(struct gallivm_state *gallivm,
               const struct lp_kbuf_fs_results *fs)
{
   /* Early tests used the interpolated depth, whatever the shader writes. */
   if (fs->z_out && !fs->nir->info.fs.early_fragment_tests &&
       !fs->nir->info.fs.post_depth_coverage)
      return load_output(gallivm, fs, fs->z_out);

   lp_build_interp_soa_update_pos_dyn(fs->interp, gallivm, fs->group,
                                      fs->key->multisample ? fs->sample : NULL);
   return fs->interp->pos[2];
}


/**
 * Window x, y of the pixel's center and 1/w there; the depth that the
 * fragment stage left, which is the sample's.
 */
static void
fragment_position(struct gallivm_state *gallivm,
                  const struct lp_kbuf_fs_results *fs, LLVMValueRef pos[4])
{
   LLVMBuilderRef builder = gallivm->builder;
   const struct lp_fragment_shader_variant_key *key = fs->key;
   const bool integer = fs->nir->info.fs.pixel_center_integer;

   lp_build_interp_soa_update_pos_dyn(fs->interp, gallivm, fs->group, NULL);
   memcpy(pos, fs->interp->pos, 4 * sizeof pos[0]);

   if (fs->kbuf->program &&
       fs->kbuf->program->nir->info.fs.pixel_center_integer != integer) {
      LLVMValueRef shift = lp_build_const_vec(gallivm, fs->type,
                                              integer ? 0.5 : -0.5);
      pos[0] = LLVMBuildFAdd(builder, pos[0], shift, "");
      pos[1] = LLVMBuildFAdd(builder, pos[1], shift, "");
   }

   pos[2] = lp_build_depth_clamp(gallivm, builder, key->depth_clamp, true,
                                 fs->type, fs->context_type, fs->context_ptr,
                                 fs->thread_data_type, fs->thread_data_ptr,
                                 fragment_depth(gallivm, fs));
}


static void
fragment_colors(struct gallivm_state *gallivm,
                const struct lp_kbuf_fs_results *fs, LLVMValueRef (*colors)[4])
{
   for (unsigned i = 0; i < fs->key->kbuf.num_colors; i++) {
      const bool written =
         fs->nir->info.outputs_written & BITFIELD64_BIT(FRAG_RESULT_DATA0 + i);
      const bool integer =
         util_format_is_pure_integer(fs->key->cbuf_format[i]);

      for (unsigned chan = 0; chan < 4; chan++) {
         if (written &&
             !(chan == 3 && fs->key->blend.alpha_to_one && !integer)) {
            colors[i][chan] = load_output(gallivm, fs, fs->out_color[i][chan]);
         } else if (integer) {
            colors[i][chan] =
               LLVMBuildBitCast(gallivm->builder,
                                lp_build_const_int_vec(gallivm,
                                                       lp_int_type(fs->type),
                                                       chan == 3),
                                lp_build_vec_type(gallivm, fs->type), "");
         } else {
            colors[i][chan] = lp_build_const_vec(gallivm, fs->type, chan == 3);
         }
      }
   }
}


/** Runs a k-buffer program, or peels, once. */
typedef LLVMValueRef
(*stage_func)(struct gallivm_state *gallivm,
              const struct lp_build_kbuf_params *params);


/**
 * Run the stage for a group of fragments, or for one sample of them.
 *
 * A multisample framebuffer that is drawn to without multisampling gets every
 * fragment in all of its samples.
 *
 * \return what the function does, of any of these samples
 */
static LLVMValueRef
run_stage(struct gallivm_state *gallivm, struct lp_build_kbuf_params *params,
          unsigned num_samples, stage_func func)
{
   LLVMBuilderRef builder = gallivm->builder;

   if (params->key->multisample || num_samples == 1)
      return func(gallivm, params);

   LLVMTypeRef mask_type = lp_build_int_vec_type(gallivm, params->type);
   LLVMValueRef alive = lp_build_alloca(gallivm, mask_type, "kbuf_alive");
   struct lp_build_for_loop_state loop;

   LLVMBuildStore(builder, LLVMConstNull(mask_type), alive);
   lp_build_for_loop_begin(&loop, gallivm, lp_build_const_int32(gallivm, 0),
                           LLVMIntULT,
                           lp_build_const_int32(gallivm, num_samples),
                           lp_build_const_int32(gallivm, 1));
   params->sample = loop.counter;
   LLVMValueRef sample_alive = func(gallivm, params);
   LLVMValueRef any = LLVMBuildLoad2(builder, mask_type, alive, "");
   LLVMBuildStore(builder, LLVMBuildOr(builder, any, sample_alive, ""), alive);
   lp_build_for_loop_end(&loop);

   return LLVMBuildLoad2(builder, mask_type, alive, "");
}


/** What is the same for all that stands in the place of blending. */
static struct lp_build_kbuf_params
stage_params(struct gallivm_state *gallivm,
             const struct lp_kbuf_fs_results *fs)
{
   LLVMValueRef function =
      LLVMGetBasicBlockParent(LLVMGetInsertBlock(gallivm->builder));
   struct lp_build_kbuf_params params = {
      .key = fs->key,
      .kbuf = fs->kbuf,
      .type = fs->type,
      .context_type = fs->context_type,
      .context_ptr = fs->context_ptr,
      .resources_type = fs->resources_type,
      .thread_data_type = fs->thread_data_type,
      .thread_data_ptr = fs->thread_data_ptr,
      .group = fs->group,
      /* See generate_fragment(). */
      .x = LLVMGetParam(function, 2),
      .y = LLVMGetParam(function, 3),
      .sample = fs->sample,
      .mask = fs->mask,
      .color_ptr_ptr = fs->color_ptr_ptr,
      .color_stride_ptr = fs->color_stride_ptr,
      .color_sample_stride_ptr = fs->color_sample_stride_ptr,
   };

   fragment_colors(gallivm, fs, params.colors);
   return params;
}


static LLVMValueRef
run_program(struct gallivm_state *gallivm, const struct lp_kbuf_fs_results *fs)
{
   struct lp_build_kbuf_params params = stage_params(gallivm, fs);
   unsigned num_samples = 1;

   fragment_position(gallivm, fs, params.pos);
   for (unsigned i = 0; i < fs->key->nr_cbufs; i++)
      num_samples = MAX2(num_samples, fs->key->cbuf_nr_samples[i]);
   return run_stage(gallivm, &params, num_samples, lp_build_kbuf_stage);
}


/**
 * The depth of a fragment, as lp_build_peel_depth().  Lanes where it is no
 * number are taken out of the mask.
 */
static LLVMValueRef
peel_depth(struct gallivm_state *gallivm,
           const struct lp_fragment_shader_variant_key *key,
           struct lp_type type,
           LLVMTypeRef context_type, LLVMValueRef context_ptr,
           LLVMTypeRef thread_data_type, LLVMValueRef thread_data_ptr,
           LLVMValueRef z, LLVMValueRef *mask)
{
   LLVMBuilderRef builder = gallivm->builder;
   LLVMValueRef number = LLVMBuildFCmp(builder, LLVMRealORD, z, z, "");

   number = LLVMBuildSExt(builder, number, LLVMTypeOf(*mask), "");
   *mask = LLVMBuildAnd(builder, *mask, number, "");
   z = lp_build_depth_clamp(gallivm, builder, key->depth_clamp,
                            key->restrict_depth_values, type,
                            context_type, context_ptr,
                            thread_data_type, thread_data_ptr, z);
   return lp_build_peel_depth(gallivm, key, type, z);
}


static LLVMValueRef
peel(struct gallivm_state *gallivm, const struct lp_kbuf_fs_results *fs)
{
   if (!fs->key->kbuf.peel.insert)
      return LLVMConstNull(LLVMTypeOf(fs->mask));

   struct lp_build_kbuf_params params = stage_params(gallivm, fs);

   params.pos[2] = peel_depth(gallivm, fs->key, fs->type,
                              fs->context_type, fs->context_ptr,
                              fs->thread_data_type, fs->thread_data_ptr,
                              fragment_depth(gallivm, fs), &params.mask);
   return run_stage(gallivm, &params, fs->key->zsbuf_nr_samples,
                    lp_build_peel_stage);
}


LLVMValueRef
lp_build_kbuf_fs(struct gallivm_state *gallivm,
                 const struct lp_kbuf_fs_results *fs)
{
   return fs->key->blend.kbuffer_mode == PIPE_KBUFFER_PEEL ?
      peel(gallivm, fs) : run_program(gallivm, fs);
}


/** Whether any fragment of a group, in any sample, would be inserted. */
static LLVMValueRef
is_group_alive(struct gallivm_state *gallivm,
               const struct lp_kbuf_fs_groups *groups, unsigned group)
{
   LLVMBuilderRef builder = gallivm->builder;
   LLVMValueRef function =
      LLVMGetBasicBlockParent(LLVMGetInsertBlock(builder));
   const struct lp_fragment_shader_variant *variant = groups->variant;
   const struct lp_fragment_shader_variant_key *key = &variant->key;
   /* See generate_fragment(). */
   LLVMValueRef context_ptr = LLVMGetParam(function, 0);
   LLVMValueRef thread_data_ptr = LLVMGetParam(function, 11);
   LLVMValueRef alive = LLVMConstNull(groups->mask_type);
   struct lp_build_context bld;

   for (unsigned s = 0; s < key->coverage_samples; s++) {
      LLVMValueRef index =
         lp_build_const_int32(gallivm, s * groups->num_groups + group);
      struct lp_build_kbuf_params params = {
         .key = key,
         .type = groups->type,
         .thread_data_ptr = thread_data_ptr,
         .group = lp_build_const_int32(gallivm, group),
         .x = LLVMGetParam(function, 2),
         .y = LLVMGetParam(function, 3),
         .sample = lp_build_const_int32(gallivm, s),
         .mask = lp_build_pointer_get2(builder, groups->mask_type,
                                       groups->mask_store, index),
      };

      lp_build_interp_soa_update_pos_dyn(groups->interp, gallivm, params.group,
                                         key->multisample ? params.sample : NULL);
      params.pos[2] =
         peel_depth(gallivm, key, groups->type,
                    variant->jit_context_type, context_ptr,
                    variant->jit_thread_data_type, thread_data_ptr,
                    groups->interp->pos[2], &params.mask);
      alive = LLVMBuildOr(builder, alive,
                          lp_build_peel_cull(gallivm, &params), "");
   }

   lp_build_context_init(&bld, gallivm, lp_int_type(groups->type));
   return lp_build_any_true_range(&bld, bld.type.length, alive);
}


/** The mask of a group becomes empty, in all samples. */
static void
clear_masks(struct gallivm_state *gallivm,
            const struct lp_kbuf_fs_groups *groups, unsigned group)
{
   for (unsigned s = 0; s < groups->variant->key.coverage_samples; s++) {
      lp_build_pointer_set(gallivm->builder, groups->mask_store,
                           lp_build_const_int32(gallivm,
                                                s * groups->num_groups + group),
                           LLVMConstNull(groups->mask_type));
   }
}


/*
 * A fragment's shader can see others of its group: by derivatives, votes and
 * other operations among its lanes, and by the loops that it runs together
 * with them; and it can see which samples of its pixel are covered.  So a
 * group is refused as a whole, or else is shaded with the masks that it came
 * with, and the stage refuses what remains.  That costs little, since all
 * lanes of a group are shaded at once.
 */
void
lp_build_kbuf_fs_cull(struct gallivm_state *gallivm,
                      const struct lp_kbuf_fs_groups *groups)
{
   LLVMBuilderRef builder = gallivm->builder;
   LLVMTypeRef bool_type = LLVMInt1TypeInContext(gallivm->context);
   LLVMValueRef any_alive = LLVMConstNull(bool_type);

   for (unsigned i = 0; i < groups->num_groups; i++) {
      LLVMValueRef alive = is_group_alive(gallivm, groups, i);
      struct lp_build_if_state refused;

      any_alive = LLVMBuildOr(builder, any_alive, alive, "");
      lp_build_if(&refused, gallivm, LLVMBuildNot(builder, alive, ""));
      clear_masks(gallivm, groups, i);
      lp_build_endif(&refused);
   }

   LLVMBasicBlockRef leave = lp_build_insert_new_block(gallivm, "peel_leave");
   LLVMBasicBlockRef stay = lp_build_insert_new_block(gallivm, "peel_stay");
   LLVMBuildCondBr(builder, any_alive, stay, leave);
   LLVMPositionBuilderAtEnd(builder, leave);
   LLVMBuildRetVoid(builder);
   LLVMPositionBuilderAtEnd(builder, stay);
}
