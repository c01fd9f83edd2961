// SPDX-License-Identifier: MIT

#include "volume/order_option.hpp"

#include <CLI/CLI.hpp>

namespace kb
{

CLI::Option *add_order_option(CLI::App &app, FaceOrder &order)
{
    return app
        .add_option_function<std::string>(
            "--order",
            [&order](const std::string &word) {
                order = word == "cells"     ? FaceOrder::cells
                        : word == "nearest" ? FaceOrder::nearest_vertex
                                            : FaceOrder::centroid;
            },
            "A grid's faces are drawn in the order of their centroids, of their nearest vertices, "
            "or of the cells between them, which is right but where rays leave the grid and come "
            "back")
        ->check(CLI::IsMember({"centroid", "nearest", "cells"}))
        ->type_name("NAME")
        ->default_str("centroid");
}

CLI::Option *add_disorder_option(CLI::App &app, bool &measure)
{
    return app.add_flag(
        "!--no-disorder", measure,
        "Do not measure how far from depth order fragments arrive, and what that does to colors");
}

} // namespace kb
