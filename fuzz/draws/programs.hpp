// SPDX-License-Identifier: MIT
//
// The programs that sequences use: k-buffer programs, with the entries that each names, and
// fragment stages.

#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace kb::fuzz
{

struct KbufferText {
    std::string_view text;
    std::vector<int> entries; ///< Those that it names.
    bool valid = true;
    bool kills_all = false;
};

std::span<const KbufferText> kbuffer_texts();

/// GLSL; an empty source is no shader. The vertex shader is common to all.
struct FragmentStage {
    std::string_view geometry, fragment;
    bool integer = false; ///< Writes integers.
    bool stores = false;  ///< Images or atomic counters: not every driver has them.
};

std::span<const FragmentStage> fragment_stages();

std::string_view vertex_shader();

} // namespace kb::fuzz
