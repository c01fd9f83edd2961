// SPDX-License-Identifier: MIT

#pragma once

#include "lib/io/output_file.hpp"
#include "transparency/method.hpp"

#include <filesystem>
#include <vector>

namespace kb
{

/// Where results go; empty paths are not written.
struct OutputPaths {
    std::filesystem::path picture; ///< PNG
    std::filesystem::path floats;  ///< PFM
    std::filesystem::path layers;  ///< A directory.

    bool empty() const { return picture.empty() && floats.empty() && layers.empty(); }
};

/// Finds out before any work whether all of them can be written, and others.
Status prepare_outputs(const OutputPaths &paths, std::vector<OutputFile> others = {});

/// Layers are written with their depths and as floats, too, see LayerFiles.
Status write_outputs(const OutputPaths &paths, const ImageRgbaF &image,
                     const std::vector<Layer> &layers);

} // namespace kb
