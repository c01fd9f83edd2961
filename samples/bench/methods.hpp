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

/// A form of a method that is measured in rows of its own.
struct Variant {
    std::string_view name;        ///< Empty: the method as it is meant to be used.
    std::string_view environment; ///< NAME=VALUE that its driver reads at the start, or empty.
};

inline constexpr std::array as_meant{Variant{}};

/// Early rejection of what cannot be kept, which llvmpipe leaves out if told so.
inline constexpr std::array culling_by_driver{Variant{}, Variant{"no-culling", "LP_KBUF_CULL=0"}};

/// Without culling a fragment takes the lock before it looks whether it is near enough. Without the
/// lock what happens is undefined in GL; llvmpipe, where one thread shades all of a pixel, is
/// right.
inline constexpr std::array k_plus_variants{Variant{}, Variant{"no-culling", ""},
                                            Variant{"unlocked", ""}};

/// The largest k of the study.
inline constexpr int max_k = 64;

struct Method {
    std::string_view name;
    std::string_view driver; ///< "stock" or "ours"
    int max_k;               ///< 0: the method takes no k.
    std::span<const Variant> variants = as_meant;
};

/// In the order of the report. Framebuffer fetch reaches 8 color attachments, of RGBA32F, which
/// hold two fragments each.
inline constexpr std::array methods{
    Method{"zbuffer", "stock", 0},
    Method{"classic-peeling", "stock", max_k},
    Method{"dual-peeling", "stock", max_k},
    Method{"fbfetch", "stock", 16},
    Method{"linked-list", "stock", max_k},
    Method{"k-plus", "stock", max_k, k_plus_variants},
    Method{"kbuffer-program", "ours", max_k},
    Method{"depth-peeling", "ours", max_k, culling_by_driver},
};

/// A variant of a method with its k (0 where it does not apply).
struct Run {
    std::string method;
    std::string variant;
    std::string driver;
    std::string environment;
    int k = 0;
};

/// What a run is called in file names and messages: "zbuffer", "fbfetch-8", "NAME-VARIANT-8".
std::string label(const Run &run);

/// All runs of the methods, in all their variants, with these k, without those that a method cannot
/// do. z-buffering is always among them: it is the base of the ratios.
std::vector<Run> plan_runs(std::span<const std::string> names, std::span<const int> ks);

} // namespace kb::bench
