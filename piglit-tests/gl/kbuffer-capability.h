/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file kbuffer-capability.h
 * What is the same for every capability of Enable: subtests for either
 * extension's.
 */

#ifndef KBUFFER_CAPABILITY_H
#define KBUFFER_CAPABILITY_H

#include "kbuffer-common.h"

/** A capability, and for push and pop an attribute group. */
struct kb_capability {
	GLenum cap;
	GLbitfield group;
};

/**
 * Initially disabled, enabled and disabled, queried, independent of others,
 * saved by PushAttrib of ENABLE_BIT and all bits but not of \p other_group,
 * compiled into display lists, an error between Begin and End.
 */
#define KB_CAPABILITY_SUBTESTS(cap, other_group_name, other_group)           \
	KB_CAPABILITY_SUBTEST("initial", kb_cap_initial, cap, 0),            \
	KB_CAPABILITY_SUBTEST("toggle", kb_cap_toggle, cap, 0),              \
	KB_CAPABILITY_SUBTEST("apart-from-others", kb_cap_apart, cap, 0),    \
	KB_CAPABILITY_SUBTEST("push-enable-bit", kb_cap_push_pop, cap,       \
			      GL_ENABLE_BIT),                                \
	KB_CAPABILITY_SUBTEST("push-all-bits", kb_cap_push_pop, cap,         \
			      GL_ALL_ATTRIB_BITS),                           \
	KB_CAPABILITY_SUBTEST("push-" other_group_name, kb_cap_push_pop, cap, \
			      other_group),                                  \
	KB_CAPABILITY_SUBTEST("display-list", kb_cap_display_list, cap, 0),  \
	KB_CAPABILITY_SUBTEST("between-begin-and-end", kb_cap_begin_end, cap, 0)

#define KB_CAPABILITY_SUBTEST(name, func, cap, group) \
	KB_SUBTEST(name, func, (&(struct kb_capability) { cap, group }))

enum piglit_result
kb_cap_initial(void *capability);
enum piglit_result
kb_cap_toggle(void *capability);
enum piglit_result
kb_cap_apart(void *capability);
enum piglit_result
kb_cap_push_pop(void *capability);
enum piglit_result
kb_cap_display_list(void *capability);
enum piglit_result
kb_cap_begin_end(void *capability);

/** Every query gives the value of an implementation's limit, \p at_least. */
bool
kb_check_limit(GLenum pname, int at_least);

#endif /* KBUFFER_CAPABILITY_H */
