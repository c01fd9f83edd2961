/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_kbuf_fs_tmp.h
 * The part of lp_state_fs.c that hands the results of the fragment shader and
 * of the tests to the k-buffer stage.  It is included there because it needs
 * that file's static functions.
 */

/** What generate_fs_loop() knows at the end of its loop over groups. */
struct kbuf_fs_results
{
   const struct lp_fragment_shader_variant_key *key;
   const struct lp_kbuf_state *kbuf;
   struct nir_shader *nir;
   struct lp_build_interp_soa_context *interp;
   struct lp_type type;
   LLVMTypeRef context_type;
   LLVMValueRef context_ptr;
   LLVMTypeRef resources_type;
   LLVMTypeRef thread_data_type;
   LLVMValueRef thread_data_ptr;
   LLVMValueRef num_loop;
   LLVMValueRef group;
   LLVMValueRef sample;         /**< if key->multisample */
   LLVMValueRef mask;           /**< after all tests, of the sample */
   LLVMValueRef (*out_color)[4];
   LLVMValueRef z_out;          /**< if the shader writes depth */
   LLVMValueRef color_ptr_ptr;
   LLVMValueRef color_stride_ptr;
   LLVMValueRef color_sample_stride_ptr;
};


/** Load what the shader stored for this group, or sample of it. */
static LLVMValueRef
kbuf_load_output(struct gallivm_state *gallivm,
                 const struct kbuf_fs_results *fs, LLVMValueRef store)
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
kbuf_depth(struct gallivm_state *gallivm, const struct kbuf_fs_results *fs)
{
   /* Early tests used the interpolated depth, whatever the shader writes. */
   if (fs->z_out && !fs->nir->info.fs.early_fragment_tests &&
       !fs->nir->info.fs.post_depth_coverage)
      return kbuf_load_output(gallivm, fs, fs->z_out);

   lp_build_interp_soa_update_pos_dyn(fs->interp, gallivm, fs->group,
                                      fs->key->multisample ? fs->sample : NULL);
   return fs->interp->pos[2];
}


/**
 * Window x, y of the pixel's center and 1/w there; the depth that the
 * fragment stage left, which is the sample's.
 */
static void
kbuf_position(struct gallivm_state *gallivm, const struct kbuf_fs_results *fs,
              LLVMValueRef pos[4])
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
                                 kbuf_depth(gallivm, fs));
}


static void
kbuf_colors(struct gallivm_state *gallivm, const struct kbuf_fs_results *fs,
            LLVMValueRef (*colors)[4])
{
   for (unsigned i = 0; i < fs->key->kbuf.num_colors; i++) {
      /* A second source color goes by the number of the next output. */
      const bool written =
         find_output_by_frag_result(fs->nir, FRAG_RESULT_DATA0 + i) != -1 &&
         !(i > 0 && fs->nir->info.fs.color_is_dual_source);
      const bool integer =
         util_format_is_pure_integer(fs->key->cbuf_format[i]);

      for (unsigned chan = 0; chan < 4; chan++) {
         if (written &&
             !(chan == 3 && fs->key->blend.alpha_to_one && !integer)) {
            colors[i][chan] = kbuf_load_output(gallivm, fs,
                                               fs->out_color[i][chan]);
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


/** Runs the stage once; see generate_kbuf_stage(). */
typedef LLVMValueRef
(*kbuf_stage_func)(struct gallivm_state *gallivm,
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
kbuf_run_stage(struct gallivm_state *gallivm,
               struct lp_build_kbuf_params *params,
               unsigned num_samples, kbuf_stage_func func)
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
kbuf_stage_params(struct gallivm_state *gallivm,
                  const struct kbuf_fs_results *fs)
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

   kbuf_colors(gallivm, fs, params.colors);
   return params;
}


/** \return the lanes with a fragment that the program did not discard */
static LLVMValueRef
generate_kbuf_stage(struct gallivm_state *gallivm,
                    const struct kbuf_fs_results *fs)
{
   struct lp_build_kbuf_params params = kbuf_stage_params(gallivm, fs);
   unsigned num_samples = 1;

   kbuf_position(gallivm, fs, params.pos);
   for (unsigned i = 0; i < fs->key->nr_cbufs; i++)
      num_samples = MAX2(num_samples, fs->key->cbuf_nr_samples[i]);
   return kbuf_run_stage(gallivm, &params, num_samples, lp_build_kbuf_stage);
}
