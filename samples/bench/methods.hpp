// SPDX-License-Identifier: MIT
//
// The methods of the study and the runs that a command line asks for.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kb::bench
{

struct Method {
    std::string_view name;
    std::string_view driver; // "stock" or "ours"
    bool takes_k;
};

/// In the order of the report.
inline constexpr std::array methods{
    Method{"zbuffer", "stock", false},
    Method{"classic-peeling", "stock", true},
    Method{"fbfetch", "stock", true},
    Method{"kbuffer-program", "ours", true},
};

/// A method with its k (0 where it does not apply).
struct Run {
    std::string method;
    std::string driver;
    int k = 0;
};

/// Entries of RGBA32F hold two fragments each, and framebuffer fetch reaches 8 color attachments.
inline constexpr int max_fbfetch_k = 16;

/// All runs of the methods with these k, without those that a method cannot do. z-buffering is
/// always among them: it is the base of the ratios.
std::vector<Run> plan_runs(std::span<const std::string> names, std::span<const int> ks);

} // namespace kb::bench
