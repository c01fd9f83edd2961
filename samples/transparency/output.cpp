// SPDX-License-Identifier: MIT

#include "output.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace kb
{

Status check_writable(const std::filesystem::path &file)
{
    if (file.empty())
        return ok;
    std::error_code code;
    if (std::filesystem::is_directory(file, code))
        return Error{fmt::format("cannot write {}: it is a directory", file.string())};
    const auto directory = file.has_parent_path() ? file.parent_path() : ".";
    if (!std::filesystem::is_directory(directory, code))
        return Error{fmt::format("cannot write {}: there is no directory {}", file.string(),
                                 directory.string())};
    if (access(directory.c_str(), W_OK) != 0)
        return Error{fmt::format("cannot write {}: {}", file.string(), std::strerror(errno))};
    return ok;
}

Status check_writable(const OutputPaths &paths)
{
    for (const auto &file : {paths.picture, paths.floats}) {
        if (auto checked = check_writable(file); !checked)
            return checked;
    }
    if (!paths.layers.empty()) {
        std::error_code code;
        std::filesystem::create_directories(paths.layers, code);
        if (code)
            return Error{fmt::format("cannot make the directory {}: {}", paths.layers.string(),
                                     code.message())};
        return check_writable(paths.layers / "layer-00.png");
    }
    return ok;
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
