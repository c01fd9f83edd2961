// SPDX-License-Identifier: MIT
//
// K-buffer programs (GL_MESA_kbuffer_program) that keep the k nearest fragments of each pixel,
// nearest first and, where depths are equal, in the order in which they arrive.
//
// The k-buffer is cleared so that every depth is 1: that is an empty place. A fragment at depth 1
// or with a depth that is not a number is never kept.

#pragma once

#include "lib/result.hpp"

#include <string>
#include <string_view>

namespace kb
{

/// What an entry of the k-buffer holds.
enum class EntryLayout {
    rgbz,   ///< One fragment: red, green, blue, depth. RGBA32F. Alpha is not kept.
    packed, ///< Two fragments: RGBA8 (by PK4UB), depth, RGBA8, depth. RGBA32F.
    depth,  ///< One depth. R32F.
    depth4, ///< Four depths. RGBA32F.
};

inline constexpr int max_kbuffer_entries = 64; ///< GL_MAX_KBUFFER_ENTRIES_MESA of both drivers.

Result<EntryLayout> parse_entry_layout(std::string_view name);
std::string_view name_of(EntryLayout layout);

int fragments_per_entry(EntryLayout layout);

/// Entries that k fragments take.
int entry_count(EntryLayout layout, int k);

/// The largest k for which make_insertion_program has a program.
int max_fragments(EntryLayout layout);

/// The program for any k from 1 to max_fragments(layout).
Result<std::string> make_insertion_program(EntryLayout layout, int k);

} // namespace kb
