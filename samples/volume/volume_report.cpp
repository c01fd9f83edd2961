// SPDX-License-Identifier: MIT

#include "volume/volume_report.hpp"

#include "lib/app/report_file.hpp"
#include "lib/app/say.hpp"
#include "lib/app/timing.hpp"
#include "volume/report_json.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

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

json to_json(const SegmentChoice &segments)
{
    return {{"parts", segments.lookup.parts},
            {"interpolated", segments.lookup.interpolates()},
            {"color_error", segments.error},
            {"rays", segments.rays}};
}

/// What the lookups leave, and what colors are off by at most with that and a tolerance.
std::string describe(const SegmentChoice &segments, double tolerance)
{
    std::string text =
        segments.lookup.interpolates()
            ? fmt::format("segments: in {} part{}, interpolated", segments.lookup.parts,
                          segments.lookup.parts == 1 ? "" : "s")
            : std::string("segments: whole, by the nearest texel");
    text += fmt::format("; colors off by {:.2g} at most of {} rays", segments.error, segments.rays);
    if (tolerance > 0.0)
        text += fmt::format(", with the tolerance by {:.3g}", tolerance + segments.error);
    return text;
}

/// Infinite extinction is a word, as JSON has no such number.
json to_json(const TransferPoint &point, ScalarRange range)
{
    const double value =
        range.in_units(range.low) + double(point.value) * (double(range.high) - double(range.low));
    return json::array({value, point.color.r, point.color.g, point.color.b,
                        std::isinf(point.extinction) ? json("inf") : json(point.extinction)});
}

/// Why nothing is to be seen.
std::string describe_emptiness(const VolumeScene &scene)
{
    // Extinction is linear between points, and as at the ends outside of them.
    const auto absorbs = [&scene](float value) {
        return scene.transfer.at(value).extinction > 0.0F;
    };
    const bool absorbs_any =
        absorbs(0.0F) || absorbs(1.0F) ||
        std::ranges::any_of(scene.transfer.points(), [](const TransferPoint &point) {
            return point.value >= 0.0F && point.value <= 1.0F && point.extinction > 0.0F;
        });
    if (!absorbs_any)
        return "the transfer function gives no value of the field an extinction";
    if (!scene.range.varies)
        return "the transfer function gives the field's only value no extinction, or nothing is in "
               "view";
    return "nothing of the grid that has an extinction is in view";
}

} // namespace

std::size_t count_covered(const ImageRgbaF &image)
{
    return static_cast<std::size_t>(
        std::ranges::count_if(image.pixels, [](const glm::vec4 &pixel) { return pixel.a > 0.0F; }));
}

void print_report(const VolumeOptions &options, const VolumeScene &scene,
                  const VolumeReport &report)
{
    if (options.scene.repair)
        say(describe(scene.repairs));
    say(fmt::format("grid: {} points, {} cells{}; {}; transfer function: {}",
                    scene.grid.points.size(), scene.grid.cells.size(),
                    describe_left_out(scene.grid.unused_points, scene.joined_points),
                    scene.field_description,
                    options.scene.transfer_points.empty() ? options.scene.transfer
                                                          : options.scene.transfer_points));
    if (report.clusters > 0)
        say(fmt::format("joined: {} cells in {} clusters, {} faces in them are not drawn ({:.0f} "
                        "ms, once)",
                        scene.grid.cells.size(), report.clusters, report.inner_faces,
                        report.cluster_time));
    const Spread frame = spread(report, whole);
    const Spread sort = spread(report, [](const VolumeReport::Frame &f) { return f.sort; });
    say(fmt::format(
        "volume {} k={} {}x{}: {}, {} geometry pass{}, {} of {} faces drawn, {} bytes per "
        "pixel",
        options.exact ? "exact" : "kbuffer", options.k, options.size.width, options.size.height,
        describe(frame, fmt::format("sorting {:.2f}", sort.median)), report.passes,
        report.passes == 1 ? "" : "es", report.drawn, report.faces, report.bytes_per_pixel));
    if (report.segments)
        say(describe(*report.segments, options.tolerance));
    if (report.covered == 0)
        fmt::print(stderr, "volume: the picture is empty: {}\n", describe_emptiness(scene));
    else if (!scene.range.varies)
        fmt::print(stderr, "volume: the picture has one color: {}\n", scene.field_description);
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
    json document{
        {"grid", options.scene.grid.empty() ? json() : json(options.scene.grid.string())},
        {"cubes", options.scene.cubes},
        {"repair", options.scene.repair},
        {"field", scene.field},
        {"range", to_json(scene.range)},
        {"points", scene.grid.points.size()},
        {"cells", scene.grid.cells.size()},
        {"unused_points", scene.grid.unused_points},
        {"joined_points", scene.joined_points},
        {"pixels_covered", report.covered},
        {"center", to_json(scene.center)},
        {"radius", scene.radius},
        {"transfer", transfer},
        {"camera", to_json(options.scene.camera)},
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
    if (report.segments)
        document["segments"] = to_json(*report.segments);
    if (report.disorder)
        document["disorder"] = to_json(*report.disorder, options.k);
    return write_report(path, document);
}

} // namespace kb
