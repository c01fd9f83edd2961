/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_peel_rast.h
 * The commands of a bin, in scenes that peel.
 */

#ifndef LP_PEEL_RAST_H
#define LP_PEEL_RAST_H

#include "lp_rast.h"
#include "lp_scene.h"

struct lp_rasterizer_task;

/** \param dispatch  what to do where peeling makes no difference */
void
lp_peel_rasterize_bin(struct lp_rasterizer_task *task,
                      const struct cmd_bin *bin,
                      const lp_rast_cmd_func *dispatch);

#endif /* LP_PEEL_RAST_H */
