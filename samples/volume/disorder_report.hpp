// SPDX-License-Identifier: MIT

#pragma once

#include "disorder.hpp"
#include "image.hpp"
#include "sorted_faces.hpp"
#include "volume_options.hpp"
#include "volume_scene.hpp"

#include <cstdint>
#include <optional>

namespace kb
{

/// How far from depth order the fragments of a picture arrived, and what that did to its colors.
struct DisorderReport {
    Disorder fragments;
    /// Against the exact picture of the scene's own faces. None if the picture is exact itself.
    std::optional<Difference> colors;
};

/// Of the pixels that have a fragment; `share` is of those that are off by more than 1/255.
Result<Difference> color_error(const ImageRgbaF &picture, const ImageRgbaF &exact,
                               std::uint64_t pixels);

/// `faces` made the picture as they are sorted; they may be the scene's own ones or pieces of them.
Result<DisorderReport> measure_disorder(const Gl &gl, const VolumeOptions &options,
                                        const VolumeScene &scene, const SortedFaces &faces,
                                        const ImageRgbaF &picture);

} // namespace kb
