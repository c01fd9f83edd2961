// SPDX-License-Identifier: MIT
//
// The part of the command line that says what is drawn and seen from where.

#pragma once

#include "camera.hpp"
#include "command_line.hpp"
#include "mesh.hpp"

#include <optional>
#include <string>

namespace kb
{

struct SceneOptions {
    std::string mesh;           ///< A file; empty: a knot is generated.
    int triangles = 100000;     ///< Of the knot.
    std::optional<float> alpha; ///< Of all fragments, instead of the mesh's.
    OrbitCamera camera;
};

/// --mesh, --triangles, --alpha, --azimuth and --elevation.
void add_scene_options(
    CLI::App &app, SceneOptions &options,
    const std::string &alpha_help = "Alpha of all fragments, 0 to 1, instead of the mesh's");

/// Loads or generates the mesh, which fills the unit sphere.
Result<Mesh> make_mesh(const SceneOptions &options);

} // namespace kb
