/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file sp_kbuffer.c
 * Programs and bound state of the k-buffer stage.
 *
 * The TGSI interpreter knows no k-buffer, but it does not care what an input
 * or an output means either: entry e as it stands becomes one more input of
 * the program, entry e as it shall be an output.  Because these are different
 * registers, a load gives the old value whatever has been stored, as
 * load_kbuffer_mesa demands.
 */

#include "sp_kbuffer.h"
#include "sp_context.h"
#include "sp_screen.h"
#include "sp_tex_sample.h"
#include "sp_tex_tile_cache.h"

#include "draw/draw_context.h"
#include "nir.h"
#include "nir_builder.h"
#include "nir/nir_to_tgsi.h"
#include "tgsi/tgsi_dump.h"
#include "tgsi/tgsi_exec.h"
#include "tgsi/tgsi_parse.h"
#include "util/ralloc.h"
#include "util/u_inlines.h"
#include "util/u_memory.h"

static_assert(1 + PIPE_MAX_COLOR_BUFS + SP_MAX_KBUFFER_ENTRIES <=
              PIPE_MAX_SHADER_INPUTS, "every input has a register");
static_assert(SP_MAX_KBUFFER_ENTRIES <= PIPE_MAX_SHADER_OUTPUTS,
              "every entry has an output register");

struct lower_state
{
   struct sp_kbuffer_program *prog;
   unsigned num_inputs;
   nir_variable *entries[SP_MAX_KBUFFER_ENTRIES];
   uint8_t writemask[SP_MAX_KBUFFER_ENTRIES];
};

static nir_variable *
entry_variable(nir_shader *nir, struct lower_state *state, unsigned entry)
{
   if (!state->entries[entry]) {
      struct sp_kbuffer_program *prog = state->prog;
      nir_variable *var = nir_variable_create(nir, nir_var_shader_in,
                                              glsl_vec4_type(), "kbuffer");

      /* The slot ends up as a TGSI semantic, which only has to be unique. */
      var->data.location = VARYING_SLOT_VAR0 + PIPE_MAX_COLOR_BUFS + entry;
      var->data.driver_location = state->num_inputs++;
      var->data.interpolation = INTERP_MODE_FLAT;

      prog->reads[prog->num_reads++] = (struct sp_kbuffer_reg) {
         .entry = entry,
         .reg = var->data.driver_location,
      };
      state->entries[entry] = var;
   }

   return state->entries[entry];
}

static bool
lower_kbuffer_intrinsic(nir_builder *b, nir_intrinsic_instr *intr, void *data)
{
   struct lower_state *state = data;

   if (intr->intrinsic != nir_intrinsic_load_kbuffer_mesa &&
       intr->intrinsic != nir_intrinsic_store_kbuffer_mesa)
      return false;

   const unsigned entry = nir_intrinsic_base(intr);
   assert(entry < SP_MAX_KBUFFER_ENTRIES);

   b->cursor = nir_before_instr(&intr->instr);

   if (intr->intrinsic == nir_intrinsic_load_kbuffer_mesa) {
      nir_variable *var = entry_variable(b->shader, state, entry);

      nir_def_replace(&intr->def, nir_load_var(b, var));
   } else {
      const unsigned writemask = nir_intrinsic_write_mask(intr);

      nir_store_output(b, intr->src[0].ssa, nir_imm_int(b, 0),
                       .base = entry,
                       .write_mask = writemask,
                       .src_type = nir_type_float32,
                       .io_semantics.location = FRAG_RESULT_DATA0 + entry,
                       .io_semantics.num_slots = 1);
      state->writemask[entry] |= writemask;
      nir_instr_remove(&intr->instr);
   }

   return true;
}

