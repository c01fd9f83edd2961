// SPDX-License-Identifier: MIT
//
// What `volume --json` says it drew: enough to draw the same by other means.

#pragma once

#include "tests/integrator/integrator.hpp"

#include "lib/io/tet_grid.hpp"
#include "lib/result.hpp"

#include <filesystem>

namespace kb::integrator
{

struct Scene {
    TetGrid grid; ///< Fitted to the unit sphere.
    std::vector<float> scalars;
    Medium medium;
    View view;
    glm::dvec3 background;

    Volume volume() const { return {{grid.points, grid.cells, scalars}, view, medium, background}; }
};

Result<Scene> load_scene(const std::filesystem::path &path);

} // namespace kb::integrator
