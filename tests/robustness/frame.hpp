// SPDX-License-Identifier: MIT

#pragma once

#include "lib/gl/context.hpp"

#include <vector>

namespace kb::test
{

struct FrameOptions {
    Size size{150, 90}; ///< Several tiles, cut ones among them.
    int draws = 24;     ///< Of each of the two kinds.
    bool split = false; ///< Ends a scene after each third draw.
};

/// Draws with both extensions all that they need memory for: a k-buffer program with constants and
/// a texture, new constants for every draw, then depth peeling in several passes of two layers,
/// with framebuffers and programs of its own that are deleted again. Returns everything that it
/// has drawn, bit for bit the same each time.
Result<std::vector<float>> draw_frame(const Gl &gl, const FrameOptions &options);

} // namespace kb::test
