// SPDX-License-Identifier: MIT

#pragma once

#include "lib/app/command_line.hpp"
#include "lib/gl/depth_peeling.hpp"
#include "transparency/output.hpp"
#include "transparency/scene_options.hpp"

#include <filesystem>
#include <string>

namespace kb
{

struct PeelingOptions {
    SceneOptions scene;
    PeelingLayers layers;
    bool all = false;
    int repeat = 1;
    std::string context = "osmesa";
    OutputPaths outputs;   ///< Only the picture.
    std::string directory; ///< For composite and layers; empty: none.
    bool floats = false;
    std::filesystem::path json;
};

void declare_options(CLI::App &app, PeelingOptions &options);

/// The word of --func, --depth-format or --color-format for a GL value.
std::string word_of(GLenum value);

/// What no single option can know.
Status check_options(const PeelingOptions &options);

} // namespace kb
