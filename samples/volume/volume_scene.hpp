// SPDX-License-Identifier: MIT

#pragma once

#include "volume/faces.hpp"
#include "volume/transfer_function.hpp"
#include "volume/volume_options.hpp"

#include <glm/vec3.hpp>

#include <string>

namespace kb
{

/// What is drawn: the grid in the unit sphere.
struct VolumeScene {
    TetGrid grid;
    GridRepairs repairs;
    std::size_t joined_points = 0; ///< See join_points.
    std::string field;
    std::string field_description;
    ScalarRange range; ///< Of the field.
    glm::dvec3 center; ///< Of the grid as it came: a point p is now (p - center) / radius.
    float radius;
    FaceMesh faces;
    TransferFunction transfer; ///< Normalized to the range.
};

/// Errors are those of the input.
Result<VolumeScene> make_volume_scene(const VolumeSceneOptions &options);

/// The grid's fields for people, see list_fields.
Result<std::string> list_fields(const VolumeSceneOptions &options);

} // namespace kb
