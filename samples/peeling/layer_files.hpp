// SPDX-License-Identifier: MIT
//
// The pictures that the sample writes into a directory: picture.png and layer-NNN.png; as floats
// also picture.pfm, layer-NNN.pfm and layer-NNN-depth.pfm.

#pragma once

#include "image.hpp"

#include <filesystem>

namespace kb
{

class LayerFiles
{
public:
    /// An empty directory name: nothing is written.
    LayerFiles(std::filesystem::path directory, bool floats)
        : directory_(std::move(directory)), floats_(floats)
    {
    }

    /// Finds out, without making it, whether the directory can be made or written to.
    Status check() const;

    bool wanted() const { return !directory_.empty(); }
    bool with_depths() const { return floats_; }

    /// Makes the directory.
    Status start() const;
    Status write_layer(int rank, const ImageRgbaF &color, const ImageF &depth) const;
    Status write_picture(const ImageRgbaF &picture) const;

private:
    Status write_color(const std::string &name, const ImageRgbaF &image) const;

    std::filesystem::path directory_;
    bool floats_;
};

} // namespace kb
