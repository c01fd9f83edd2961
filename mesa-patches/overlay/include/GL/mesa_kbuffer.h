/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 *
 * Tokens of GL_MESA_kbuffer_program.
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

#ifdef __cplusplus
}
#endif

#endif /* GL_MESA_KBUFFER_H */
