// SPDX-License-Identifier: MIT
//
// The command line of kbuffer-bench.

#pragma once

#include "lib/app/command_line.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace kb::bench
{

struct Options {
    std::vector<std::string> scenes;
    std::vector<std::string> methods;
    std::vector<int> ks; ///< Empty: those of each scene.
    int rounds = 15;
    Size size;
    std::filesystem::path stock = "build/stock-prefix";
    std::filesystem::path ours = "build/prefix";
    std::filesystem::path dragon = "build/data/dragon.ply";
    std::filesystem::path out = "build/report/results.json";
    std::filesystem::path pictures; ///< Folder for the picture of each row, or empty for none.
    std::string commit;             ///< Of the project, for the record.
    bool quick = false;
    bool worker = false; ///< This process is one of the two that draw.
};

/// Fills the options from the command line. Returns the exit status with which the program ends
/// now, if it does.
std::optional<int> parse_options(CLI::App &app, Options &options, int argc,
                                 const char *const *argv);

} // namespace kb::bench
