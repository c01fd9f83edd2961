// SPDX-License-Identifier: MIT
//
// What the samples that draw a mesh tell about it: for people, and for programs as JSON.

#pragma once

#include "lib/io/image.hpp"
#include "transparency/scene_options.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>

namespace kb
{

/// One line: which mesh, its size and where its colors are from.
std::string describe(const SceneMesh &scene, const SceneOptions &options);

/// Prints on the standard error output, a line each, what of the file is left out.
void print_notes(const std::string &program, const SceneMesh &scene);

/// Prints on the standard error output that there is nothing to be seen, if that is so.
void print_emptiness(const std::string &program, const ImageRgbaF &picture, glm::vec3 background,
                     const AlphaRange &alpha);

/// The mesh, the camera and the version; a sample adds what it did.
nlohmann::json mesh_report(const SceneMesh &scene, const SceneOptions &options);

} // namespace kb
