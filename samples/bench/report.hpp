// SPDX-License-Identifier: MIT
//
// Results as JSON and as a table to read.

#pragma once

#include "lib/app/timing.hpp"
#include "lib/io/image.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace kb::bench
{

struct Row {
    std::string scene;
    std::string method;
    std::string variant; ///< Empty: the method as it is meant to be used.
    std::string driver;
    int k = 0;
    int passes = 1; ///< Over the geometry.
    std::uint64_t triangles = 0;
    std::uint64_t fragments = 0; ///< Of one pass over the geometry without a depth test.
    Spread ms;
    Spread ratio; ///< Of each frame to the z-buffered one right before it.
    int bytes_per_pixel = 0;
    Difference error;     ///< Against the exact image of the same k.
    Difference error_all; ///< Against the exact image of all fragments.
};

nlohmann::json to_json(const nlohmann::json &machine, std::span<const Row> rows);

/// Each time also as a ratio to z-buffering, and those of the patched Mesa as ratios to
/// framebuffer fetch with the same k.
std::string to_table(std::span<const Row> rows);

/// Finds out before any work whether the results, and pictures of any methods (none if empty), can
/// be written; makes their folders.
Status prepare_outputs(const std::filesystem::path &results, const std::filesystem::path &pictures);

Status write_json(const std::filesystem::path &path, const nlohmann::json &document);

} // namespace kb::bench
