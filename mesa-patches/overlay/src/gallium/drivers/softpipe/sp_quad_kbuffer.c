/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file sp_quad_kbuffer.c
 * The quad stage that runs a k-buffer program (sp_kbuffer.h) in the place of
 * blending.
 *
 * It works on the attachments themselves and not on the tile cache.  The cache
 * has room for five layers of a tile, so that programs with more would move a
 * tile for each fragment, and it holds floats, in which an entry would keep
 * more precision from one fragment to the next than its format has.
 *
 * The stage consists of two quad stages.  The head comes first in the pipeline
 * because the depth test must already ignore the layer of the primitive; the
 * tail comes last.
 */

#include "sp_context.h"
#include "sp_kbuffer.h"
#include "sp_quad.h"
#include "sp_quad_pipe.h"
#include "sp_state.h"
#include "sp_tex_tile_cache.h"
#include "sp_tile_cache.h"

#include "tgsi/tgsi_exec.h"
#include "util/format/u_format.h"
#include "util/u_math.h"
#include "util/u_memory.h"

/** Where one entry of the quads is and how to get it. */
struct kbuffer_access
{
   uint8_t *map;     /**< pixel 0, 0, or NULL: no such attachment or layer */
   unsigned stride;
   enum pipe_format format;
   unsigned pixel_bytes;
   unsigned reg;

   unsigned writemask;
   /* Set bits are replaced on a write.  Only these: what the program does not
    * write must not change by being unpacked and packed again.
    */
   uint8_t write_bits[SP_MAX_PIXEL_BYTES];
   bool write_all_bits;
};

struct kbuffer_stage
{
   struct quad_stage tail;   /**< base class */
   struct quad_stage head;

   /** Of the present quads; only the first quad of a primitive has it. */
   unsigned viewport_index;

   /** Color output that the program sees as n, -1: the shader has none. */
   int8_t color[PIPE_MAX_COLOR_BUFS];

   struct kbuffer_access reads[SP_MAX_KBUFFER_ENTRIES];
   struct kbuffer_access writes[SP_MAX_KBUFFER_ENTRIES];
};

static inline struct kbuffer_stage *
kbuffer_stage(struct quad_stage *tail)
{
   return container_of(tail, struct kbuffer_stage, tail);
}

void
sp_kbuffer_component_bits(enum pipe_format format, unsigned components,
                          uint8_t bits[SP_MAX_PIXEL_BYTES])
{
   const struct util_format_description *desc =
      util_format_description(format);
   unsigned seen = 0;

   if (format == PIPE_FORMAT_R9G9B9E5_FLOAT) {
      memset(bits, components ? 0xff : 0, SP_MAX_PIXEL_BYTES);
      return;
   }

   memset(bits, 0, SP_MAX_PIXEL_BYTES);

   for (unsigned c = 0; c < 4; c++) {
      const unsigned chan = desc->swizzle[c];

      /* Where components share a channel, the first one is stored. */
      if (chan > PIPE_SWIZZLE_W || seen & (1 << chan))
         continue;
      seen |= 1 << chan;

      if (!(components & (1 << c)))
         continue;

      for (unsigned i = 0; i < desc->channel[chan].size; i++) {
         const unsigned bit = desc->channel[chan].shift + i;
#if UTIL_ARCH_BIG_ENDIAN
         const unsigned byte = desc->block.bits / 8 - 1 - bit / 8;
#else
         const unsigned byte = bit / 8;
#endif
         bits[byte] |= 1 << (bit % 8);
      }
   }
}

static void
setup_access(struct softpipe_context *sp, const struct sp_kbuffer_reg *reg,
             struct kbuffer_access *access)
{
   const unsigned num_cbufs = MAX2(sp->kbuffer.num_color_buffers, 1);
   const unsigned cbuf = reg->entry % num_cbufs;
   const unsigned layer = reg->entry / num_cbufs;

   memset(access, 0, sizeof(*access));
   access->reg = reg->reg;

   if (cbuf >= sp->framebuffer.nr_cbufs || !sp->framebuffer.cbufs[cbuf])
      return;

   struct softpipe_tile_cache *tc = sp->cbuf_cache[cbuf];
   if (layer >= tc->num_maps)
      return;

   const struct pipe_blend_state *blend = sp->blend;
   const unsigned rt = blend->independent_blend_enable ? cbuf : 0;

