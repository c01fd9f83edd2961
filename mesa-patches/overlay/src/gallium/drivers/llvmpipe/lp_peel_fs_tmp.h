/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_peel_fs_tmp.h
 * The part of lp_state_fs.c that tells depth peeling about fragments; after
 * lp_kbuf_fs_tmp.h.
 */

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


/**
 * Before anything else, take fragments out of the masks that would not be
 * inserted; leave the function if that are all.
 *
 * \param mask_store  of sample, group
 */
static void
generate_peel_cull(struct gallivm_state *gallivm,
                   const struct lp_fragment_shader_variant *variant,
                   struct lp_build_interp_soa_context *interp,
                   struct lp_type type, unsigned num_groups,
                   LLVMTypeRef mask_type, LLVMValueRef mask_store)
{
   LLVMBuilderRef builder = gallivm->builder;
   LLVMValueRef function =
      LLVMGetBasicBlockParent(LLVMGetInsertBlock(builder));
   const struct lp_fragment_shader_variant_key *key = &variant->key;
   /* See generate_fragment(). */
   LLVMValueRef context_ptr = LLVMGetParam(function, 0);
   LLVMValueRef thread_data_ptr = LLVMGetParam(function, 11);
   LLVMValueRef any = LLVMConstNull(mask_type);

   for (unsigned s = 0; s < key->coverage_samples; s++) {
      for (unsigned i = 0; i < num_groups; i++) {
         LLVMValueRef index = lp_build_const_int32(gallivm, s * num_groups + i);
         LLVMValueRef mask = lp_build_pointer_get2(builder, mask_type,
                                                   mask_store, index);
         struct lp_build_kbuf_params params = {
            .key = key,
            .type = type,
            .thread_data_ptr = thread_data_ptr,
            .group = lp_build_const_int32(gallivm, i),
            .x = LLVMGetParam(function, 2),
            .y = LLVMGetParam(function, 3),
            .sample = lp_build_const_int32(gallivm, s),
            .mask = mask,
         };

         lp_build_interp_soa_update_pos_dyn(interp, gallivm, params.group,
                                            key->multisample ? params.sample : NULL);
         params.pos[2] =
            peel_depth(gallivm, key, type,
                       variant->jit_context_type, context_ptr,
                       variant->jit_thread_data_type, thread_data_ptr,
                       interp->pos[2], &params.mask);
         mask = lp_build_peel_cull(gallivm, &params);
         lp_build_pointer_set(builder, mask_store, index, mask);
         any = LLVMBuildOr(builder, any, mask, "");
      }
   }

   LLVMTypeRef bits_type = LLVMIntTypeInContext(gallivm->context,
                                                type.length * type.width);
   LLVMBasicBlockRef leave = lp_build_insert_new_block(gallivm, "peel_leave");
   LLVMBasicBlockRef stay = lp_build_insert_new_block(gallivm, "peel_stay");
   LLVMValueRef alive =
      LLVMBuildICmp(builder, LLVMIntNE,
                    LLVMBuildBitCast(builder, any, bits_type, ""),
                    LLVMConstNull(bits_type), "");
   LLVMBuildCondBr(builder, alive, stay, leave);
   LLVMPositionBuilderAtEnd(builder, leave);
   LLVMBuildRetVoid(builder);
   LLVMPositionBuilderAtEnd(builder, stay);
}


/** \return the lanes of which the fragment was inserted */
static LLVMValueRef
generate_peel_stage(struct gallivm_state *gallivm,
                    const struct kbuf_fs_results *fs)
{
   if (!fs->key->kbuf.peel.insert)
      return LLVMConstNull(LLVMTypeOf(fs->mask));

   struct lp_build_kbuf_params params = kbuf_stage_params(gallivm, fs);

   params.pos[2] = peel_depth(gallivm, fs->key, fs->type,
                              fs->context_type, fs->context_ptr,
                              fs->thread_data_type, fs->thread_data_ptr,
                              kbuf_depth(gallivm, fs), &params.mask);
   return kbuf_run_stage(gallivm, &params, fs->key->zsbuf_nr_samples,
                         lp_build_peel_stage);
}
