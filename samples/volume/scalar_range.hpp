// SPDX-License-Identifier: MIT

#pragma once

#include "lib/io/tet_grid.hpp"

#include <span>
#include <string>

namespace kb
{

/// The extent of the scalars of a grid, which is never nothing. In the units of the field they are
/// `offset` more, see ScalarField.
struct ScalarRange {
    float low = 0.0F;
    float high = 1.0F;
    double offset = 0.0;
    bool varies = true; ///< Else all scalars are `low`, and `high` is only some number above.

    double in_units(float scalar) const { return offset + double(scalar); }
};

ScalarRange range_of(std::span<const float> values);
ScalarRange range_of(const ScalarField &field);

/// A value in the units of the field, with the digits that tell values of the range apart.
std::string describe_value(double value, const ScalarRange &range);

/// "field 'p' from 101325 to 101325.04", "magnitude of the field 'v' is 5 everywhere"
std::string describe_field(const ScalarField &field);

/// A line for each field: its name, and its range or why it cannot be drawn.
std::string list_fields(std::span<const ScalarField> fields);

} // namespace kb
