// SPDX-License-Identifier: MIT
//
// What is in a legacy VTK file, as it stands there: nothing is known yet to make sense.

#pragma once

#include "lib/result.hpp"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kb
{

/// Numbers of the points. Text is passed over.
struct VtkArray {
    std::string name;
    std::size_t components = 1;
    std::vector<double> values; ///< Of several components the magnitude.
};

struct LegacyVtk {
    bool is_polygonal = false; ///< Polygonal data, not an unstructured grid.
    std::vector<glm::dvec3> points;
    /// The points of cell i are connectivity[offsets[i]] to connectivity[offsets[i + 1] - 1]: all
    /// these elements are there. Vertices, lines and polygons of polygonal data are passed over.
    std::vector<std::int64_t> offsets;
    std::vector<std::int64_t> connectivity;
    std::vector<std::int64_t> cell_types;
    std::vector<VtkArray> point_arrays;
    bool has_cell_data = false;
};

/// Understands versions 1 to 5 of the format, ASCII and binary. Binary numbers of the wrong byte
/// order are an error that says so.
Result<LegacyVtk> parse_legacy_vtk(std::string_view text);

} // namespace kb
