// SPDX-License-Identifier: MIT

#include "volume_report.hpp"

#include "image.hpp"
#include "timing.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <span>

namespace kb
{

using nlohmann::json;

namespace
{

/// Of a part of all frames, or of whole frames.
Spread spread(const VolumeReport &report, double (*milliseconds)(const VolumeReport::Frame &))
{
    std::vector<double> values;
    for (const VolumeReport::Frame &frame : report.frames)
        values.push_back(milliseconds(frame));
    return spread_of(values);
}

double whole(const VolumeReport::Frame &frame)
{
    return frame.sort + frame.draw;
}

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

json to_json(glm::vec3 v)
{
    return json::array({v.x, v.y, v.z});
}

/// Infinite extinction is a word, as JSON has no such number.
json to_json(const TransferPoint &point, ScalarRange range)
{
    const float value = range.low + point.value * (range.high - range.low);
    return json::array({value, point.color.r, point.color.g, point.color.b,
                        std::isinf(point.extinction) ? json("inf") : json(point.extinction)});
}

} // namespace

void print_report(const VolumeOptions &options, const VolumeScene &scene,
                  const VolumeReport &report)
{
    if (options.scene.repair)
        fmt::print("{}\n", describe(scene.repairs));
    if (report.clusters > 0)
        fmt::print("joined: {} cells in {} clusters, {} faces in them are not drawn ({:.0f} ms, "
                   "once)\n",
                   scene.grid.cells.size(), report.clusters, report.inner_faces,
                   report.cluster_time);
    const Spread frame = spread(report, whole);
    const Spread sort = spread(report, [](const VolumeReport::Frame &f) { return f.sort; });
    fmt::print("volume {} k={} {}x{}: {:.2f} ms (5 % {:.2f}, 95 % {:.2f}, {} times; sorting "
               "{:.2f}), {} geometry pass{}, {} of {} faces drawn, {} bytes per pixel\n",
               options.exact ? "exact" : "kbuffer", options.k, options.size.width,
               options.size.height, frame.median, frame.p5, frame.p95, report.frames.size(),
               sort.median, report.passes, report.passes == 1 ? "" : "es", report.drawn,
               report.faces, report.bytes_per_pixel);
    if (report.disorder)
        fmt::print("{}\n", describe(*report.disorder, options.k));
}

Status write_report(const std::filesystem::path &path, const VolumeOptions &options,
                    const VolumeScene &scene, const VolumeReport &report)
{
    json transfer = json::array();
    for (const TransferPoint &point : scene.transfer.points())
        transfer.push_back(to_json(point, scene.range));
    json times = json::array();
    for (const VolumeReport::Frame &frame : report.frames)
        times.push_back(whole(frame));
    const OrbitCamera &camera = options.scene.camera;
    json document{
        {"grid", options.scene.grid.empty() ? json() : json(options.scene.grid.string())},
        {"cubes", options.scene.cubes},
        {"repair", options.scene.repair},
        {"field", scene.field},
        {"center", to_json(scene.center)},
        {"radius", scene.radius},
        {"transfer", transfer},
        {"camera",
         {{"azimuth", camera.azimuth},
          {"elevation", camera.elevation},
          {"distance", camera.distance},
          {"field_of_view", camera.field_of_view}}},
        {"size", {options.size.width, options.size.height}},
        {"background", to_json(options.background)},
        {"k", options.k},
        {"all_faces", options.all_faces},
        {"tolerance", options.tolerance},
        {"clusters", report.clusters},
        {"inner_triangles", report.inner_faces},
        {"ms_clusters", report.cluster_time},
        {"budget", options.budget},
        {"exact", options.exact},
        {"passes", report.passes},
        {"triangles", report.faces},
        {"triangles_drawn", report.drawn},
        {"bytes_per_pixel", report.bytes_per_pixel},
        {"ms", times},
        {"ms_parts",
         {{"sort", spread(report, [](const VolumeReport::Frame &f) { return f.sort; }).median},
          {"draw", spread(report, [](const VolumeReport::Frame &f) { return f.draw; }).median}}},
    };
    if (report.disorder)
        document["disorder"] = to_json(*report.disorder, options.k);
    const std::string text = document.dump(2) + "\n";
    return write_file(path, std::as_bytes(std::span(text)));
}

} // namespace kb
