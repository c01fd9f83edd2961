// SPDX-License-Identifier: MIT
//
// Small PLY files for tests of pictures, made from fixed seeds.

#pragma once

#include <filesystem>

namespace kb::test
{

/// Large triangles in random places that cut through each other. Eight bits hold all alphas.
void write_triangle_soup(const std::filesystem::path &path, int triangles, unsigned seed);

/// A soup in which every triangle comes four times, in other colors each time: equal depths all
/// over.
void write_tied_soup(const std::filesystem::path &path, int triangles, unsigned seed);

/// Quads in one plane, all with the same corners, each in another color; and one behind them.
void write_coincident_quads(const std::filesystem::path &path, int quads, unsigned seed);

/// Parallel quads, shuffled, each turned about the common axis by some angle and of one color: none
/// cut another.
void write_plane_stack(const std::filesystem::path &path, int planes, unsigned seed);

} // namespace kb::test
