/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file st_peel.c
 * GL_MESA_depth_peeling: the driver's objects for framebuffers, and the state
 * of draws that peel.  It goes to the pipe with the blend state, because that
 * is what turns the k-buffer stage on.
 */

#include "main/context.h"
#include "main/depth_peeling_validate.h"
#include "main/errors.h"
#include "main/renderbuffer.h"

#include "pipe/p_context.h"
#include "pipe/p_kbuffer.h"
#include "util/simple_mtx.h"
#include "util/u_memory.h"

#include "st_cb_bitmap.h"
#include "st_context.h"
#include "st_kbuffer.h"
#include "st_peel.h"

struct st_peel_object
{
   struct st_peel_object *next;   /**< in st_context::peel_objects */
   struct st_context *st;         /**< the owner */
   struct gl_framebuffer *fb;     /**< NULL: deleted by another context */
   void *driver;                  /**< from pipe_kbuffer_funcs::create_peel_object */
};

/** Protects the links between framebuffers and objects in both directions. */
static simple_mtx_t link_mutex = SIMPLE_MTX_INITIALIZER;

static void
take_state_back(struct st_context *st)
{
   const struct pipe_kbuffer_state state = { 0 };

   if (st->peel)
      st->pipe->kbuffer.set_state(st->pipe, &state);
   st->peel = NULL;
}

/** Delete an object that is out of its context's list. */
static void
delete_object(struct st_peel_object *object)
{
   struct st_context *st = object->st;

   if (st->peel == object) {
      take_state_back(st);
      st->ctx->NewDriverState |= ST_NEW_BLEND;
   }

   st->pipe->kbuffer.delete_peel_object(st->pipe, object->driver);
   FREE(object);
}

/** Delete the objects of framebuffers that other contexts have deleted. */
static void
delete_orphans(struct st_context *st)
{
   struct st_peel_object **link = &st->peel_objects;

   while (*link) {
      struct st_peel_object *object = *link;

      simple_mtx_lock(&link_mutex);
      const bool is_orphan = !object->fb;
      simple_mtx_unlock(&link_mutex);

      if (is_orphan) {
         *link = object->next;
         delete_object(object);
      } else {
         link = &object->next;
      }
   }
}

/** Link a framebuffer with its object, or with none; the mutex is held. */
static void
set_object(struct gl_framebuffer *fb, struct st_peel_object *object)
{
   fb->Peeling.Object = object;
   p_atomic_set(&fb->Peeling.Owner, object ? object->st : NULL);
}

/**
 * Give a framebuffer an object if it has none, in a context that may own it.
 *
 * \return false if there is no memory
 */
static bool
create_object(struct gl_context *ctx, struct gl_framebuffer *fb)
{
   struct st_context *st = ctx->st;

   if (fb->Peeling.Object)
      return true;

   struct st_peel_object *object = CALLOC_STRUCT(st_peel_object);

   if (!object)
      return false;

   object->driver = st->pipe->kbuffer.create_peel_object(st->pipe);
   if (!object->driver) {
      FREE(object);
      return false;
   }

   delete_orphans(st);

   object->st = st;
   object->next = st->peel_objects;
   st->peel_objects = object;

   simple_mtx_lock(&link_mutex);
   object->fb = fb;
   set_object(fb, object);
   simple_mtx_unlock(&link_mutex);

   return true;
}

/** The driver's words for a GL depth function. */
static enum pipe_compare_func
compare_func(GLenum func)
{
   return func - GL_NEVER;
}

void
st_peel_start_over(struct gl_context *ctx, struct gl_framebuffer *fb)
{
   struct pipe_context *pipe = ctx->pipe;

   if (_mesa_is_peeled_elsewhere(ctx, fb)) {
      st_peel_release_object(fb);
   } else if (fb->Peeling.Object) {
      /* Needs no memory. */
      pipe->kbuffer.advance_peel_object(pipe, fb->Peeling.Object->driver, NULL,
                                PIPE_FUNC_LESS, ctx->Depth.Clear);
   }
}

