/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_bld_kbuf_fs.h
 * From the results of the fragment shader and of the tests to the k-buffer
 * stage.
 */

#ifndef LP_BLD_KBUF_FS_H
#define LP_BLD_KBUF_FS_H

#include "gallivm/lp_bld.h"
#include "gallivm/lp_bld_type.h"

struct gallivm_state;
struct lp_build_interp_soa_context;
struct lp_fragment_shader_variant;
struct lp_fragment_shader_variant_key;
struct lp_kbuf_state;
struct nir_shader;

/** What generate_fs_loop() knows at the end of its loop over groups. */
struct lp_kbuf_fs_results
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

/**
 * Run what stands in the place of blending: a k-buffer program or depth
 * peeling.
 *
 * \return the lanes with a fragment that the program did not discard, or that
 *         was inserted
 */
LLVMValueRef
lp_build_kbuf_fs(struct gallivm_state *gallivm,
                 const struct lp_kbuf_fs_results *fs);

/** The groups of fragments that a fragment function gets. */
struct lp_kbuf_fs_groups
{
   const struct lp_fragment_shader_variant *variant;
   struct lp_build_interp_soa_context *interp;
   struct lp_type type;
   unsigned num_groups;
   LLVMTypeRef mask_type;
   LLVMValueRef mask_store;     /**< of sample, group */
};

/**
 * Before anything else, refuse groups of fragments of which depth peeling would
 * insert none; leave the function if these are all.
 */
void
lp_build_kbuf_fs_cull(struct gallivm_state *gallivm,
                      const struct lp_kbuf_fs_groups *groups);

#endif /* LP_BLD_KBUF_FS_H */
