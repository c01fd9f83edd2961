// SPDX-License-Identifier: MIT
//
// Draws on the CPU, in double precision, what `volume --json` says it drew.

#include "tests/integrator/scene.hpp"

#include "lib/app/command_line.hpp"

#include <CLI/CLI.hpp>
#include <string>

namespace
{

using namespace kb;
using namespace kb::integrator;

struct Options {
    std::string scene;
    std::string out;
    std::string low;
    std::string high;
    double distance = 1.0 / 256.0;
};

Status write(const std::string &path, const Picture &picture)
{
    return path.empty() ? Status(ok) : write_pfm(path, to_floats(picture));
}

Status draw(const Options &options, const Volume &volume)
{
    if (auto written = write(options.out, integrate(volume)); !written)
        return written;
    if (options.low.empty() && options.high.empty())
        return ok;
    const Bounds bounds = integrate_bounds(volume, options.distance);
    auto written = write(options.low, bounds.low);
    return written ? write(options.high, bounds.high) : written;
}

} // namespace

int main(int argc, char **argv)
{
    CLI::App app{"Draws on the CPU, in double precision, what `volume --json` says it drew.",
                 "integrate"};
    Options options;
    app.add_option("--scene", options.scene, "What volume --json wrote")
        ->required()
        ->type_name("FILE.json");
    app.add_option("--out", options.out, "Write the picture")->required()->type_name("FILE.pfm");
    app.add_option("--low", options.low,
                   "Write the least value over rays beside the pixel's center")
        ->type_name("FILE.pfm");
    app.add_option("--high", options.high, "The greatest, as --low")->type_name("FILE.pfm");
    app.add_option("--distance", options.distance,
                   "How far --low and --high move rays to each side, in pixels")
        ->check([](const std::string &text) { return check_number(text, 0.0, 1.0); })
        ->type_name("D");
    if (const auto status = parse_command_line(app, argc, argv))
        return *status;
    const auto scene = load_scene(options.scene);
    if (!scene)
        return fail(app, scene.error(), exit_bad_input);
    if (const auto drawn = draw(options, scene->volume()); !drawn)
        return fail(app, drawn.error(), exit_bad_input);
    return 0;
}