bool
st_peel_continue(struct gl_context *ctx, struct gl_framebuffer *fb,
                 const struct gl_peel_order *order)
{
   struct pipe_context *pipe = ctx->pipe;
   struct gl_renderbuffer *rb = fb->Attachment[BUFFER_DEPTH].Renderbuffer;

   if (!create_object(ctx, fb))
      return false;

   /* No draw is valid before the framebuffer starts over. */
   if (!_mesa_can_continue_peeling(order)) {
      st_peel_start_over(ctx, fb);
      return true;
   }

   st_flush_bitmap_cache(ctx->st);

   /* It is not necessarily the draw framebuffer. */
   _mesa_update_renderbuffer_surface(ctx, rb);
   if (rb->surface && rb->surface->context != pipe)
      _mesa_regen_renderbuffer_surface(ctx, rb);

   return rb->surface &&
          pipe->kbuffer.advance_peel_object(pipe, fb->Peeling.Object->driver,
                                    rb->surface,
                                    compare_func(order->DepthFunc),
                                    ctx->Depth.Clear);
}

bool
st_peel_overflow(struct gl_context *ctx, struct gl_framebuffer *fb)
{
   struct pipe_context *pipe = ctx->pipe;

   /* What another context has drawn is that context's to ask for. */
   if (_mesa_is_peeled_elsewhere(ctx, fb) || !fb->Peeling.Object)
      return false;

   return pipe->kbuffer.get_peel_overflow(pipe, fb->Peeling.Object->driver);
}

void
st_peel_release_object(struct gl_framebuffer *fb)
{
   GET_CURRENT_CONTEXT(ctx);

   simple_mtx_lock(&link_mutex);
   struct st_peel_object *object = fb->Peeling.Object;
   const bool owns = object && ctx && object->st == ctx->st;

   set_object(fb, NULL);
   if (object)
      object->fb = NULL;
   simple_mtx_unlock(&link_mutex);

   if (owns)
      delete_orphans(ctx->st);
}

/** What draws that peel need in the pipe; false if there is no memory. */
static bool
set_state(struct st_context *st)
{
   struct gl_context *ctx = st->ctx;
   struct gl_framebuffer *fb = ctx->DrawBuffer;

   if (!create_object(ctx, fb))
      return false;

   const struct pipe_kbuffer_state state = {
      .peel = {
         .object = fb->Peeling.Object->driver,
         .func = compare_func(ctx->Depth.Func),
         .writemask = ctx->Depth.Mask,
         .empty_depth = ctx->Depth.Clear,
      },
   };

   /* A program's state would be taken back only after this. */
   st_kbuffer_unbind(st);
   if (!st->pipe->kbuffer.set_state(st->pipe, &state))
      return false;

   st->peel = fb->Peeling.Object;
   return true;
}

bool
st_peel_update(struct st_context *st)
{
   struct gl_context *ctx = st->ctx;

   /* Contexts without errors draw what draw validation would have refused. */
   if (!ctx->DepthPeeling.Enabled || !_mesa_check_peel_draw(ctx, NULL)) {
      take_state_back(st);
      return false;
   }

   if (!set_state(st)) {
      /* This draw changes nothing, the next one tries again. */
      take_state_back(st);
      ctx->NewDriverState |= ST_NEW_BLEND;
      _mesa_error(ctx, GL_OUT_OF_MEMORY, "glDraw*");
   }

   return true;
}

void
st_peel_destroy_objects(struct st_context *st)
{
   while (st->peel_objects) {
      struct st_peel_object *object = st->peel_objects;

      st->peel_objects = object->next;

      simple_mtx_lock(&link_mutex);
      if (object->fb)
         memset(&object->fb->Peeling, 0, sizeof(object->fb->Peeling));
      simple_mtx_unlock(&link_mutex);

      delete_object(object);
   }
}
