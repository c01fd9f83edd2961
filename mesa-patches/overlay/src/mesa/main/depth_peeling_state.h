/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file depth_peeling_state.h
 * The state of GL_MESA_depth_peeling, apart from depth_peeling.h because
 * struct gl_context and struct gl_framebuffer contain it.
 */

#ifndef DEPTH_PEELING_STATE_H
#define DEPTH_PEELING_STATE_H

#include "util/glheader.h"
#include "main/formats.h"

struct st_context;
struct st_peel_object;

/** Of a context. */
struct gl_depth_peeling_state
{
   GLboolean Enabled;   /**< GL_DEPTH_PEELING_MESA */
};

/** What the ranks of the peeled fragments depend on. */
struct gl_peel_order
{
   GLenum16 DepthFunc;
   mesa_format Format;
   GLuint Width, Height, NumLayers, NumSamples;
};

/** Of a framebuffer object. */
struct gl_framebuffer_peeling
{
   GLint FirstLayer;             /**< GL_DEPTH_PEELING_FIRST_LAYER_MESA */
   struct gl_peel_order Order;   /**< of the layers before FirstLayer */

   /** The driver's part, see st_peel.h; NULL until it is needed. */
   struct st_peel_object *Object;

   /** Whose it is.  Other contexts read it without a lock. */
   struct st_context *Owner;
};

#endif /* DEPTH_PEELING_STATE_H */