/** Give every input and entry a register of its own, outputs by semantic. */
static void
lower_to_inputs_and_outputs(nir_shader *nir, struct lower_state *state)
{
   struct sp_kbuffer_program *prog = state->prog;

   prog->position = -1;
   memset(prog->color, -1, sizeof(prog->color));

   nir_foreach_shader_in_variable(var, nir) {
      const unsigned reg = state->num_inputs++;

      if (var->data.location == VARYING_SLOT_POS) {
         prog->position = reg;
      } else {
         const unsigned n = var->data.location - VARYING_SLOT_VAR0;

         assert(n < PIPE_MAX_COLOR_BUFS);
         prog->color[n] = reg;
      }
      var->data.driver_location = reg;
      var->data.interpolation = INTERP_MODE_FLAT;
   }

   NIR_PASS_V(nir, nir_shader_intrinsics_pass, lower_kbuffer_intrinsic,
              nir_metadata_control_flow, state);
}

/** nir_to_tgsi numbers output registers as it likes: look them up. */
static void
find_output_registers(struct lower_state *state)
{
   struct sp_kbuffer_program *prog = state->prog;
   struct tgsi_parse_context parse;

   if (tgsi_parse_init(&parse, prog->tokens) != TGSI_PARSE_OK)
      return;

   while (!tgsi_parse_end_of_tokens(&parse)) {
      tgsi_parse_token(&parse);

      const struct tgsi_full_declaration *decl =
         &parse.FullToken.FullDeclaration;

      if (parse.FullToken.Token.Type != TGSI_TOKEN_TYPE_DECLARATION ||
          decl->Declaration.File != TGSI_FILE_OUTPUT)
         continue;

      assert(decl->Semantic.Name == TGSI_SEMANTIC_COLOR);
      prog->writes[prog->num_writes++] = (struct sp_kbuffer_reg) {
         .entry = decl->Semantic.Index,
         .reg = decl->Range.First,
         .writemask = state->writemask[decl->Semantic.Index],
      };
   }

   tgsi_parse_free(&parse);
}

static void *
softpipe_create_kbuffer_state(struct pipe_context *pipe,
                              const struct pipe_shader_state *templ)
{
   struct sp_kbuffer_program *prog = CALLOC_STRUCT(sp_kbuffer_program);
   struct lower_state state = { .prog = prog };
   nir_shader *nir = templ->ir.nir;

   assert(templ->type == PIPE_SHADER_IR_NIR);

   if (!prog) {
      ralloc_free(nir);
      return NULL;
   }

   if (sp_debug & SP_DBG_FS)
      nir_print_shader(nir, stderr);

   prog->origin_upper_left = nir->info.fs.origin_upper_left;
   prog->pixel_center_integer = nir->info.fs.pixel_center_integer;
   lower_to_inputs_and_outputs(nir, &state);

   prog->tokens = nir_to_tgsi(nir, pipe->screen);
   if (!prog->tokens) {
      FREE(prog);
      return NULL;
   }

   if (sp_debug & SP_DBG_FS)
      tgsi_dump(prog->tokens, 0);

   find_output_registers(&state);

   return prog;
}

static void
softpipe_delete_kbuffer_state(struct pipe_context *pipe, void *program)
{
   struct sp_kbuffer_program *prog = program;

   tgsi_free_tokens(prog->tokens);
   FREE(prog);
}

static bool
create_machine(struct sp_kbuffer *kb)
{
   if (!kb->sampler)
      kb->sampler = sp_create_tgsi_sampler();

   /* A fragment machine would overwrite the inputs by interpolation, a vertex
    * machine takes them as they are.  Nothing else differs.
    */
   if (!kb->machine)
      kb->machine = tgsi_exec_machine_create(PIPE_SHADER_VERTEX);

   return kb->sampler && kb->machine;
}

static void
set_program(struct sp_kbuffer *kb, struct sp_kbuffer_program *prog)
{
   if (prog == kb->program)
      return;

   kb->program = prog;
   if (prog) {
      tgsi_exec_machine_bind_shader(kb->machine, prog->tokens,
                                    (struct tgsi_sampler *)kb->sampler,
                                    NULL, NULL);
   }
}

static bool
set_constants(struct sp_kbuffer *kb, const void *constants, unsigned size)
{
   if (size > kb->constants_size) {
      FREE(kb->constants);
      kb->constants = MALLOC(size);
   }
   kb->constants_size = kb->constants ? size : 0;

   if (kb->constants_size < size)
      return false;
   if (size)
      memcpy(kb->constants, constants, size);
   return true;
}

