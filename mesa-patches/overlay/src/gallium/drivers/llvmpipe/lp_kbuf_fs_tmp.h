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

   /* Early tests used the interpolated depth, whatever the shader writes. */
   if (fs->z_out && !fs->nir->info.fs.early_fragment_tests &&
       !fs->nir->info.fs.post_depth_coverage) {
      pos[2] = kbuf_load_output(gallivm, fs, fs->z_out);
   } else if (key->multisample) {
      lp_build_interp_soa_update_pos_dyn(fs->interp, gallivm, fs->group,
                                         fs->sample);
      pos[2] = fs->interp->pos[2];
   }
   pos[2] = lp_build_depth_clamp(gallivm, builder, key->depth_clamp, true,
                                 fs->type, fs->context_type, fs->context_ptr,
                                 fs->thread_data_type, fs->thread_data_ptr,
                                 pos[2]);
}


static void
kbuf_colors(struct gallivm_state *gallivm, const struct kbuf_fs_results *fs,
            LLVMValueRef (*colors)[4])
{
   for (unsigned i = 0; i < fs->key->kbuf.num_colors; i++) {
      const bool written =
         find_output_by_frag_result(fs->nir, FRAG_RESULT_DATA0 + i) != -1;

      for (unsigned chan = 0; chan < 4; chan++) {
         if (written && !(chan == 3 && fs->key->blend.alpha_to_one)) {
            colors[i][chan] = kbuf_load_output(gallivm, fs,
                                               fs->out_color[i][chan]);
         } else {
            colors[i][chan] = lp_build_const_vec(gallivm, fs->type, chan == 3);
         }
      }
   }
}


/**
 * Run the stage for a group of fragments, or for one sample of them.
 *
 * A multisample framebuffer that is drawn to without multisampling gets every
 * fragment in all of its samples.
 *
 * \return the lanes with a fragment that the program did not discard, in any
 *         of these samples
 */
static LLVMValueRef
generate_kbuf_stage(struct gallivm_state *gallivm,
                    const struct kbuf_fs_results *fs)
{
   LLVMBuilderRef builder = gallivm->builder;
   LLVMValueRef function =
      LLVMGetBasicBlockParent(LLVMGetInsertBlock(builder));
   const struct lp_fragment_shader_variant_key *key = fs->key;
   struct lp_build_kbuf_params params = {
      .key = key,
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
   unsigned num_samples = 1;

   kbuf_position(gallivm, fs, params.pos);
   kbuf_colors(gallivm, fs, params.colors);

   for (unsigned i = 0; i < key->nr_cbufs; i++)
      num_samples = MAX2(num_samples, key->cbuf_nr_samples[i]);
   if (key->multisample || num_samples == 1)
      return lp_build_kbuf_stage(gallivm, &params);

   LLVMTypeRef mask_type = lp_build_int_vec_type(gallivm, fs->type);
   LLVMValueRef alive = lp_build_alloca(gallivm, mask_type, "kbuf_alive");
   struct lp_build_for_loop_state loop;

   LLVMBuildStore(builder, LLVMConstNull(mask_type), alive);
   lp_build_for_loop_begin(&loop, gallivm, lp_build_const_int32(gallivm, 0),
                           LLVMIntULT,
                           lp_build_const_int32(gallivm, num_samples),
                           lp_build_const_int32(gallivm, 1));
   params.sample = loop.counter;
   LLVMValueRef sample_alive = lp_build_kbuf_stage(gallivm, &params);
   LLVMValueRef any = LLVMBuildLoad2(builder, mask_type, alive, "");
   LLVMBuildStore(builder, LLVMBuildOr(builder, any, sample_alive, ""), alive);
   lp_build_for_loop_end(&loop);

   return LLVMBuildLoad2(builder, mask_type, alive, "");
}
