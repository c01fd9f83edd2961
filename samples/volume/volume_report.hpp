// SPDX-License-Identifier: MIT

#pragma once

#include "lib/io/image.hpp"
#include "volume/disorder_report.hpp"
#include "volume/segment_choice.hpp"
#include "volume/volume_options.hpp"
#include "volume/volume_scene.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

namespace kb
{

struct VolumeReport {
    struct Frame {
        double sort; ///< Milliseconds, on the CPU.
        double draw; ///< Milliseconds, with what follows the drawing of the faces.
    };
    std::vector<Frame> frames;
    std::size_t clusters = 0;              ///< Of cells; 0 if none were looked for.
    std::size_t inner_faces = 0;           ///< Within clusters.
    double cluster_time = 0.0;             ///< Milliseconds, once for all frames.
    std::size_t faces = 0;                 ///< Without those.
    std::size_t covered = 0;               ///< Pixels with anything but the background.
    std::size_t drawn = 0;                 ///< Without those that cover no pixel either.
    std::optional<SegmentChoice> segments; ///< Of the k-buffer program.
    int passes = 0;
    int bytes_per_pixel = 0;
    std::optional<DisorderReport> disorder;
};

/// Pixels with an alpha above zero.
std::size_t count_covered(const ImageRgbaF &image);

/// Lines for people, but that about disorder, which is measured later: what was drawn, what it
/// cost, and why nothing is to be seen if that is so.
void print_report(const VolumeOptions &options, const VolumeScene &scene,
                  const VolumeReport &report);

/// What other renderers need to draw the same picture, and the times.
Status write_report(const std::filesystem::path &path, const VolumeOptions &options,
                    const VolumeScene &scene, const VolumeReport &report);

} // namespace kb