   access->map = tc->transfer_map[layer];
   access->stride = tc->transfer[layer]->stride;
   access->format = tc->surface->format;
   access->pixel_bytes = util_format_get_blocksize(access->format);
   access->writemask = reg->writemask & blend->rt[rt].colormask;

   sp_kbuffer_component_bits(access->format, access->writemask,
                             access->write_bits);

   access->write_all_bits = true;
   for (unsigned i = 0; i < access->pixel_bytes; i++)
      access->write_all_bits &= access->write_bits[i] == 0xff;
}

static uint8_t *
pixel_address(const struct kbuffer_access *access, unsigned x, unsigned y)
{
   return access->map + (size_t)y * access->stride + x * access->pixel_bytes;
}

/** Unpack an entry of the four fragments; those outside the window are 0. */
static void
fetch_entry(const struct softpipe_context *sp,
            const struct kbuffer_access *access,
            const struct quad_header *quad,
            uint32_t rgba[TGSI_QUAD_SIZE][TGSI_NUM_CHANNELS])
{
   const unsigned x = quad->input.x0;
   const unsigned y = quad->input.y0;
   const unsigned w = MIN2(2, sp->framebuffer.width - x);
   const unsigned h = MIN2(2, sp->framebuffer.height - y);

   if (w < 2 || h < 2 || !access->map)
      memset(rgba, 0, TGSI_QUAD_SIZE * sizeof(rgba[0]));

   if (access->map) {
      util_format_unpack_rgba_rect(access->format, rgba, 2 * sizeof(rgba[0]),
                                   pixel_address(access, x, y),
                                   access->stride, w, h);
   }
}

static void
load_entry(const struct softpipe_context *sp,
           const struct kbuffer_access *access,
           const struct quad_header *quad,
           struct tgsi_exec_vector *input)
{
   uint32_t rgba[TGSI_QUAD_SIZE][TGSI_NUM_CHANNELS];

   fetch_entry(sp, access, quad, rgba);
   for (unsigned c = 0; c < TGSI_NUM_CHANNELS; c++) {
      for (unsigned j = 0; j < TGSI_QUAD_SIZE; j++)
         input->xyzw[c].u[j] = rgba[j][c];
   }
}

static void
store_entry(const struct softpipe_context *sp,
            const struct kbuffer_access *access,
            const struct quad_header *quad, unsigned mask,
            const struct tgsi_exec_vector *output)
{
   uint32_t rgba[TGSI_QUAD_SIZE][TGSI_NUM_CHANNELS];
   uint8_t packed[TGSI_QUAD_SIZE * SP_MAX_PIXEL_BYTES];

   if (!access->map || !access->writemask)
      return;

   /* With one exponent for all, the rest has to be packed again. */
   if (access->format == PIPE_FORMAT_R9G9B9E5_FLOAT)
      fetch_entry(sp, access, quad, rgba);
   else
      memset(rgba, 0, sizeof(rgba));

   u_foreach_bit(c, access->writemask) {
      for (unsigned j = 0; j < TGSI_QUAD_SIZE; j++)
         rgba[j][c] = output->xyzw[c].u[j];
   }

   util_format_write_4(access->format, rgba, 2 * sizeof(rgba[0]),
                       packed, 2 * access->pixel_bytes, 0, 0, 2, 2);

   u_foreach_bit(j, mask) {
      const uint8_t *src = packed + j * access->pixel_bytes;
      uint8_t *dst = pixel_address(access, quad->input.x0 + (j & 1),
                                   quad->input.y0 + (j >> 1));

      if (access->write_all_bits) {
         memcpy(dst, src, access->pixel_bytes);
      } else {
         sp_kbuffer_merge_bits(dst, src, access->write_bits,
                               access->pixel_bytes);
      }
   }
}

void
sp_kbuffer_load_color(const struct softpipe_context *sp,
                      const struct quad_header *quad, int color,
                      struct tgsi_exec_vector *rgba)
{
   if (color < 0) {
      for (unsigned j = 0; j < TGSI_QUAD_SIZE; j++) {
         for (unsigned c = 0; c < TGSI_NUM_CHANNELS; c++)
            rgba->xyzw[c].f[j] = c == 3;
      }
      return;
   }

