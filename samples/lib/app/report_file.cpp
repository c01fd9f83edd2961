// SPDX-License-Identifier: MIT

#include "lib/app/report_file.hpp"

#include "lib/io/output_file.hpp"

#include <nlohmann/json.hpp>

#include <span>

namespace kb
{

using nlohmann::json;

json to_json(const OrbitCamera &camera)
{
    return {{"azimuth", camera.azimuth},
            {"elevation", camera.elevation},
            {"distance", camera.distance},
            {"field_of_view", camera.field_of_view}};
}

Status write_report(const std::filesystem::path &path, const json &report)
{
    if (path.empty())
        return ok;
    const std::string text = report.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
    return write_file(path, std::as_bytes(std::span(text)));
}

} // namespace kb
