// SPDX-License-Identifier: MIT
//
// Iso-values, and the table by which a k-buffer program finds the ones next to a scalar by a single
// texture lookup, however many there are: only this texture knows them.

#pragma once

#include "lib/result.hpp"
#include "volume/sorted_faces.hpp"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <limits>
#include <span>
#include <string>
#include <vector>

namespace kb
{

struct IsoValue {
    double value = 0.0; ///< In the units of the field.
    glm::vec3 color{0.0F};
    float scalar = 0.0F; ///< The value as the scalars of fragments are: see normalized.
};

/// "0.25", "0.25,0.5" or "0.25=ff8000": values, each with a color or without. A value without one
/// gets a color of palette_color.
struct IsoRequest {
    double value = 0.0;
    bool has_color = false;
    glm::vec3 color{0.0F};
};
Result<IsoRequest> parse_iso_value(const std::string &text);

/// Of a scalar: from 0 to 1 over the range, (scalar - low) / (high - low).
float normalized(float scalar, const ScalarRange &range);

/// The iso-values with their scalars. Those out of the range have no surface and are left out.
std::vector<IsoValue> normalized(std::span<const IsoValue> values, const ScalarRange &range);

/// From blue for 0 over green to red for 1: clear colors of about the same lightness.
glm::vec3 palette_color(float position);

/// Texel i knows the iso-values near scalars within its width plus half of that at either end, so
/// that it does not matter to which of two texels rounding leads a scalar between them:
///
///     x = the next one below, y = the one inside, or else the next above, z = the next above y
///
/// The one at a scalar or next above it is then s <= y ? y : z, at it or next below s >= y ? y : x,
/// without any error. no_value stands for none.
struct IsoTable {
    static constexpr float no_value = std::numeric_limits<float>::max();

    std::vector<glm::vec4> neighbours;
    std::vector<glm::vec4> colors; ///< Of the one inside, RGB.

    /// The texture coordinate of a scalar is (s - base) * scale + offset.
    float base = 0.0F;
    float scale = 1.0F;
    float offset = 0.0F;
};

/// A table of the iso-values' scalars, which need not be sorted; of equal ones the first counts;
/// there may be none. An error if one is no finite number, or if two are so near to each other that
/// a table with a place for each has more than max_texels.
Result<IsoTable> make_iso_table(std::span<const IsoValue> values, int max_texels);

} // namespace kb