   for (unsigned c = 0; c < TGSI_NUM_CHANNELS; c++) {
      const float *value = quad->output.color[color][c];

      if (sp->rasterizer->clamp_fragment_color) {
         for (unsigned j = 0; j < TGSI_QUAD_SIZE; j++)
            rgba->xyzw[c].f[j] = SATURATE(value[j]);
      } else {
         memcpy(&rgba->xyzw[c], value, sizeof(rgba->xyzw[c]));
      }
   }
}

/** A value that is linear in window space, at the four fragments. */
static void
eval_pos_coef(const struct quad_header *quad, unsigned chan,
              float value[TGSI_QUAD_SIZE])
{
   const float dadx = quad->posCoef->dadx[chan];
   const float dady = quad->posCoef->dady[chan];
   const float a0 = quad->posCoef->a0[chan] + dadx * quad->input.x0 +
                    dady * quad->input.y0;

   value[0] = a0;
   value[1] = a0 + dadx;
   value[2] = a0 + dady;
   value[3] = a0 + dadx + dady;
}

bool
sp_kbuffer_shader_writes_depth(const struct softpipe_context *sp)
{
   return sp->fs_variant->info.writes_z && !sp->early_depth;
}

void
sp_kbuffer_load_depth(const struct softpipe_context *sp,
                      const struct quad_header *quad, float z[TGSI_QUAD_SIZE])
{
   if (sp_kbuffer_shader_writes_depth(sp))
      memcpy(z, quad->output.depth, sizeof(quad->output.depth));
   else
      eval_pos_coef(quad, 2, z);
}

void
sp_kbuffer_clamp_depth(const struct softpipe_context *sp,
                       unsigned viewport_index, float z[TGSI_QUAD_SIZE])
{
   float min = 0.0f, max = 1.0f;

   if (!sp->rasterizer->depth_clip_near) {
      const struct pipe_viewport_state *vp = &sp->viewports[viewport_index];
      const float near_val = vp->translate[2] - vp->scale[2];
      const float far_val = near_val + vp->scale[2] * 2.0f;

      min = MIN2(near_val, far_val);
      max = MAX2(near_val, far_val);
   }

   /* A NaN stays one: CLAMP would make min of it. */
   for (unsigned j = 0; j < TGSI_QUAD_SIZE; j++) {
      if (!isnan(z[j]))
         z[j] = CLAMP(z[j], min, max);
   }
}

static void
load_position(const struct kbuffer_stage *stage,
              const struct quad_header *quad, struct tgsi_exec_vector *input)
{
   const struct softpipe_context *sp = stage->tail.softpipe;
   const struct sp_kbuffer_program *prog = sp->kbuffer.program;
   const float center = prog->pixel_center_integer ? 0.0f : 0.5f;

   for (unsigned j = 0; j < TGSI_QUAD_SIZE; j++) {
      const unsigned x = quad->input.x0 + (j & 1);
      unsigned y = quad->input.y0 + (j >> 1);

      if (!prog->origin_upper_left)
         y = sp->framebuffer.height - 1 - y;

      input->xyzw[0].f[j] = x + center;
      input->xyzw[1].f[j] = y + center;
   }
   sp_kbuffer_load_depth(sp, quad, input->xyzw[2].f);
   sp_kbuffer_clamp_depth(sp, stage->viewport_index, input->xyzw[2].f);
   eval_pos_coef(quad, 3, input->xyzw[3].f);
}

static void
load_inputs(const struct kbuffer_stage *stage, const struct quad_header *quad)
{
   const struct softpipe_context *sp = stage->tail.softpipe;
   const struct sp_kbuffer_program *prog = sp->kbuffer.program;
   struct tgsi_exec_vector *inputs = sp->kbuffer.machine->Inputs;

   if (prog->position >= 0)
      load_position(stage, quad, &inputs[prog->position]);

   for (unsigned n = 0; n < ARRAY_SIZE(prog->color); n++) {
      if (prog->color[n] >= 0) {
         sp_kbuffer_load_color(sp, quad, stage->color[n],
                               &inputs[prog->color[n]]);
      }
   }

   for (unsigned i = 0; i < prog->num_reads; i++)
      load_entry(sp, &stage->reads[i], quad, &inputs[stage->reads[i].reg]);
}

