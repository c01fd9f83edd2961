// SPDX-License-Identifier: MIT

#include "layer_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace kb
{

Status LayerFiles::check() const
{
    if (!wanted())
        return ok;
    std::error_code code;
    auto place = std::filesystem::absolute(directory_, code);
    while (!code && !std::filesystem::exists(place, code) && place.has_relative_path())
        place = place.parent_path();
    if (!std::filesystem::is_directory(place, code))
        return Error{fmt::format("cannot write to {}: {} is not a directory", directory_.string(),
                                 place.string())};
    if (access(place.c_str(), W_OK | X_OK) != 0)
        return Error{fmt::format("cannot write to {}: {}: {}", directory_.string(), place.string(),
                                 std::strerror(errno))};
    return ok;
}

Status LayerFiles::start() const
{
    std::error_code code;
    if (wanted())
        std::filesystem::create_directories(directory_, code);
    if (code)
        return Error{
            fmt::format("cannot make the directory {}: {}", directory_.string(), code.message())};
    return ok;
}

Status LayerFiles::write_color(const std::string &name, const ImageRgbaF &image) const
{
    if (auto written = write_png(directory_ / (name + ".png"), to_rgba8(image)); !written)
        return written;
    return floats_ ? write_pfm(directory_ / (name + ".pfm"), image) : ok;
}

Status LayerFiles::write_layer(int rank, const ImageRgbaF &color, const ImageF &depth) const
{
    const std::string name = fmt::format("layer-{:03}", rank);
    if (auto written = write_color(name, color); !written || !floats_)
        return written;
    return write_pfm(directory_ / (name + "-depth.pfm"), depth);
}

Status LayerFiles::write_picture(const ImageRgbaF &picture) const
{
    return wanted() ? write_color("picture", picture) : ok;
}

} // namespace kb
