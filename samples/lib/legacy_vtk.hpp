// SPDX-License-Identifier: MIT
//
// What is in a legacy VTK file, as it stands there: nothing is known yet to make sense.

#pragma once

#include "result.hpp"
#include "tet_grid.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace kb
{

enum class VtkDataSet { unstructured_grid, polygonal_data };

struct LegacyVtk {
    VtkDataSet data_set = VtkDataSet::unstructured_grid;
    std::vector<glm::vec3> points;
    /// The points of cell i are connectivity[offsets[i]] to connectivity[offsets[i + 1]], all of
    /// them there. Those of polygonal data are passed over.
    std::vector<std::int64_t> offsets;
    std::vector<std::int64_t> connectivity;
    std::vector<int> cell_types;
    std::vector<ScalarField> point_fields; ///< Of arrays with several components the magnitude.
    bool has_cell_data = false;
};

/// Reads versions 1 to 5 of the format, ASCII and binary.
Result<LegacyVtk> read_legacy_vtk(const std::filesystem::path &path);

} // namespace kb
