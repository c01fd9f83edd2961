/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_layer_counts.h"

#include "lp_scene.h"
#include "lp_tile_store.h"


static struct lp_layer_counts *
create_counts(const struct lp_scene *scene)
{
   const unsigned tile_counts =
      LP_TILE_BLOCKS * scene->fb_max_samples * LP_TILE_GROUPS;
   const size_t size = (size_t)scene->tiles_x * scene->tiles_y * tile_counts *
                       sizeof(uint16_t);
   struct lp_layer_counts *counts = malloc(sizeof *counts + size);

   /* Without them the next scene is slower, and that is all. */
   if (!counts)
      return NULL;

   pipe_reference_init(&counts->reference, 1);
   counts->tiles_x = scene->tiles_x;
   counts->tile_counts = tile_counts;
   memset(counts->counts, 0xff, size);
   STATIC_ASSERT(LP_UNKNOWN_COUNT == 0xffff);
   STATIC_ASSERT(LP_MAX_PEEL_LAYERS < LP_UNKNOWN_COUNT);
   return counts;
}


struct lp_layer_counts *
lp_layer_counts_split(struct lp_scene *scene)
{
   struct lp_layer_counts *counts = NULL;

   /* Bins of a scene that does not peel change layers without counting. */
   if (!scene->peels)
      return NULL;

   if (!scene->layer_counts)
      scene->layer_counts = create_counts(scene);
   lp_layer_counts_reference(&counts, scene->layer_counts);
   return counts;
}


void
lp_layer_counts_continue(struct lp_scene *scene,
                         struct lp_layer_counts *counts)
{
   if (scene)
      lp_layer_counts_reference(&scene->layer_counts, counts);
   lp_layer_counts_reference(&counts, NULL);
}
