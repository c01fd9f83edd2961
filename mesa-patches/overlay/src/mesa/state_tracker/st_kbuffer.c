/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file st_kbuffer.c
 * GL_MESA_kbuffer_program: programs become driver objects when their string
 * is specified, and everything that the stage needs (program, constants,
 * textures) is given to the pipe at once, since nothing else of a draw
 * depends on it.
 *
 * The fragment shader needs no variant for it: neither the linker nor the
 * state tracker drops a color output that no draw buffer takes, and a shader
 * that has the one color output gl_FragColor or result.color, as fixed
 * function has, gives that color to every fragment.color[n].
 */

#include "main/errors.h"
#include "main/kbuffer.h"
#include "main/texobj.h"
#include "main/texstate.h"
#include "program/prog_parameter.h"
#include "program/prog_statevars.h"
#include "program/prog_to_nir.h"

#include "nir.h"
#include "compiler/glsl/gl_nir_linker.h"
#include "pipe/p_context.h"
#include "pipe/p_kbuffer.h"
#include "pipe/p_screen.h"
#include "util/u_inlines.h"
#include "util/u_memory.h"

#include "st_cb_texture.h"
#include "st_context.h"
#include "st_debug.h"
#include "st_kbuffer.h"
#include "st_nir.h"
#include "st_program.h"
#include "st_sampler_view.h"
#include "st_texture.h"

struct st_kbuffer_object
{
   struct pipe_reference reference;
   void *driver;  /**< from pipe_kbuffer_funcs::create_program */
};

static void
reference_object(struct st_context *st, struct st_kbuffer_object **dst,
                 struct st_kbuffer_object *src)
{
   struct st_kbuffer_object *old = *dst;

   if (pipe_reference(old ? &old->reference : NULL,
                      src ? &src->reference : NULL)) {
      st->pipe->kbuffer.delete_program(st->pipe, old->driver);
      FREE(old);
   }
   *dst = src;
}

/**
 * The NIR of a program in the form that drivers get fragment shaders in, see
 * st_create_fp_variant.
 */
static nir_shader *
translate_program(struct st_context *st, struct gl_program *prog)
{
   struct pipe_screen *screen = st->screen;
   nir_shader *nir = prog_to_nir(st->ctx, prog);

   if (!nir)
      return NULL;

   st_prog_to_nir_postprocess(st, nir, prog);

   if (!st->allow_st_finalize_nir_twice)
      st_finalize_nir(st, prog, NULL, nir, false, false);

   if (!(nir->options->io_options & nir_io_has_intrinsics)) {
      NIR_PASS(_, nir, nir_opt_dce);
      NIR_PASS(_, nir, st_nir_unlower_io_to_vars);
      gl_nir_opts(nir);
   }

   nir_shader_gather_info(nir, nir_shader_get_entrypoint(nir));

   if (screen->finalize_nir) {
      char *msg = screen->finalize_nir(screen, nir);
      free(msg);
   }

   nir_index_ssa_defs(nir_shader_get_entrypoint(nir));

   if (ST_DEBUG & DEBUG_PRINT_IR) {
      fprintf(stderr, "NIR of k-buffer program %u:\n", prog->Id);
      nir_print_shader(nir, stderr);
   }

   return nir;
}

void
st_kbuffer_program_notify(struct gl_context *ctx, struct gl_program *prog)
{
   struct st_context *st = st_context(ctx);
   struct pipe_context *pipe = st->pipe;
   struct pipe_shader_state state = { .type = PIPE_SHADER_IR_NIR };

   st_kbuffer_release_object(st, &prog->kbuffer);

   /* The driver takes ownership of the shader. */
   state.ir.nir = translate_program(st, prog);
   void *driver =
      state.ir.nir ? pipe->kbuffer.create_program(pipe, &state) : NULL;

   struct st_kbuffer_object *object =
      driver ? CALLOC_STRUCT(st_kbuffer_object) : NULL;

   if (!object) {
      if (driver)
         pipe->kbuffer.delete_program(pipe, driver);
      _mesa_error(ctx, GL_OUT_OF_MEMORY, "glProgramStringARB");
      return;
   }

   pipe_reference_init(&object->reference, 1);
   object->driver = driver;
   prog->kbuffer = object;

   /* The resources of the fragment shader go by the same bits. */
   prog->affected_states = 0;
   if (prog->Parameters->NumParameters)
      prog->affected_states |= ST_NEW_FS_CONSTANTS;
   if (prog->SamplersUsed)
      prog->affected_states |= ST_NEW_FS_SAMPLER_VIEWS | ST_NEW_FS_SAMPLERS;
}

