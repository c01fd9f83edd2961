// SPDX-License-Identifier: MIT

#include "lib/io/layer_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <regex>
#include <vector>

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

Status LayerFiles::write_layer(int rank, const ImageRgbaF &color, const ImageF &depth)
{
    const std::string name = fmt::format("layer-{:03}", rank);
    written_.insert(name + ".png");
    if (floats_)
        written_.insert({name + ".pfm", name + "-depth.pfm"});
    if (auto written = write_color(name, color); !written || !floats_)
        return written;
    return write_pfm(directory_ / (name + "-depth.pfm"), depth);
}

Status LayerFiles::finish() const
{
    if (!wanted())
        return ok;
    static const std::regex layer("layer-[0-9]{3,}([.]png|(-depth)?[.]pfm)");
    std::error_code code;
    std::vector<std::filesystem::path> others;
    for (const auto &entry : std::filesystem::directory_iterator(directory_, code)) {
        const std::string name = entry.path().filename().string();
        if (std::regex_match(name, layer) && !written_.contains(name))
            others.push_back(entry.path());
    }
    for (const auto &other : others) {
        if (!code)
            std::filesystem::remove(other, code);
        if (code)
            return Error{fmt::format("cannot remove {}, a layer of an earlier run: {}",
                                     other.string(), code.message())};
    }
    return ok;
}

} // namespace kb
