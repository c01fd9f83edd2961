// SPDX-License-Identifier: MIT

#pragma once

#include "lib/app/command_line.hpp"
#include "volume/sorted_faces.hpp"

namespace kb
{

/// --order centroid|nearest|cells
CLI::Option *add_order_option(CLI::App &app, FaceOrder &order);

/// --no-disorder
CLI::Option *add_disorder_option(CLI::App &app, bool &measure);

} // namespace kb