void
st_kbuffer_release_object(struct st_context *st,
                          struct st_kbuffer_object **object)
{
   reference_object(st, object, NULL);
}

static void
fill_constants(struct st_context *st, const struct gl_program *prog,
               struct pipe_kbuffer_state *state)
{
   struct gl_program_parameter_list *params = prog->Parameters;

   if (params->StateFlags)
      _mesa_load_state_parameters(st->ctx, params);

   state->constants = params->ParameterValues;
   state->constants_size = params->NumParameterValues * sizeof(GLfloat);
}

/**
 * The textures come from the texture units by the program's own targets, not
 * from gl_texture_unit::_Current, which is what the fragment stage samples:
 * the two may sample different targets of one unit.
 */
static bool
fill_textures(struct st_context *st, const struct gl_program *prog,
              struct pipe_kbuffer_state *state)
{
   struct gl_context *ctx = st->ctx;

   state->num_sampler_views = util_last_bit(prog->SamplersUsed);

   u_foreach_bit(unit, prog->SamplersUsed) {
      const struct gl_texture_unit *tex_unit = &ctx->Texture.Unit[unit];

      _mesa_lock_context_textures(ctx);
      struct gl_texture_object *tex =
         _mesa_get_program_texture(ctx, prog, unit);
      _mesa_unlock_context_textures(ctx);

      const struct gl_sampler_object *sampler =
         tex_unit->Sampler ? tex_unit->Sampler : &tex->Sampler;

      if (!st_finalize_texture(ctx, st->pipe, tex, 0) || !tex->pt)
         return false;
      state->sampler_views[unit] =
         st_get_texture_sampler_view_from_stobj(st, tex, sampler,
                                                false, false, false);
      if (!state->sampler_views[unit])
         return false;

      st_convert_sampler(st, tex, sampler, tex_unit->LodBiasQuantized,
                         &state->samplers[unit], ctx->Texture.CubeMapSeamless,
                         false, false);
   }
   return true;
}

void
st_kbuffer_update(struct st_context *st)
{
   struct gl_context *ctx = st->ctx;
   struct st_kbuffer_object *object = st_kbuffer_object(ctx);

   if (!object) {
      st_kbuffer_unbind(st);
      return;
   }

   const struct gl_program *prog = _mesa_kbuffer_program(ctx);
   struct pipe_kbuffer_state state = {
      .program = object->driver,
      .num_color_buffers = ctx->DrawBuffer->_NumColorDrawBuffers,
   };

   fill_constants(st, prog, &state);

   if (fill_textures(st, prog, &state) &&
       st->pipe->kbuffer.set_state(st->pipe, &state)) {
      reference_object(st, &st->kbuffer, object);
   } else {
      /* This draw changes nothing, the next one tries again. */
      st_kbuffer_unbind(st);
      ctx->NewDriverState |= ST_NEW_BLEND;
      _mesa_error(ctx, GL_OUT_OF_MEMORY, "glDraw*");
   }
}

void
st_kbuffer_unbind(struct st_context *st)
{
   const struct pipe_kbuffer_state state = { 0 };

   if (!st->kbuffer)
      return;

   st->pipe->kbuffer.set_state(st->pipe, &state);
   st_kbuffer_release_object(st, &st->kbuffer);
}
