// SPDX-License-Identifier: MIT

#pragma once

#include "lib/app/command_line.hpp"
#include "lib/scene/camera.hpp"
#include "volume/sorted_faces.hpp"
#include "volume/subdivide.hpp"

#include <glm/vec3.hpp>

#include <filesystem>
#include <string>

namespace kb
{

/// What is drawn and seen from where.
struct VolumeSceneOptions {
    std::filesystem::path grid; ///< Empty: one is generated.
    unsigned cubes = 16;        ///< Along an edge of the generated grid.
    bool repair = false;
    std::string field;             ///< Empty: the first.
    std::string transfer = "haze"; ///< A built-in function or a file.
    std::string transfer_points;   ///< The function itself, if not empty.
    OrbitCamera camera;
};

struct VolumeOptions {
    VolumeSceneOptions scene;
    bool list_fields = false; ///< That, and nothing else.
    Size size;
    int k = 6;
    bool exact = false;
    FaceOrder order = FaceOrder::centroid;
    bool all_faces = false; ///< Those within clusters of cells, too.
    double tolerance = 0.0; ///< Of colors, for clusters.
    double budget = 1.0;    ///< Triangles that are drawn, as a multiple of the faces.
    SplitFirst split_first = SplitFirst::longest;
    bool measure_disorder = true;
    glm::vec3 background{1.0F};
    int repeat = 1;
    std::string context = "osmesa";
    std::filesystem::path picture; ///< PNG
    std::filesystem::path floats;  ///< PFM
    std::filesystem::path json;
};

void declare_options(CLI::App &app, VolumeOptions &options);

} // namespace kb
