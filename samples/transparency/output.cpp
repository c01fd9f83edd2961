// SPDX-License-Identifier: MIT

#include "output.hpp"

#include <fmt/format.h>

#include <span>
#include <vector>

namespace kb
{

Status prepare_outputs(const OutputPaths &paths, std::vector<OutputFile> others)
{
    others.push_back({paths.picture, ".png"});
    others.push_back({paths.floats, ".pfm"});
    if (!paths.layers.empty()) {
        std::error_code code;
        std::filesystem::create_directories(paths.layers, code);
        if (code)
            return Error{fmt::format("cannot make the directory {}: {}", paths.layers.string(),
                                     code.message())};
        others.push_back({paths.layers / "layer-00.png", ".png"});
    }
    return prepare_outputs(std::span<const OutputFile>(others));
}

Status write_outputs(const OutputPaths &paths, const ImageRgbaF &image,
                     const std::vector<Layer> &layers)
{
    if (!paths.picture.empty()) {
        if (auto written = write_png(paths.picture, to_rgba8(image)); !written)
            return written;
    }
    if (!paths.floats.empty()) {
        if (auto written = write_pfm(paths.floats, image); !written)
            return written;
    }
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const auto stem = paths.layers / fmt::format("layer-{:02}", i);
        if (auto written = write_png(stem.string() + ".png", to_rgba8(layers[i].color)); !written)
            return written;
        if (auto written = write_pfm(stem.string() + ".pfm", layers[i].color); !written)
            return written;
        if (auto written = write_pfm(stem.string() + "-depth.pfm", layers[i].depth); !written)
            return written;
    }
    return ok;
}

} // namespace kb
