// SPDX-License-Identifier: MIT
//
// The background of exact.hpp in the forms that GL takes.

#pragma once

#include "bench/exact.hpp"

#include <fmt/format.h>

#include <array>
#include <string>

namespace kb::bench
{

inline constexpr std::array<float, 4> background_color{static_cast<float>(background.x),
                                                       static_cast<float>(background.y),
                                                       static_cast<float>(background.z), 1.0F};

inline std::string background_glsl()
{
    return fmt::format("vec3({}, {}, {})", background.x, background.y, background.z);
}

} // namespace kb::bench
