// SPDX-License-Identifier: MIT
//
// Every fragment of a scene as this context's rasterizer makes it, for exact images.

#pragma once

#include "bench/gl_scene.hpp"
#include "lib/io/image.hpp"
#include "lib/scene/camera.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace kb::bench
{

struct Capture {
    std::uint64_t fragments = 0;
    std::uint32_t depth_complexity = 0; ///< The most fragments of one pixel.
    std::uint64_t covered_pixels = 0;   ///< Pixels with a fragment.
    std::vector<ImageRgbaF> images;     ///< One for each k.
};

/// Counts the fragments of each pixel, captures them band by band in exactly the memory that they
/// need, sorts each pixel's on the CPU and composites the first k of them for each k of the list.
Capture capture_exact_images(const Gl &gl, const GlScene &scene, Size size,
                             std::span<const int> ks);

} // namespace kb::bench
