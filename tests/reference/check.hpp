// SPDX-License-Identifier: MIT
//
// Compares what a driver makes of a scene with the A-buffer. In this order, so that a failure names
// the first thing that is wrong:
//
//   1. The fragments of every triangle alone. Coverage: exactly, where the rasterizer decides it; a
//      sample that it leaves undecided counts as the driver has it. Depth and color: within the
//      bound on rounding that the rasterizer gives. Where a triangle that was clipped covers a
//      sample twice, one of its fragments is not known, and the sample is left out of what follows.
//   2. The layers: the depth bit for bit, integers exactly, colors within the rounding of their
//      format. Each sample's fragments are sorted by the depths as stored. These are known to be
//      right within their bound, so fragments farther apart than that are in the order of the exact
//      depths; nearer ones are ordered by what rounding made of them, and equal ones by arrival.
//   3. Overflow, and the number of passes.
//   4. The composite of the layers, from the rasterizer's colors in double precision.

#pragma once

#include "tests/reference/a_buffer.hpp"
#include "tests/reference/gl_scene.hpp"
#include "tests/reference/rasterizer.hpp"

#include <algorithm>
#include <optional>
#include <string>

namespace kb::reference
{

/// Mistakes to make on purpose, for tests of this test.
enum class Fault { none, coverage, depth, ties, layers, composite, crash };
Result<Fault> parse_fault(const std::string &name);

/// How much was compared, and how.
struct Statistics {
    std::size_t samples = 0;   ///< Of all triangles.
    std::size_t undecided = 0; ///< Of them, as the driver has it.
    std::size_t fragments = 0;
    std::size_t doubled = 0; ///< Samples that a clipped triangle covers twice: not compared.
    std::size_t unbounded_depths = 0; ///< Of triangles lost in rounding.
    std::size_t unbounded_colors = 0;
    std::size_t ties = 0; ///< Scenes with equal depths.
    std::size_t layers = 0;
    std::size_t passes = 0;
    std::size_t composites = 0;

    Statistics &operator+=(const Statistics &other);
};

/// A scene on a driver, with all that is known about it.
struct Observation {
    std::vector<TriangleDump> dumps;
    std::vector<Pass> passes;
    ABuffer a_buffer{0};
    bool overflow_before_clear = false; ///< A list was longer than k when it was cleared.
    std::vector<bool> doubled; ///< Samples that a triangle covers twice: not all is known of them.

    bool knows_all() const
    {
        return std::find(doubled.begin(), doubled.end(), true) == doubled.end();
    }
};

/// Draws the scene; an error if the driver cannot.
Result<Observation> observe(SceneDrawer &drawer, const Scene &scene);

/// What is wrong, if anything: "kind: more".
Result<std::optional<std::string>> check(SceneDrawer &drawer, const Scene &scene, Fault fault,
                                         Statistics &statistics);

} // namespace kb::reference
