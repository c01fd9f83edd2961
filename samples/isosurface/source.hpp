// SPDX-License-Identifier: MIT

#pragma once

#include "fragment_stream.hpp"
#include "options.hpp"

#include <glm/vec3.hpp>

#include <memory>
#include <vector>

namespace kb
{

/// What has the surfaces, in the unit sphere: the faces of a grid, or particles.
struct Source {
    Medium medium = Medium::grid;
    GridRepairs repairs;
    FaceMesh faces;
    std::vector<glm::vec3> points;
    std::vector<float> scalars; ///< Of the points.
    ScalarRange range;
    FaceOrder order = FaceOrder::centroid;
};

/// Loads or generates it.
Result<Source> make_source(const IsosurfaceOptions &options);

Result<std::unique_ptr<FragmentStream>> make_stream(const Gl &gl, const Source &source,
                                                    float point_size);

} // namespace kb
