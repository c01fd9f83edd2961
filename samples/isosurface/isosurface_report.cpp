// SPDX-License-Identifier: MIT

#include "isosurface/isosurface_report.hpp"

#include "lib/app/report_file.hpp"
#include "lib/app/say.hpp"
#include "lib/app/timing.hpp"
#include "volume/report_json.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <span>

namespace kb
{

using nlohmann::json;

namespace
{

/// Of those that a predicate wants, but of many only the first ones.
template <class Wanted>
std::string list_values(const IsosurfaceReport &report, const Source &source, const Wanted &wanted)
{
    constexpr int most = 12;
    std::string list;
    int count = 0;
    for (const IsoValue &iso : report.iso_values) {
        if (wanted(iso) && ++count <= most)
            list += (count > 1 ? ", " : "") + describe_value(iso.value, source.range);
    }
    return count > most ? fmt::format("{}, ... ({} in all)", list, count) : list;
}

bool is_outside(const IsoValue &iso, const Source &source)
{
    return normalized(std::span(&iso, 1), source.range).empty();
}

void print_emptiness(const Source &source, const IsosurfaceReport &report)
{
    const std::string outside = list_values(
        report, source, [&source](const IsoValue &iso) { return is_outside(iso, source); });
    if (!outside.empty())
        fmt::print(stderr, "isosurface: no surface has the iso-value {}: {}\n", outside,
                   source.field_description);
    if (report.covered > 0)
        return;
    const bool has_any = std::ranges::any_of(
        report.iso_values, [&source](const IsoValue &iso) { return !is_outside(iso, source); });
    fmt::print(stderr, "isosurface: the picture is empty: {}\n",
               !source.range.varies ? source.field_description
               : has_any            ? "no surface is in view"
                                    : "all iso-values are outside of the field's range");
}

} // namespace

std::size_t count_surfaces(const ImageRgbaF &surfaces)
{
    return static_cast<std::size_t>(std::ranges::count_if(
        surfaces.pixels, [](const glm::vec4 &pixel) { return pixel.x != 0.0F; }));
}

void print_report(const IsosurfaceOptions &options, const Source &source,
                  const IsosurfaceReport &report)
{
    if (options.repair)
        say(describe(source.repairs));
    const std::string medium =
        source.medium == Medium::grid
            ? fmt::format("grid: {} points, {} cells{}", source.faces.positions.size(),
                          source.cells.size(),
                          describe_left_out(source.unused_points, source.joined_points))
            : fmt::format("particles: {}", source.points.size());
    say(fmt::format("{}; {}; iso-values: {}", medium, source.field_description,
                    list_values(report, source, [](const IsoValue &) { return true; })));
    const std::size_t values = report.iso_values.size();
    say(fmt::format(
        "isosurface k={} {}x{}: {}, 1 geometry pass, {} {}, {} iso-value{}, {} bytes per "
        "pixel",
        options.k, options.size.width, options.size.height, describe(spread_of(report.times)),
        report.primitives, report.primitive, values, values == 1 ? "" : "s",
        report.bytes_per_pixel));
    print_emptiness(source, report);
}

Status write_report(const std::filesystem::path &path, const IsosurfaceOptions &options,
                    const Source &source, const IsosurfaceReport &report)
{
    json values = json::array();
    for (const IsoValue &iso : report.iso_values)
        values.push_back({{"value", iso.value},
                          {"color", to_json(iso.color)},
                          {"in_range", !is_outside(iso, source)}});
    const bool is_grid = source.medium == Medium::grid;
    const std::string file = is_grid ? options.grid : options.particles;
    json document{
        {is_grid ? "grid" : "particles", file.empty() ? json() : json(file)},
        {"points", is_grid ? source.faces.positions.size() : source.points.size()},
        {"field", source.field},
        {"range", to_json(source.range)},
        {"iso_values", values},
        {"camera", to_json(options.camera)},
        {"size", {options.size.width, options.size.height}},
        {"background", to_json(options.background)},
        {"k", options.k},
        {"passes", 1},
        {"primitive", report.primitive},
        {"primitives", report.primitives},
        {"pixels_covered", report.covered},
        {"bytes_per_pixel", report.bytes_per_pixel},
        {"ms", report.times},
    };
    if (is_grid) {
        document["cells"] = source.cells.size();
        document["unused_points"] = source.unused_points;
        document["joined_points"] = source.joined_points;
        document["repair"] = options.repair;
    }
    if (report.disorder)
        document["disorder"] = to_json(*report.disorder, options.k);
    return write_report(path, document);
}

} // namespace kb
