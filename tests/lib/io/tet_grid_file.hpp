// SPDX-License-Identifier: MIT

#pragma once

#include "lib/io/tet_grid.hpp"

#include <string>

namespace kb::test
{

/// What a legacy VTK file of this grid holds, in the form of version 3, or that of version 5.1.
enum class VtkForm { ascii, binary, ascii_5, binary_5 };
std::string vtk_file(const TetGrid &grid, VtkForm form);

/// Two cells that share a face, with the fields "temperature" and "pressure".
TetGrid two_cells();

} // namespace kb::test
