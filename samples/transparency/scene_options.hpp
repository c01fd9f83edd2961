// SPDX-License-Identifier: MIT
//
// The part of the command line that says what is drawn and seen from where.

#pragma once

#include "lib/app/command_line.hpp"
#include "lib/io/mesh.hpp"
#include "lib/scene/camera.hpp"

#include <optional>
#include <string>
#include <vector>

namespace kb
{

struct SceneOptions {
    std::string mesh;               ///< A file; empty: a knot is generated.
    int triangles = 100000;         ///< Of the knot.
    std::optional<glm::vec3> color; ///< Of all fragments, instead of the mesh's.
    std::optional<float> alpha;     ///< Of all fragments, instead of the mesh's.
    OrbitCamera camera;
};

/// --mesh, --triangles, --color, --alpha, --azimuth and --elevation.
void add_scene_options(
    CLI::App &app, SceneOptions &options,
    const std::string &alpha_help = "Alpha of all fragments, 0 to 1, instead of the mesh's");

/// What is drawn, and what to tell about it.
struct SceneMesh {
    Mesh mesh;             ///< Fills the unit sphere. Has colors.
    std::string file;      ///< Empty: the mesh was generated.
    std::string format;    ///< Of the file.
    std::string colors_of; ///< Where its colors are from: what of the file, option or default.
    glm::dvec3 center = glm::dvec3(0.0); ///< In the units of the file.
    double radius = 1.0;
    std::vector<std::string> notes; ///< What of the file is left out, one line each.
};

/// Loads or generates the mesh. One without colors gets the default color.
Result<SceneMesh> make_mesh(const SceneOptions &options);

/// Lowest and highest of the mesh's alphas, or of the one that replaces them.
struct AlphaRange {
    float low;
    float high;
};
AlphaRange alpha_range(const Mesh &mesh, std::optional<float> alpha);

} // namespace kb
