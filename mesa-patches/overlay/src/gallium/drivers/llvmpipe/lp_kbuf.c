/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_kbuf.h"

#include "compiler/nir/nir.h"
#include "compiler/nir/nir_serialize.h"
#include "draw/draw_context.h"
#include "util/blob.h"
#include "util/format/u_format.h"
#include "util/mesa-sha1.h"
#include "util/u_debug.h"
#include "util/u_framebuffer.h"
#include "util/u_memory.h"

#include "lp_context.h"
#include "lp_flush.h"
#include "lp_jit.h"
#include "lp_scene.h"
#include "lp_screen.h"
#include "lp_setup_context.h"
#include "lp_state.h"
#include "lp_state_fs.h"
#include "lp_texture.h"
#include "lp_tile_store.h"


/* Off: always work on the color buffers themselves. */
DEBUG_GET_ONCE_BOOL_OPTION(kbuf_tile, "LP_KBUF_TILE", true)


static void
program_reference(struct lp_kbuf_program **ptr,
                  struct lp_kbuf_program *program)
{
   struct lp_kbuf_program *old = *ptr;

   if (pipe_reference(old ? &old->reference : NULL,
                      program ? &program->reference : NULL)) {
      ralloc_free(old->nir);
      FREE(old);
   }
   *ptr = program;
}


/** Find out what the program reads and writes. */
static void
gather_program_info(struct lp_kbuf_program *program)
{
   nir_shader *nir = program->nir;

   nir_shader_gather_info(nir, nir_shader_get_entrypoint(nir));
   program->num_samplers = MAX2(BITSET_LAST_BIT(nir->info.samplers_used),
                                BITSET_LAST_BIT(nir->info.textures_used));
   assert(program->num_samplers <= PIPE_MAX_SAMPLERS);

   nir_foreach_shader_in_variable(var, nir) {
      if (var->data.location >= VARYING_SLOT_VAR0) {
         program->num_colors = MAX2(program->num_colors,
                                    var->data.location + 1 - VARYING_SLOT_VAR0);
      }
   }
   assert(program->num_colors <= PIPE_MAX_COLOR_BUFS);

   nir_foreach_block(block, nir_shader_get_entrypoint(nir)) {
      nir_foreach_instr(instr, block) {
         if (instr->type != nir_instr_type_intrinsic)
            continue;

         nir_intrinsic_instr *intr = nir_instr_as_intrinsic(instr);
         if (intr->intrinsic == nir_intrinsic_load_kbuffer_mesa ||
             intr->intrinsic == nir_intrinsic_store_kbuffer_mesa) {
            program->num_entries = MAX2(program->num_entries,
                                        nir_intrinsic_base(intr) + 1);
            if (intr->intrinsic == nir_intrinsic_store_kbuffer_mesa)
               program->written |= BITFIELD64_BIT(nir_intrinsic_base(intr));
         }
      }
   }
   assert(program->num_entries <= LP_MAX_KBUF_ENTRIES);
}


/**
 * Have the memory that draws with a program need, whatever the framebuffer:
 * now, where a lack of it can still be told.
 */
static bool
reserve_stores(struct pipe_context *pipe, const struct lp_kbuf_program *program)
{
   struct llvmpipe_screen *screen = llvmpipe_screen(pipe->screen);

   /* The last layer may have more color buffers than the program names. */
   const size_t block_size =
      (program->num_entries + PIPE_MAX_COLOR_BUFS - 1) *
      LP_TILE_COLOR_WORDS * LP_TILE_WORD_SIZE;

   mtx_lock(&screen->rast_mutex);
   const bool reserved = lp_tile_stores_reserve(screen->rast, block_size, 1);
   mtx_unlock(&screen->rast_mutex);
   return reserved;
}


static void *
llvmpipe_create_kbuffer_state(struct pipe_context *pipe,
                              const struct pipe_shader_state *templ)
{
   struct lp_kbuf_program *program = CALLOC_STRUCT(lp_kbuf_program);
   struct blob blob;

   assert(templ->type == PIPE_SHADER_IR_NIR);
   if (!program) {
      ralloc_free(templ->ir.nir);
      return NULL;
   }
   pipe_reference_init(&program->reference, 1);
   program->nir = templ->ir.nir;
   gather_program_info(program);

   blob_init(&blob);
   nir_serialize(&blob, program->nir, true);
   const bool complete = !blob.out_of_memory && reserve_stores(pipe, program);
   _mesa_sha1_compute(blob.data, blob.size, program->sha1);
   blob_finish(&blob);

   /* The hash of an incomplete blob would be that of other programs, too. */
   if (!complete)
      program_reference(&program, NULL);

   return program;
}


static void
llvmpipe_delete_kbuffer_state(struct pipe_context *pipe, void *state)
{
   struct lp_kbuf_program *program = state;

   program_reference(&program, NULL);
}


