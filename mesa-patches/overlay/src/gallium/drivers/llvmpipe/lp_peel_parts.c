/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_peel_parts.h"

#include "lp_peel_tile.h"
#include "lp_scene.h"


static struct lp_peel_parts *
create_parts(const struct lp_scene *scene)
{
   const unsigned tile_counts =
      LP_PEEL_TILE_BLOCKS * scene->fb_max_samples * LP_PEEL_GROUPS;
   const size_t size = (size_t)scene->tiles_x * scene->tiles_y * tile_counts *
                       sizeof(uint16_t);
   struct lp_peel_parts *parts = malloc(sizeof *parts + size);

   /* Without them the next part is slower, and that is all. */
   if (!parts)
      return NULL;

   pipe_reference_init(&parts->reference, 1);
   parts->tiles_x = scene->tiles_x;
   parts->tile_counts = tile_counts;
   memset(parts->counts, 0xff, size);
   STATIC_ASSERT(LP_PEEL_UNKNOWN_COUNT == 0xffff);
   STATIC_ASSERT(LP_MAX_PEEL_LAYERS < LP_PEEL_UNKNOWN_COUNT);
   return parts;
}


struct lp_peel_parts *
lp_peel_split_scene(struct lp_scene *scene)
{
   struct lp_peel_parts *parts = NULL;

   /* A part that does not peel is run by those who know nothing of counts. */
   if (!scene->peels)
      return NULL;

   if (!scene->peel_parts)
      scene->peel_parts = create_parts(scene);
   lp_peel_parts_reference(&parts, scene->peel_parts);
   return parts;
}


void
lp_peel_continue_scene(struct lp_scene *scene, struct lp_peel_parts *parts)
{
   if (scene)
      lp_peel_parts_reference(&scene->peel_parts, parts);
   lp_peel_parts_reference(&parts, NULL);
}
