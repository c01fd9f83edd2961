/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file draw_order.cpp
 * Draws may not be executed out of order while the order of fragments counts.
 * No software driver allows that at all, so that no test by GL would see it.
 */

#include <stdlib.h>

#include <gtest/gtest.h>

#include "main/mtypes.h"
extern "C" {
#include "main/depth_peeling.h"
#include "main/kbuffer.h"
#include "main/state.h"
}

/** A context in which nothing forbids it. */
class draw_order : public ::testing::Test
{
protected:
   void SetUp() override
   {
      /* Far too large for the stack; what is not set is not looked at. */
      ctx = (struct gl_context *) calloc(1, sizeof(*ctx));
      shader = (struct gl_pipeline_object *) calloc(1, sizeof(*shader));
      fb = (struct gl_framebuffer *) calloc(1, sizeof(*fb));
      fb->Visual.depthBits = 24;
      ctx->API = API_OPENGL_COMPAT;
      ctx->_Shader = shader;
      ctx->DrawBuffer = fb;
      ctx->Const.AllowDrawOutOfOrder = true;
      ctx->Depth.Test = true;
      ctx->Depth.Mask = true;
      ctx->Depth.Func = GL_LESS;
      _mesa_update_allow_draw_out_of_order(ctx);
   }

   void TearDown() override
   {
      free(fb);
      free(shader);
      free(ctx);
   }

   struct gl_context *ctx;
   struct gl_pipeline_object *shader;
   struct gl_framebuffer *fb;
};

TEST_F(draw_order, kbuffer_program)
{
   EXPECT_TRUE(ctx->_AllowDrawOutOfOrder);
   _mesa_enable_kbuffer(ctx, GL_TRUE);
   EXPECT_FALSE(ctx->_AllowDrawOutOfOrder);
   _mesa_enable_kbuffer(ctx, GL_FALSE);
   EXPECT_TRUE(ctx->_AllowDrawOutOfOrder);
}

TEST_F(draw_order, depth_peeling)
{
   EXPECT_TRUE(ctx->_AllowDrawOutOfOrder);
   _mesa_enable_depth_peeling(ctx, GL_TRUE);
   EXPECT_FALSE(ctx->_AllowDrawOutOfOrder);
   _mesa_enable_depth_peeling(ctx, GL_FALSE);
   EXPECT_TRUE(ctx->_AllowDrawOutOfOrder);
}
