/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_bld_kbuf_channel.h
 * What is stored of a component in a channel of a pixel, in all formats that
 * describe their channels.
 */

#ifndef LP_BLD_KBUF_CHANNEL_H
#define LP_BLD_KBUF_CHANNEL_H

#include "lp_bld_kbuf_format.h"

/** The channel's bits, at bit 0 of a word. */
LLVMValueRef
lp_build_kbuf_encode_channel(const struct lp_kbuf_pixels *pixels,
                             const struct util_format_channel_description *chan,
                             LLVMValueRef value);

#endif /* LP_BLD_KBUF_CHANNEL_H */