static bool
set_sampler(struct pipe_context *pipe, struct sp_kbuffer *kb, unsigned unit,
            const struct pipe_sampler_state *state)
{
   struct sp_sampler **sampler = &kb->sampler->sp_sampler[unit];

   if (*sampler && !memcmp(&(*sampler)->base, state, sizeof(*state)))
      return true;

   FREE(*sampler);
   *sampler = softpipe_create_sampler_state(pipe, state);
   return *sampler != NULL;
}

static bool
set_sampler_view(struct pipe_context *pipe, struct sp_kbuffer *kb,
                 unsigned unit, struct pipe_sampler_view *view)
{
   struct sp_sampler_view *sview = &kb->sampler->sp_sview[unit];

   if (view && !kb->tex_cache[unit]) {
      kb->tex_cache[unit] = sp_create_tex_tile_cache(pipe);
      if (!kb->tex_cache[unit])
         return false;
   }

   if (kb->tex_cache[unit])
      sp_tex_tile_cache_set_sampler_view(kb->tex_cache[unit], view);

   pipe_sampler_view_reference(&kb->sampler_views[unit], view);

   if (view) {
      memcpy(sview, view, sizeof(*sview));
      sview->compute_lambda =
         softpipe_get_lambda_func(view, PIPE_SHADER_FRAGMENT);
      sview->compute_lambda_from_grad =
         softpipe_get_lambda_from_grad_func(view, PIPE_SHADER_FRAGMENT);
      sview->cache = kb->tex_cache[unit];
   } else {
      memset(sview, 0, sizeof(*sview));
   }
   return true;
}

/** All that a program needs; false if there is no memory. */
static bool
set_resources(struct pipe_context *pipe, struct sp_kbuffer *kb,
              const struct pipe_kbuffer_state *state)
{
   if (!create_machine(kb) ||
       !set_constants(kb, state->constants, state->constants_size))
      return false;

   for (unsigned i = 0; i < state->num_sampler_views; i++) {
      kb->num_sampler_views = MAX2(kb->num_sampler_views, i + 1);
      if (!set_sampler_view(pipe, kb, i, state->sampler_views[i]) ||
          !set_sampler(pipe, kb, i, &state->samplers[i]))
         return false;
   }
   return true;
}

static bool
softpipe_set_kbuffer_state(struct pipe_context *pipe,
                           const struct pipe_kbuffer_state *state)
{
   struct softpipe_context *sp = softpipe_context(pipe);
   struct sp_kbuffer *kb = &sp->kbuffer;

   draw_flush(sp->draw);

   const bool complete = !state->program || set_resources(pipe, kb, state);

   set_program(kb, complete ? state->program : NULL);
   kb->num_color_buffers = state->num_color_buffers;
   kb->peel = state->peel;

   /* An unbound stage must not keep textures alive. */
   const unsigned num_views = kb->program ? state->num_sampler_views : 0;

   for (unsigned i = num_views; i < kb->num_sampler_views; i++)
      set_sampler_view(pipe, kb, i, NULL);
   kb->num_sampler_views = num_views;

   return complete;
}

void
sp_init_kbuffer(struct softpipe_context *sp)
{
   sp->pipe.kbuffer.create_program = softpipe_create_kbuffer_state;
   sp->pipe.kbuffer.delete_program = softpipe_delete_kbuffer_state;
   sp->pipe.kbuffer.set_state = softpipe_set_kbuffer_state;
}

void
sp_destroy_kbuffer(struct softpipe_context *sp)
{
   struct sp_kbuffer *kb = &sp->kbuffer;

   for (unsigned i = 0; i < ARRAY_SIZE(kb->tex_cache); i++) {
      pipe_sampler_view_reference(&kb->sampler_views[i], NULL);
      if (kb->tex_cache[i]) {
         sp_tex_tile_cache_set_sampler_view(kb->tex_cache[i], NULL);
         sp_destroy_tex_tile_cache(kb->tex_cache[i]);
      }
      if (kb->sampler)
         FREE(kb->sampler->sp_sampler[i]);
   }

   FREE(kb->constants);
   FREE(kb->sampler);
   tgsi_exec_machine_destroy(kb->machine);
}
