// SPDX-License-Identifier: MIT

#include "report_json.hpp"

#include "output_file.hpp"

#include <nlohmann/json.hpp>

#include <span>

namespace kb
{

using nlohmann::json;

json to_json(const DisorderReport &report, int k)
{
    json document{{"displacement", report.fragments.displacement()},
                  {"pixels", report.fragments.pixels()},
                  {"fragments", report.fragments.fragments()},
                  {"deepest", report.fragments.deepest()}};
    if (report.colors) {
        document["share_wrong"] = report.fragments.share_wrong(k);
        document["color_error"] = {{"max", report.colors->max},
                                   {"rmse", report.colors->rmse},
                                   {"share", report.colors->share}};
    }
    return document;
}

json to_json(glm::dvec3 v)
{
    return json::array({v.x, v.y, v.z});
}

json to_json(const OrbitCamera &camera)
{
    return {{"azimuth", camera.azimuth},
            {"elevation", camera.elevation},
            {"distance", camera.distance},
            {"field_of_view", camera.field_of_view}};
}

json to_json(const ScalarRange &range)
{
    return json::array({range.in_units(range.low), range.in_units(range.high)});
}

Status write_json(const std::filesystem::path &path, const json &document)
{
    // A name may have any bytes.
    const std::string text = document.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
    return write_file(path, std::as_bytes(std::span(text)));
}

} // namespace kb
