// SPDX-License-Identifier: MIT

#pragma once

#include "isosurface/iso_program.hpp"
#include "isosurface/iso_values.hpp"
#include "lib/app/command_line.hpp"
#include "transparency/output.hpp"
#include "volume/sorted_faces.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace kb
{

struct IsosurfaceOptions {
    std::string grid; ///< A file; empty: a grid is generated.
    bool repair = false;
    bool has_particles = false; ///< Particles, not a grid.
    std::string particles;      ///< A file; empty: particles are generated.
    int particle_count = 200'000;
    std::string field;        ///< Empty: the first.
    bool list_fields = false; ///< That, and nothing else.
    std::vector<IsoRequest> iso_values;
    int levels = 3; ///< So many iso-values if none was given.
    int k = 6;
    FaceOrder order = FaceOrder::centroid; ///< Of a grid.
    std::optional<float> point_size;       ///< In the scene, which is the unit sphere.
    std::optional<float> gap;
    std::optional<int> smoothing;
    bool silhouettes = true;
    bool measure_disorder = true;
    glm::vec3 background{1.0F};
    OrbitCamera camera;
    Size size;
    int repeat = 1;
    std::string context = "osmesa";
    OutputPaths outputs;            ///< Only the pictures.
    std::filesystem::path surfaces; ///< PFM of distance and iso-value.
    std::filesystem::path json;
};

void declare_options(CLI::App &app, IsosurfaceOptions &options);

/// What no single option can know.
Status check_options(const IsosurfaceOptions &options);

/// The iso-values for a field of that range, in its units; none if none was asked for and the field
/// does not vary.
std::vector<IsoValue> choose_iso_values(const IsosurfaceOptions &options, const ScalarRange &range);

} // namespace kb
