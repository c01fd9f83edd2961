// SPDX-License-Identifier: MIT

#include "volume/report_json.hpp"

#include <nlohmann/json.hpp>

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

json to_json(const ScalarRange &range)
{
    return json::array({range.in_units(range.low), range.in_units(range.high)});
}

} // namespace kb