static void
run_tail(struct quad_stage *qs, struct quad_header *quads[], unsigned nr)
{
   struct kbuffer_stage *stage = kbuffer_stage(qs);
   struct softpipe_context *sp = qs->softpipe;
   const struct sp_kbuffer_program *prog = sp->kbuffer.program;
   struct tgsi_exec_machine *machine = sp->kbuffer.machine;

   if (!prog)
      return;

   for (unsigned q = 0; q < nr; q++) {
      struct quad_header *quad = quads[q];
      const unsigned covered = quad->inout.mask;

      if (!covered)
         continue;

      load_inputs(stage, quad);

      machine->NonHelperMask = covered;
      quad->inout.mask &= tgsi_exec_machine_run(machine, 0);

      /* The depth test has counted them already, but a fragment that the
       * program kills changes nothing.
       */
      if (sp->active_query_count)
         sp->occlusion_count -= util_bitcount(covered & ~quad->inout.mask);

      if (!quad->inout.mask)
         continue;

      for (unsigned i = 0; i < prog->num_writes; i++) {
         store_entry(sp, &stage->writes[i], quad, quad->inout.mask,
                     &machine->Outputs[stage->writes[i].reg]);
      }
   }
}

void
sp_kbuffer_find_colors(const struct softpipe_context *sp,
                       int8_t color[PIPE_MAX_COLOR_BUFS])
{
   const struct tgsi_shader_info *info = &sp->fs_variant->info;

   if (info->properties[TGSI_PROPERTY_FS_COLOR0_WRITES_ALL_CBUFS]) {
      memset(color, 0, PIPE_MAX_COLOR_BUFS);
      return;
   }

   memset(color, -1, PIPE_MAX_COLOR_BUFS);
   for (unsigned i = 0; i < info->num_outputs; i++) {
      const unsigned n = info->output_semantic_index[i];

      /* A second source color goes by the number of the next output. */
      if (info->output_semantic_name[i] == TGSI_SEMANTIC_COLOR &&
          !(n > 0 && sp->fs->has_dual_source))
         color[n] = n;
   }
}

static void
begin_tail(struct quad_stage *qs)
{
   struct kbuffer_stage *stage = kbuffer_stage(qs);
   struct softpipe_context *sp = qs->softpipe;
   const struct sp_kbuffer *kb = &sp->kbuffer;

   if (!kb->program)
      return;

   /* Afterwards no tile is cached and no clear is pending. */
   for (unsigned i = 0; i < sp->framebuffer.nr_cbufs; i++)
      sp_flush_tile_cache(sp->cbuf_cache[i]);

   /* Whoever has changed a texture does not know of these caches. */
   for (unsigned i = 0; i < kb->num_sampler_views; i++) {
      if (kb->tex_cache[i])
         sp_flush_tex_tile_cache(kb->tex_cache[i]);
   }

   for (unsigned i = 0; i < kb->program->num_reads; i++)
      setup_access(sp, &kb->program->reads[i], &stage->reads[i]);
   for (unsigned i = 0; i < kb->program->num_writes; i++)
      setup_access(sp, &kb->program->writes[i], &stage->writes[i]);

   sp_kbuffer_find_colors(sp, stage->color);

   const struct tgsi_exec_consts_info constants = {
      .ptr = kb->constants,
      .size = kb->constants_size,
   };
   tgsi_exec_set_constant_buffers(kb->machine, 1, &constants);
}

static void
destroy_tail(struct quad_stage *qs)
{
   FREE(kbuffer_stage(qs));
}

static void
run_head(struct quad_stage *qs, struct quad_header *quads[], unsigned nr)
{
   struct kbuffer_stage *stage = container_of(qs, struct kbuffer_stage, head);

   quads[0]->input.layer = 0;
   stage->viewport_index = quads[0]->input.viewport_index;

   qs->next->run(qs->next, quads, nr);
}

static void
begin_head(struct quad_stage *qs)
{
   qs->next->begin(qs->next);
}

struct quad_stage *
sp_quad_kbuffer_stage(struct softpipe_context *softpipe)
{
   struct kbuffer_stage *stage = CALLOC_STRUCT(kbuffer_stage);

   if (!stage)
      return NULL;

   stage->tail.softpipe = softpipe;
   stage->tail.begin = begin_tail;
   stage->tail.run = run_tail;
   stage->tail.destroy = destroy_tail;

   stage->head.softpipe = softpipe;
   stage->head.begin = begin_head;
   stage->head.run = run_head;

   return &stage->tail;
}

struct quad_stage *
sp_quad_kbuffer_head(struct quad_stage *tail)
{
   return &kbuffer_stage(tail)->head;
}
