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


/** Whether any lane of a mask is set. */
static LLVMValueRef
peel_any_lane(struct gallivm_state *gallivm, struct lp_type type,
              LLVMValueRef mask)
{
   LLVMTypeRef bits_type = LLVMIntTypeInContext(gallivm->context,
                                                type.length * type.width);

   return LLVMBuildICmp(gallivm->builder, LLVMIntNE,
                        LLVMBuildBitCast(gallivm->builder, mask, bits_type, ""),
                        LLVMConstNull(bits_type), "");
}


/** Whether any fragment of a group, in any sample, would be inserted. */
static LLVMValueRef
peel_group_alive(struct gallivm_state *gallivm,
                 const struct lp_fragment_shader_variant *variant,
                 struct lp_build_interp_soa_context *interp,
                 struct lp_type type, unsigned group, unsigned num_groups,
                 LLVMTypeRef mask_type, LLVMValueRef mask_store)
{
   LLVMBuilderRef builder = gallivm->builder;
   LLVMValueRef function =
      LLVMGetBasicBlockParent(LLVMGetInsertBlock(builder));
   const struct lp_fragment_shader_variant_key *key = &variant->key;
   /* See generate_fragment(). */
   LLVMValueRef context_ptr = LLVMGetParam(function, 0);
   LLVMValueRef thread_data_ptr = LLVMGetParam(function, 11);
   LLVMValueRef alive = LLVMConstNull(mask_type);

   for (unsigned s = 0; s < key->coverage_samples; s++) {
      LLVMValueRef index =
         lp_build_const_int32(gallivm, s * num_groups + group);
      struct lp_build_kbuf_params params = {
         .key = key,
         .type = type,
         .thread_data_ptr = thread_data_ptr,
         .group = lp_build_const_int32(gallivm, group),
         .x = LLVMGetParam(function, 2),
         .y = LLVMGetParam(function, 3),
         .sample = lp_build_const_int32(gallivm, s),
         .mask = lp_build_pointer_get2(builder, mask_type, mask_store, index),
      };

      lp_build_interp_soa_update_pos_dyn(interp, gallivm, params.group,
                                         key->multisample ? params.sample : NULL);
      params.pos[2] =
         peel_depth(gallivm, key, type,
                    variant->jit_context_type, context_ptr,
                    variant->jit_thread_data_type, thread_data_ptr,
                    interp->pos[2], &params.mask);
      alive = LLVMBuildOr(builder, alive,
                          lp_build_peel_cull(gallivm, &params), "");
   }
   return peel_any_lane(gallivm, type, alive);
}


/**
 * Before anything else, refuse groups of fragments of which none would be
 * inserted; leave the function if that are all.
 *
 * A fragment's shader can see others of its group: by derivatives, votes and
 * other operations among its lanes, and by the loops that it runs together
 * with them; and it can see which samples of its pixel are covered.  So a
 * group is refused as a whole, or else is shaded with the masks that it came
 * with, and the stage refuses what remains.  That costs little, since all
 * lanes of a group are shaded at once.
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
   LLVMTypeRef bool_type = LLVMInt1TypeInContext(gallivm->context);
   LLVMValueRef any_alive = LLVMConstNull(bool_type);

   for (unsigned i = 0; i < num_groups; i++) {
      LLVMValueRef alive =
         peel_group_alive(gallivm, variant, interp, type, i, num_groups,
                          mask_type, mask_store);
      struct lp_build_if_state refused;

      any_alive = LLVMBuildOr(builder, any_alive, alive, "");
      lp_build_if(&refused, gallivm, LLVMBuildNot(builder, alive, ""));
      for (unsigned s = 0; s < variant->key.coverage_samples; s++) {
         lp_build_pointer_set(builder, mask_store,
                              lp_build_const_int32(gallivm, s * num_groups + i),
                              LLVMConstNull(mask_type));
      }
      lp_build_endif(&refused);
   }

   LLVMBasicBlockRef leave = lp_build_insert_new_block(gallivm, "peel_leave");
   LLVMBasicBlockRef stay = lp_build_insert_new_block(gallivm, "peel_stay");
   LLVMBuildCondBr(builder, any_alive, stay, leave);
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
