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
#include "main/depth_peeling.h"
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
   void *driver;                  /**< from pipe_context::create_peel_object */
};

/** Protects the links between framebuffers and objects in both directions. */
static simple_mtx_t link_mutex = SIMPLE_MTX_INITIALIZER;

/** Delete an object that is out of its context's list. */
static void
delete_object(struct st_peel_object *object)
{
   struct st_context *st = object->st;

   if (st->peel == object) {
      const struct pipe_kbuffer_state state = { 0 };

      st->pipe->set_kbuffer_state(st->pipe, &state);
      st->peel = NULL;
      st->ctx->NewDriverState |= ST_NEW_BLEND;
   }

   st->pipe->delete_peel_object(st->pipe, object->driver);
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

bool
st_peel_owns_object(struct gl_context *ctx, struct gl_framebuffer *fb)
{
   simple_mtx_lock(&link_mutex);
   const struct st_peel_object *object = fb->Peeling.Object;
   const bool owns = !object || object->st == ctx->st;
   simple_mtx_unlock(&link_mutex);

   return owns;
}

bool
st_peel_create_object(struct gl_context *ctx, struct gl_framebuffer *fb)
{
   struct st_context *st = ctx->st;

   if (fb->Peeling.Object)
      return true;

   struct st_peel_object *object = CALLOC_STRUCT(st_peel_object);

   if (!object)
      return false;

   object->driver = st->pipe->create_peel_object(st->pipe);
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
   fb->Peeling.Object = object;
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

   if (!st_peel_owns_object(ctx, fb)) {
      st_peel_release_object(fb);
   } else if (fb->Peeling.Object) {
      /* Needs no memory. */
      pipe->advance_peel_object(pipe, fb->Peeling.Object->driver, NULL,
                                PIPE_FUNC_LESS, ctx->Depth.Clear);
   }
}

bool
st_peel_continue(struct gl_context *ctx, struct gl_framebuffer *fb,
                 const struct gl_peel_order *order)
{
   struct pipe_context *pipe = ctx->pipe;
   struct gl_renderbuffer *rb = fb->Attachment[BUFFER_DEPTH].Renderbuffer;

   if (!st_peel_create_object(ctx, fb))
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
          pipe->advance_peel_object(pipe, fb->Peeling.Object->driver,
                                    rb->surface,
                                    compare_func(order->DepthFunc),
                                    ctx->Depth.Clear);
}

bool
st_peel_overflow(struct gl_context *ctx, struct gl_framebuffer *fb)
{
   struct pipe_context *pipe = ctx->pipe;

   /* What another context has drawn is that context's to ask for. */
   if (!st_peel_owns_object(ctx, fb) || !fb->Peeling.Object)
      return false;

   return pipe->get_peel_overflow(pipe, fb->Peeling.Object->driver);
}

void
st_peel_release_object(struct gl_framebuffer *fb)
{
   GET_CURRENT_CONTEXT(ctx);

   simple_mtx_lock(&link_mutex);
   struct st_peel_object *object = fb->Peeling.Object;
   const bool owns = object && ctx && object->st == ctx->st;

   fb->Peeling.Object = NULL;
   if (object)
      object->fb = NULL;
   simple_mtx_unlock(&link_mutex);

   if (owns)
      delete_orphans(ctx->st);
}

/** The object that draws must use, NULL when they do not peel. */
static struct st_peel_object *
draw_object(struct gl_context *ctx)
{
   /* Draw validation has looked at the same, but not in contexts without
    * errors.
    */
   if (!ctx->DepthPeeling.Enabled || !_mesa_check_peel_draw(ctx, NULL) ||
       !st_peel_create_object(ctx, ctx->DrawBuffer))
      return NULL;

   return ctx->DrawBuffer->Peeling.Object;
}

bool
st_peel_update(struct st_context *st)
{
   struct gl_context *ctx = st->ctx;
   struct st_peel_object *object = draw_object(ctx);
   struct pipe_kbuffer_state state = { 0 };

   if (object) {
      state.peel.object = object->driver;
      state.peel.func = compare_func(ctx->Depth.Func);
      state.peel.writemask = ctx->Depth.Mask;
      state.peel.empty_depth = ctx->Depth.Clear;

      /* A program's state would be taken back only after this. */
      st_kbuffer_unbind(st);
   }

   if (!object && !st->peel)
      return false;

   if (st->pipe->set_kbuffer_state(st->pipe, &state)) {
      st->peel = object;
   } else {
      /* This draw changes nothing, the next one tries again. */
      st->peel = NULL;
      ctx->NewDriverState |= ST_NEW_BLEND;
      _mesa_error(ctx, GL_OUT_OF_MEMORY, "glDraw*");
   }

   return object != NULL;
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