bool
llvmpipe_set_kbuffer_state(struct pipe_context *pipe,
                           const struct pipe_kbuffer_state *state)
{
   struct llvmpipe_context *lp = llvmpipe_context(pipe);
   struct lp_kbuf_state *kbuf = &lp->kbuf;
   const unsigned num_views = state ? state->num_sampler_views : 0;

   draw_flush(lp->draw);

   program_reference(&kbuf->program, state ? state->program : NULL);
   kbuf->num_color_buffers = state ? state->num_color_buffers : 0;
   if (state)
      kbuf->peel = state->peel;
   else
      memset(&kbuf->peel, 0, sizeof kbuf->peel);

   for (unsigned i = 0; i < MAX2(num_views, kbuf->num_sampler_views); i++) {
      struct pipe_sampler_view *view =
         i < num_views ? state->sampler_views[i] : NULL;

      if (view) {
         llvmpipe_flush_resource(pipe, view->texture, 0, true, false, false,
                                 "k-buffer sampler_view");
      }
      pipe_sampler_view_reference(&kbuf->sampler_views[i], view);
      if (i < num_views)
         kbuf->samplers[i] = state->samplers[i];
   }
   kbuf->num_sampler_views = num_views;

   FREE(kbuf->constants);
   kbuf->constants = NULL;
   kbuf->constants_size = 0;
   if (state && state->constants_size) {
      kbuf->constants = mem_dup(state->constants, state->constants_size);
      if (kbuf->constants)
         kbuf->constants_size = state->constants_size;
      else
         program_reference(&kbuf->program, NULL);
   }

   lp->dirty |= LP_NEW_BLEND;
   return !state || kbuf->program == state->program;
}


void
lp_kbuf_init(struct llvmpipe_context *lp)
{
   lp->pipe.kbuffer.create_program = llvmpipe_create_kbuffer_state;
   lp->pipe.kbuffer.delete_program = llvmpipe_delete_kbuffer_state;
   lp->pipe.kbuffer.set_state = llvmpipe_set_kbuffer_state;
}


void
lp_kbuf_destroy(struct llvmpipe_context *lp)
{
   struct lp_kbuf_state *kbuf = &lp->kbuf;

   program_reference(&kbuf->program, NULL);
   for (unsigned i = 0; i < kbuf->num_sampler_views; i++)
      pipe_sampler_view_reference(&kbuf->sampler_views[i], NULL);
   FREE(kbuf->constants);
}


void
lp_kbuf_static_samplers(const struct lp_kbuf_state *kbuf,
                        struct lp_sampler_static_state *samplers)
{
   const struct shader_info *info = &kbuf->program->nir->info;

   memset(samplers, 0, kbuf->program->num_samplers * sizeof *samplers);
   for (unsigned i = 0; i < kbuf->program->num_samplers; i++) {
      const bool bound = i < kbuf->num_sampler_views;

      if (BITSET_TEST(info->samplers_used, i) && bound) {
         lp_sampler_static_sampler_state(&samplers[i].sampler_state,
                                         &kbuf->samplers[i]);
      }
      if (BITSET_TEST(info->textures_used, i) && bound) {
         lp_sampler_static_texture_state(&samplers[i].texture_state,
                                         kbuf->sampler_views[i]);
      }
   }
}


/** Entries that exist, of those that the program names. */
static unsigned
num_entries(const struct llvmpipe_context *lp)
{
   const struct pipe_framebuffer_state *fb = &lp->framebuffer;
   unsigned layers = LP_MAX_KBUF_ENTRIES;

   for (unsigned i = 0; i < fb->nr_cbufs; i++) {
      const struct pipe_surface *surf = fb->cbufs[i];

      if (surf)
         layers = MIN2(layers, surf->u.tex.last_layer -
                               surf->u.tex.first_layer + 1);
   }
   return MIN2(lp->kbuf.program->num_entries,
               lp->kbuf.num_color_buffers * layers);
}


/**
 * Whether to work in the tile store.  Sample planes, 1D resources, and fragment
 * shaders that read the color buffers are left to the way that works on the
 * color buffers themselves.
 */
static bool
use_tile(const struct llvmpipe_context *lp)
{
   const struct pipe_framebuffer_state *fb = &lp->framebuffer;

   if (!debug_get_option_kbuf_tile() ||
       util_framebuffer_get_num_samples(fb) > 1 ||
       lp->fs->base.ir.nir->info.fs.uses_fbfetch_output ||
       (fb->zsbuf && llvmpipe_resource_is_1d(fb->zsbuf->texture)))
      return false;

   for (unsigned i = 0; i < fb->nr_cbufs; i++) {
      if (fb->cbufs[i] && llvmpipe_resource_is_1d(fb->cbufs[i]->texture))
         return false;
   }
   return true;
}


