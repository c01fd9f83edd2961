/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_bld_kbuf_channel.h
 * What a channel of a pixel means, of all formats that say so in their
 * descriptions.
 */

#ifndef LP_BLD_KBUF_CHANNEL_H
#define LP_BLD_KBUF_CHANNEL_H

#include "lp_bld_kbuf_format.h"

LLVMValueRef
lp_build_kbuf_decode_channel(const struct lp_kbuf_pixels *pixels,
                             const struct util_format_channel_description *chan,
                             const LLVMValueRef words[4]);

/** The channel's bits, at bit 0 of a word. */
LLVMValueRef
lp_build_kbuf_encode_channel(const struct lp_kbuf_pixels *pixels,
                             const struct util_format_channel_description *chan,
                             LLVMValueRef value);

#endif /* LP_BLD_KBUF_CHANNEL_H */
