// SPDX-License-Identifier: MIT

#pragma once

#include "isosurface/iso_values.hpp"
#include "isosurface/options.hpp"
#include "isosurface/source.hpp"
#include "lib/io/image.hpp"
#include "volume/disorder_report.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace kb
{

struct IsosurfaceReport {
    std::vector<IsoValue> iso_values; ///< All that were chosen, in the units of the field.
    std::string primitive;            ///< "triangles", and how many are drawn.
    std::size_t primitives = 0;
    int bytes_per_pixel = 0;
    std::size_t covered = 0;   ///< Pixels with a surface.
    std::vector<double> times; ///< Milliseconds of each frame.
    std::optional<DisorderReport> disorder;
};

/// Pixels with a surface, of IsosurfaceRenderer::read_surfaces.
std::size_t count_surfaces(const ImageRgbaF &surfaces);

/// Lines for people: what was drawn and what it cost; on the standard error output which iso-values
/// have no surface, and why nothing is to be seen if that is so. Disorder is measured later.
void print_report(const IsosurfaceOptions &options, const Source &source,
                  const IsosurfaceReport &report);

/// All of it for programs.
Status write_report(const std::filesystem::path &path, const IsosurfaceOptions &options,
                    const Source &source, const IsosurfaceReport &report);

} // namespace kb
