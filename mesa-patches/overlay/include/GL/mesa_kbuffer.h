/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 *
 * Tokens of GL_MESA_kbuffer_program and GL_MESA_depth_peeling.
 *
 * The values lie in the range that the Khronos registry gives to MESA
 * (0x9790-0x979F) but are not registered: only this header gives them.
 * There are no new entry points.
 */

#ifndef GL_MESA_KBUFFER_H
#define GL_MESA_KBUFFER_H

#ifdef __cplusplus
extern "C" {
#endif

#ifndef GL_MESA_kbuffer_program
#define GL_MESA_kbuffer_program 1
#define GL_KBUFFER_PROGRAM_MESA           0x9791
#define GL_MAX_KBUFFER_ENTRIES_MESA       0x9792
#endif

#ifndef GL_MESA_depth_peeling
#define GL_MESA_depth_peeling 1
#define GL_DEPTH_PEELING_MESA             0x9793
#define GL_MAX_DEPTH_PEELING_LAYERS_MESA  0x9794
#define GL_DEPTH_PEELING_FIRST_LAYER_MESA 0x9795
#define GL_DEPTH_PEELING_OVERFLOW_MESA    0x9796

/* The name that the paper gave it. */
#define GL_DEPTH_PEELING                  GL_DEPTH_PEELING_MESA
#endif

#ifdef __cplusplus
}
#endif

#endif /* GL_MESA_KBUFFER_H */
