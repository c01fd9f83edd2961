// SPDX-License-Identifier: MIT

#include "isosurface/options.hpp"

#include "volume/order_option.hpp"

#include <CLI/CLI.hpp>

namespace kb
{

/// A number option that stays empty unless it is given.
template <class T>
static void add_number(CLI::App &app, const char *name, T &value, double low, double high,
                       const char *type, const char *help)
{
    app.add_option(name, value, help)
        ->check([low, high](const std::string &text) { return check_number(text, low, high); })
        ->type_name(type);
}

static void declare_source(CLI::App &app, IsosurfaceOptions &options)
{
    app.add_option("--grid", options.grid,
                   "Legacy VTK file with a tetrahedral grid; without, a grid is generated")
        ->type_name("FILE");
    app.add_flag("--repair", options.repair,
                 "Leave cells without volume out and turn inverted ones, else they are errors");
    app.add_option_function<std::vector<std::string>>(
           "--particles",
           [&options](const std::vector<std::string> &files) {
               options.has_particles = true;
               options.particles = files.empty() ? "" : files.front();
           },
           "Draw the points of a legacy VTK file, or generated particles, not a grid")
        ->expected(0, 1)
        ->type_name("[FILE]");
    app.add_option("--count", options.particle_count, "How many particles are generated, about")
        ->check(integer_in(100, 10'000'000))
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--field", options.field, "Scalar field, by name; without, the first")
        ->type_name("NAME");
    app.add_flag("--list-fields", options.list_fields,
                 "Print the fields with their ranges, and draw nothing");
}

static void declare_surfaces(CLI::App &app, IsosurfaceOptions &options)
{
    app.add_option_function<std::vector<std::string>>(
           "--iso",
           [&options](const std::vector<std::string> &texts) {
               for (const std::string &text : texts) {
                   const auto request = parse_iso_value(text);
                   if (!request)
                       throw CLI::ValidationError("--iso", request.error().message);
                   options.iso_values.push_back(*request);
               }
           },
           "Iso-values, each with a color or without: 0.25, 0.25=#ff8000 or 0.25=orange; any "
           "number of "
           "them")
        ->delimiter(',')
        ->type_name("VALUE,...");
    app.add_option("--levels", options.levels, "Without --iso: so many, evenly spaced")
        ->check(integer_in(1, 1'000))
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--k", options.k, "Fragments that wait in the k-buffer")
        ->check(integer_in(1, max_isosurface_k))
        ->type_name("N")
        ->capture_default_str();
    add_order_option(app, options.order);
    add_number(app, "--point-size", options.point_size, 1e-5, 1.0, "LENGTH",
               "Side of a particle, in a scene whose bounding sphere has radius 1");
    add_number(app, "--gap", options.gap, 0.0, 1.0, "LENGTH",
               "Particles farther apart along a ray have nothing between them");
    add_number(app, "--smoothing", options.smoothing, 0, 64, "PIXELS",
               "Make depths smooth over so many pixels before normals are taken; 0: do not");
    app.add_flag("!--no-silhouettes", options.silhouettes, "Draw no lines where the depth jumps");
    add_disorder_option(app, options.measure_disorder);
}

void declare_options(CLI::App &app, IsosurfaceOptions &options)
{
    declare_source(app, options);
    declare_surfaces(app, options);
    add_camera_options(app, options.camera);
    add_background_option(app, options.background);
    add_context_option(app, options.context);
    add_size_option(app, options.size);
    app.add_option("--repeat", options.repeat, "Draw this many times and print the median time")
        ->check(integer_in(1, 10'000))
        ->type_name("N");
    app.add_option("--out", options.outputs.picture, "Write the picture")->type_name("FILE.png");
    app.add_option("--float-out", options.outputs.floats, "Write the picture before rounding")
        ->type_name("FILE.pfm");
    app.add_option("--surfaces-out", options.surfaces,
                   "Write distance from the eye and iso-value of each pixel's surface as red and "
                   "green; no surface is 0, 0")
        ->type_name("FILE.pfm");
    app.add_option("--json", options.json, "Write what was drawn and the times of each frame")
        ->type_name("FILE.json");
}

Status check_options(const IsosurfaceOptions &options)
{
    if (options.has_particles && (!options.grid.empty() || options.repair))
        return Error{"--grid and --repair are for grids, --particles draws none"};
    if (!options.has_particles && (options.point_size || options.gap))
        return Error{"--point-size and --gap need --particles"};
    return ok;
}

std::vector<IsoValue> choose_iso_values(const IsosurfaceOptions &options, const ScalarRange &range)
{
    const double low = range.in_units(range.low);
    const double extent = double(range.high) - double(range.low);
    const auto color_at = [=](double value) {
        return palette_color(static_cast<float>((value - low) / extent));
    };
    std::vector<IsoValue> values;
    for (const IsoRequest &request : options.iso_values)
        values.push_back(
            {request.value, request.has_color ? request.color : color_at(request.value)});
    if (!values.empty() || !range.varies)
        return values;
    for (int i = 1; i <= options.levels; ++i) {
        const double value = low + extent * i / (options.levels + 1);
        values.push_back({value, color_at(value)});
    }
    return values;
}

} // namespace kb
