// SPDX-License-Identifier: MIT

#pragma once

#include "isosurface/fragment_stream.hpp"
#include "isosurface/iso_values.hpp"
#include "isosurface/options.hpp"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace kb
{

/// What has the surfaces, in the unit sphere: the faces of a grid, or particles.
struct Source {
    Medium medium = Medium::grid;
    GridRepairs repairs;
    std::size_t unused_points = 0; ///< Of the grid's file; left out.
    std::size_t joined_points = 0; ///< See join_points.
    FaceMesh faces;
    std::vector<glm::uvec4> cells; ///< Of the grid.
    std::vector<glm::vec3> points;
    std::vector<float> scalars; ///< Of the points.
    std::string field;
    std::string field_description;
    ScalarRange range;
    FaceOrder order = FaceOrder::centroid;
};

/// Loads or generates it.
Result<Source> make_source(const IsosurfaceOptions &options);

/// Its fields for people, see list_fields.
Result<std::string> list_fields(const IsosurfaceOptions &options);

/// For iso-values with their scalars. Of a grid the faces that are next to a surface.
Result<std::unique_ptr<FragmentStream>>
make_stream(const Gl &gl, const Source &source, std::span<const IsoValue> values, float point_size);

} // namespace kb
