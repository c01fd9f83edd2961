/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_bld_kbuf.h
 * The k-buffer stage in the fragment function.
 */

#ifndef LP_BLD_KBUF_H
#define LP_BLD_KBUF_H

#include "gallivm/lp_bld.h"
#include "gallivm/lp_bld_type.h"
#include "pipe/p_state.h"

struct gallivm_state;
struct lp_fragment_shader_variant_key;
struct lp_kbuf_state;

/** One run of the stage: a group of quads, in one sample. */
struct lp_build_kbuf_params
{
   const struct lp_fragment_shader_variant_key *key;
   const struct lp_kbuf_state *kbuf;
   struct lp_type type;       /**< of the values of the fragment shader */

   LLVMTypeRef context_type;
   LLVMValueRef context_ptr;
   LLVMTypeRef resources_type;
   LLVMTypeRef thread_data_type;
   LLVMValueRef thread_data_ptr;

   LLVMValueRef group;        /**< number of the group in its 4x4 block */
   LLVMValueRef x, y;         /**< of the block */
   LLVMValueRef sample;       /**< looked at for multisampled buffers only */
   LLVMValueRef mask;         /**< lanes with a fragment */
   LLVMValueRef pos[4];       /**< of the sample in z, else of the pixel */
   LLVMValueRef colors[PIPE_MAX_COLOR_BUFS][4]; /**< fragment colors */

   LLVMValueRef color_ptr_ptr;
   LLVMValueRef color_stride_ptr;
   LLVMValueRef color_sample_stride_ptr;
};

/**
 * Have denormals kept, which are zeros in raster threads, if the conversions of
 * the color buffers' formats need them.
 *
 * \return what lp_build_fpstate_set() has to get afterwards, or NULL
 */
LLVMValueRef
lp_build_kbuf_begin_denormals(struct gallivm_state *gallivm,
                              const struct lp_fragment_shader_variant_key *key);

/** \return the lanes that the program has not discarded */
LLVMValueRef
lp_build_kbuf_stage(struct gallivm_state *gallivm,
                    const struct lp_build_kbuf_params *params);

#endif /* LP_BLD_KBUF_H */
