// SPDX-License-Identifier: MIT

#pragma once

#include "lib/result.hpp"

#include <glm/vec3.hpp>

#include <string>

namespace kb
{

/// Reads a color, red, green and blue from 0 to 1: one of CSS's basic names (in any case), #rrggbb
/// or #rgb in hexadecimal digits (the # may be missing), or three numbers from 0 to 1 with commas
/// between them.
Result<glm::vec3> parse_color(const std::string &text);

/// The forms of a color, for a help text.
inline constexpr const char *color_forms = "NAME|#rrggbb|R,G,B";

} // namespace kb
