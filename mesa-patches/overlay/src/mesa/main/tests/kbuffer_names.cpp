/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer_names.cpp
 * The names of the enums and program parameters that no registry has.
 */

#include <gtest/gtest.h>

#include "util/glheader.h"
#include "main/enums.h"
#include "program/prog_statevars.h"

TEST(kbuffer_names, enums)
{
   EXPECT_STREQ("GL_KBUFFER_PROGRAM_MESA", _mesa_enum_to_string(0x9791));
   EXPECT_STREQ("GL_MAX_KBUFFER_ENTRIES_MESA", _mesa_enum_to_string(0x9792));
   EXPECT_STREQ("GL_DEPTH_PEELING_MESA", _mesa_enum_to_string(0x9793));
   EXPECT_STREQ("GL_MAX_DEPTH_PEELING_LAYERS_MESA",
                _mesa_enum_to_string(0x9794));
   EXPECT_STREQ("GL_DEPTH_PEELING_FIRST_LAYER_MESA",
                _mesa_enum_to_string(0x9795));
   EXPECT_STREQ("GL_DEPTH_PEELING_OVERFLOW_MESA",
                _mesa_enum_to_string(0x9796));
}

TEST(kbuffer_names, program_parameters)
{
   const gl_state_index16 env[STATE_LENGTH] = {
      STATE_KBUFFER_PROGRAM_ENV, 3
   };
   const gl_state_index16 locals[STATE_LENGTH] = {
      STATE_KBUFFER_PROGRAM_LOCAL_ARRAY, 5, 2
   };

   char *str = _mesa_program_state_string(env);
   EXPECT_STREQ("state.env[3]", str);
   free(str);

   str = _mesa_program_state_string(locals);
   EXPECT_STREQ("state.local.range[5..6]", str);
   free(str);
}
