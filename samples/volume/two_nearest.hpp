// SPDX-License-Identifier: MIT
//
// The part of a k-buffer program that puts a stream of fragments in order. k fragments wait in the
// k-buffer; each that arrives takes its place among them, and the nearest of the k + 1 leaves. A
// sequence in which no fragment is more than k places from where it belongs leaves sorted. The one
// that leaves and the one that left before it are the two nearest: the ends of a ray segment.
//
// A fragment is a pair (depth, value), two an entry. Everything is cleared to 0: an empty place is
// a fragment at depth 0, so all k of them leave first.

#pragma once

#include <string>

namespace kb
{

/// Entries in which k fragments wait, as (depth, value, depth, value).
int waiting_entries(int k);

/// The lines of an ARB program. They take the fragment from `fragment.color.xy` (depth, value),
/// use and write the entries from first_entry on, and leave the nearest in `nearest.xy`. They
/// declare the TEMPs nearest and farther. Fragments of equal depth leave as they have come.
std::string make_take_nearest(int k, int first_entry);

} // namespace kb
