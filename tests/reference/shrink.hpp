// SPDX-License-Identifier: MIT
//
// Makes a failing scene small: delta debugging (Zeller and Hildebrandt, Simplifying and Isolating
// Failure-Inducing Input, 2002) of its commands and triangles, and then of its options.

#pragma once

#include "tests/reference/scene.hpp"

#include <functional>

namespace kb::reference
{

using Fails = std::function<bool(const Scene &)>;

/// The smallest scene found that still fails: no single triangle or command can be left out of it,
/// and no option be made simpler. It is asked at most `most_trials` times.
Scene shrink(const Scene &scene, const Fails &fails, int most_trials = 2000);

} // namespace kb::reference
