/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_tile_pixels.h
 * Blocks of 4x4 pixels from memory to vectors of 32-bit words (lp_tile_store.h)
 * and back.
 */

#ifndef LP_TILE_PIXELS_H
#define LP_TILE_PIXELS_H

#include <stdbool.h>
#include <stdint.h>

void
lp_tile_load_pixels(uint32_t *words, const uint8_t *block, unsigned stride,
                    unsigned bytes);

/** The same with one value, as it lies in memory, in all pixels. */
void
lp_tile_fill_pixels(uint32_t *words, const uint32_t *value, unsigned bytes);

/**
 * \param quads   the first word of each quad; the next ones lie 16 apart
 * \param stream  past the caches, for whole cache lines that are not going to
 *                be read soon; lp_tile_stream_end() has to follow
 */
void
lp_tile_store_pixels(const uint32_t *const quads[4], uint8_t *block,
                     unsigned stride, unsigned bytes, bool stream);

void
lp_tile_stream_end(void);

#endif /* LP_TILE_PIXELS_H */
