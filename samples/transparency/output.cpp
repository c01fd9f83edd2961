// SPDX-License-Identifier: MIT

#include "transparency/output.hpp"

#include "lib/io/layer_files.hpp"

#include <span>

namespace kb
{

Status prepare_outputs(const OutputPaths &paths, std::vector<OutputFile> others)
{
    others.push_back({paths.picture, ".png"});
    others.push_back({paths.floats, ".pfm"});
    if (auto checked = LayerFiles(paths.layers, true).check(); !checked)
        return checked;
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
    LayerFiles files(paths.layers, true);
    if (auto started = files.start(); !started)
        return started;
    int rank = 0;
    for (const Layer &layer : layers) {
        if (auto written = files.write_layer(rank++, layer.color, layer.depth); !written)
            return written;
    }
    return files.finish();
}

} // namespace kb
