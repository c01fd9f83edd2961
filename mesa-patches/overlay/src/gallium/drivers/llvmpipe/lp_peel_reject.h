/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file lp_peel_reject.h
 * Which triangles lie behind the last layer of a whole tile.
 */

#ifndef LP_PEEL_REJECT_H
#define LP_PEEL_REJECT_H

#include <stdbool.h>

#include "lp_rast.h"

struct lp_tile_store;

/**
 * Whether depth peeling inserts no fragment of a command, and would learn
 * nothing from them.
 */
bool
lp_peel_is_rejected(struct lp_tile_store *store, unsigned cmd,
                    const union lp_rast_cmd_arg arg);

#endif /* LP_PEEL_REJECT_H */
