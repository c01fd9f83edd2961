/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_bld_peel.h
 * Depth peeling in the fragment function.
 */

#ifndef LP_BLD_PEEL_H
#define LP_BLD_PEEL_H

#include "lp_bld_kbuf.h"

/**
 * A depth in the form that layers are compared in.
 *
 * \param z  already clamped
 */
LLVMValueRef
lp_build_peel_depth(struct gallivm_state *gallivm,
                    const struct lp_fragment_shader_variant_key *key,
                    struct lp_type type, LLVMValueRef z);

/*
 * What follows takes such a depth as pos[2] of the parameters, and does not
 * use the rest of the position.
 */

/**
 * Before fragments are shaded: colors are not used.
 *
 * \return the lanes of which the fragment would be inserted as the layers are
 *         now, or has to be counted as one at the bound
 */
LLVMValueRef
lp_build_peel_cull(struct gallivm_state *gallivm,
                   const struct lp_build_kbuf_params *params);

/**
 * Insert the fragments.
 *
 * \return the lanes of which the fragment has been inserted
 */
LLVMValueRef
lp_build_peel_stage(struct gallivm_state *gallivm,
                    const struct lp_build_kbuf_params *params);

#endif /* LP_BLD_PEEL_H */
