// SPDX-License-Identifier: MIT
//
// The layers of a picture, as pictures in a directory: layer-NNN.png; as floats also layer-NNN.pfm
// and layer-NNN-depth.pfm.

#pragma once

#include "lib/io/image.hpp"

#include <filesystem>
#include <set>
#include <string>

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

    /// Makes the directory.
    Status start() const;
    Status write_layer(int rank, const ImageRgbaF &color, const ImageF &depth);
    /// Another picture: NAME.png, and NAME.pfm.
    Status write_color(const std::string &name, const ImageRgbaF &image) const;

    /// Removes the layers in the directory that were not written now but by an earlier run.
    Status finish() const;

private:
    std::filesystem::path directory_;
    bool floats_;
    std::set<std::string> written_; ///< The names of files.
};

} // namespace kb
