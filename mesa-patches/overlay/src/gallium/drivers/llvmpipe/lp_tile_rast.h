/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_tile_rast.h
 * The commands of a bin, in scenes of which some draws keep fragments in the
 * tile store.
 */

#ifndef LP_TILE_RAST_H
#define LP_TILE_RAST_H

#include "lp_rast.h"
#include "lp_scene.h"

struct lp_rasterizer_task;

/** \param dispatch  what to do where the tile store makes no difference */
void
lp_tile_rasterize_bin(struct lp_rasterizer_task *task,
                      const struct cmd_bin *bin,
                      const lp_rast_cmd_func *dispatch);

#endif /* LP_TILE_RAST_H */
