// SPDX-License-Identifier: MIT
//
// A model of what layers are, and random scenes to compare with it.

#pragma once

#include "tests/hard_cases/method.hpp"

namespace kb::hard
{

/// Steep and flat triangles, coplanar ones cut in different ways and repeated, depths from 2^-24
/// apart to the whole range, alpha 0 and 1, NaN depths. No two triangles share a color's bits.
Scene make_mixture(std::uint32_t seed);

/// Every triangle drawn alone, without any k-buffer, gives the fragments in order of arrival; a
/// stable sort gives the ranks.
Layers sorted_fragments(const Gl &gl, const Scene &scene, const SceneInGl &in_gl,
                        const Shape &shape);

/// Layers `first` to `first` + k - 1.
Layers cut_out(const Layers &layers, int first, int k);

/// The layers of all passes behind each other.
Layers join(const std::vector<Pass> &passes);

/// The part of the samples whose layers differ in any bit.
double differing(const Layers &a, const Layers &b);

std::size_t deepest(const Layers &layers);

} // namespace kb::hard
