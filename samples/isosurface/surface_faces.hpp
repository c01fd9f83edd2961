// SPDX-License-Identifier: MIT

#pragma once

#include "isosurface/iso_values.hpp"
#include "volume/faces.hpp"

#include <glm/vec4.hpp>

#include <span>

namespace kb
{

/// The faces of a grid's cells with those as inner ones that are between two cells without a
/// surface: a segment through both has none either. `values` are iso-values with their scalars.
FaceMesh mark_faces_without_surface(const FaceMesh &mesh, std::span<const glm::uvec4> cells,
                                    ScalarRange range, std::span<const IsoValue> values);

} // namespace kb
