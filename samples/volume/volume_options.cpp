// SPDX-License-Identifier: MIT

#include "volume/volume_options.hpp"

#include "volume/order_option.hpp"
#include "volume/volume_program.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace kb
{

static void declare_scene_options(CLI::App &app, VolumeSceneOptions &options)
{
    app.add_option("--grid", options.grid,
                   "Legacy VTK file of tetrahedra; without, a grid is generated")
        ->type_name("FILE");
    app.add_option("--cubes", options.cubes,
                   "Cubes along an edge of the generated grid, each in 5 tetrahedra")
        ->check(integer_in(1, 256))
        ->type_name("N")
        ->capture_default_str();
    app.add_flag("--repair", options.repair,
                 "Leave cells without volume out of the file's grid and turn inverted ones");
    app.add_option("--field", options.field, "Scalar field of the grid, by default the first")
        ->type_name("NAME");
    auto *transfer =
        app.add_option(
               "--transfer", options.transfer,
               "Transfer function: haze, shells, or a file of lines of value, red, green, blue "
               "and extinction")
            ->type_name("NAME|FILE")
            ->capture_default_str();
    app.add_option("--transfer-points", options.transfer_points,
                   "Lines of such a file, with ; between them")
        ->excludes(transfer)
        ->type_name("TEXT");
    add_camera_options(app, options.camera);
}

void declare_options(CLI::App &app, VolumeOptions &options)
{
    declare_scene_options(app, options.scene);
    app.add_flag("--list-fields", options.list_fields,
                 "Print the grid's fields with their ranges, and draw nothing");
    app.add_option("--k", options.k,
                   fmt::format("Fragments that wait in the k-buffer, 1 to {} (with --exact: that a "
                               "pass takes)",
                               max_waiting(64)))
        ->check(integer_in(1, max_waiting(64)))
        ->type_name("N")
        ->capture_default_str();
    app.add_flag("--exact", options.exact,
                 "Put every fragment in its place, in as many passes as it takes");
    auto *all_faces =
        app.add_flag("--all-faces", options.all_faces, "Draw the faces that change nothing, too");
    app.add_option("--tolerance", options.tolerance,
                   "Leave faces out as long as no color can be off by more than this for it: cells "
                   "in which the scalar is nearly one linear function are joined. What is seen is "
                   "far less; 0 leaves out what changes nothing")
        ->check([](const std::string &text) { return check_number(text, 0.0, 16.0); })
        ->excludes(all_faces)
        ->type_name("X")
        ->default_str("0");
    add_order_option(app, options.order);
    app.add_option("--budget", options.budget,
                   "Subdivide faces until there are this many times as many, for less disorder")
        ->check([](const std::string &text) { return check_number(text, 1.0, 64.0); })
        ->type_name("X")
        ->default_str("1");
    app.add_option_function<std::string>(
           "--split-first",
           [&options](const std::string &word) {
               options.split_first = word == "longest" ? SplitFirst::longest : SplitFirst::thinnest;
           },
           "Triangles that --budget splits first: those with the longest edge, or the thinnest, "
           "by the ratio of longest to shortest edge")
        ->check(CLI::IsMember({"longest", "thinnest"}))
        ->type_name("NAME")
        ->default_str("longest");
    add_disorder_option(app, options.measure_disorder);
    add_background_option(app, options.background);
    add_context_option(app, options.context);
    add_size_option(app, options.size);
    app.add_option("--repeat", options.repeat, "Draw this many times and print the median time")
        ->check(integer_in(1, 10'000))
        ->type_name("N");
    app.add_option("--out", options.picture, "Write the picture")->type_name("FILE.png");
    app.add_option("--float-out", options.floats, "Write the picture before rounding")
        ->type_name("FILE.pfm");
    app.add_option("--json", options.json, "Write what was drawn and the times of each frame")
        ->type_name("FILE.json");
}

} // namespace kb
