// SPDX-License-Identifier: MIT

#pragma once

#include "lib/io/image.hpp"
#include "volume/disorder.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace kb
{

/// How far from depth order the fragments of a picture arrived, and what that did to its colors.
struct DisorderReport {
    Disorder fragments;
    std::optional<Difference> colors; ///< Against the exact picture; none if it is exact itself.
};

/// Of the pixels that have a fragment; `share` is of those that are off by more than 1/255.
Result<Difference> color_error(const ImageRgbaF &picture, const ImageRgbaF &exact,
                               std::uint64_t pixels);

/// A line for people, of a picture by a k-buffer in which k fragments wait.
std::string describe(const DisorderReport &report, int k);

} // namespace kb