void
lp_kbuf_make_key(const struct llvmpipe_context *lp,
                 struct lp_fragment_shader_variant_key *key)
{
   const struct lp_kbuf_program *program = lp->kbuf.program;
   struct lp_sampler_static_state samplers[PIPE_MAX_SAMPLERS];
   struct mesa_sha1 sha1;

   /* The stage is there instead of these, so that they make no difference. */
   key->blend.logicop_enable = 0;
   key->blend.logicop_func = 0;
   for (unsigned i = 0; i < PIPE_MAX_COLOR_BUFS; i++) {
      const unsigned colormask = key->blend.rt[i].colormask;

      memset(&key->blend.rt[i], 0, sizeof key->blend.rt[i]);
      key->blend.rt[i].colormask = i < key->nr_cbufs ? colormask : 0;
   }

   lp->setup->dirty |= LP_SETUP_NEW_KBUFFER;
   if (!program)
      return;

   key->kbuf.num_colors = program->num_colors;
   key->kbuf.num_entries = num_entries(lp);
   key->kbuf.tiled = use_tile(lp);

   lp_kbuf_static_samplers(&lp->kbuf, samplers);
   _mesa_sha1_init(&sha1);
   _mesa_sha1_update(&sha1, program->sha1, sizeof program->sha1);
   _mesa_sha1_update(&sha1, &lp->kbuf.num_color_buffers,
                     sizeof lp->kbuf.num_color_buffers);
   _mesa_sha1_update(&sha1, samplers,
                     program->num_samplers * sizeof samplers[0]);
   _mesa_sha1_final(&sha1, key->kbuf.sha1);
}


static void
fill_resources(const struct lp_kbuf_state *kbuf,
               const void *constants,
               struct lp_jit_kbuf_resources *res)
{
   res->constants[0].u = constants;
   res->constants[0].num_elements = kbuf->constants_size / sizeof(uint32_t);

   for (unsigned i = 0; i < kbuf->num_sampler_views; i++) {
      if (kbuf->sampler_views[i])
         lp_jit_texture_from_pipe(&res->textures[i], kbuf->sampler_views[i]);
      lp_jit_sampler_from_pipe(&res->samplers[i], &kbuf->samplers[i]);
   }
}


/**
 * Have the scene keep the textures that fill_resources() has mapped; false if
 * it is full.
 */
static bool
reference_textures(const struct lp_kbuf_state *kbuf, struct lp_scene *scene,
                   bool new_scene)
{
   bool referenced = true;

   for (unsigned i = 0; i < kbuf->num_sampler_views; i++) {
      if (kbuf->sampler_views[i]) {
         struct pipe_resource *texture = kbuf->sampler_views[i]->texture;

         /* The reference keeps a display target mapped, not the resources. */
         referenced &= lp_scene_add_resource_reference(scene, texture,
                                                       new_scene, false);
         llvmpipe_resource_unmap(texture, 0, 0);
      }
   }
   return referenced;
}


bool
lp_kbuf_update_scene(struct lp_setup_context *setup, bool new_scene)
{
   struct llvmpipe_context *lp = llvmpipe_context(setup->pipe);
   const struct lp_kbuf_state *kbuf = &lp->kbuf;
   struct lp_scene *scene = setup->scene;

   setup->dirty |= LP_SETUP_NEW_FS;
   setup->fs.current.kbuf = NULL;

   /* A query can begin a scene before any state is bound. */
   if (!lp->blend || !lp->blend->kbuffer_mode || !kbuf->program)
      return true;

   struct lp_jit_kbuf *stored =
      lp_scene_alloc_aligned(scene, sizeof *stored, LP_MIN_VECTOR_ALIGN);
   if (!stored)
      return false;
   memset(stored, 0, sizeof *stored);

   void *constants = NULL;
   if (kbuf->constants_size) {
      constants = lp_scene_alloc_aligned(scene, kbuf->constants_size,
                                         LP_MIN_VECTOR_ALIGN);
      if (!constants)
         return false;
      memcpy(constants, kbuf->constants, kbuf->constants_size);
   }

   for (unsigned i = 0; i < setup->fb.nr_cbufs; i++) {
      const struct pipe_surface *surf = setup->fb.cbufs[i];

      if (surf && llvmpipe_resource_is_texture(surf->texture)) {
         stored->layer_stride[i] =
            llvmpipe_layer_stride(surf->texture, surf->u.tex.level);
      }
   }

   stored->written = kbuf->program->written;
   lp_tile_layout_init_fb(&stored->layout, false, 1,
                          lp_kbuf_num_layers(num_entries(lp),
                                             kbuf->num_color_buffers),
                          kbuf->num_color_buffers, &setup->fb);

   fill_resources(kbuf, constants, &stored->resources);
   if (!reference_textures(kbuf, scene, new_scene))
      return false;

   scene->uses_tile_store = true;
   setup->fs.current.kbuf = stored;
   return true;
}
