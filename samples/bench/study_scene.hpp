// SPDX-License-Identifier: MIT
//
// The scenes of the study. The generated ones come from fixed seeds and from arithmetic that every
// platform does alike, so that figures of different machines are figures of the same geometry.

#pragma once

#include "lib/io/mesh.hpp"

#include <glm/mat4x4.hpp>

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace kb::bench
{

struct StudyScene {
    Mesh mesh;
    glm::mat4 projection{1.0F}; ///< Orthographic, stretched to the view if that is not square.
    std::string note;           ///< What a reader of the figures must know, or empty.
};

inline constexpr std::array few_ks{4, 8, 16};
inline constexpr std::array few_and_many_ks{4, 8, 16, 64};

struct SceneEntry {
    std::string_view name;
    std::span<const int> ks; ///< The k that its depth complexity gives a meaning to.
};

/// In the order of the report.
inline constexpr std::array scenes{
    SceneEntry{"dragon", few_ks},
    SceneEntry{"spheres", few_and_many_ks},
    SceneEntry{"quads", few_and_many_ks},
};

/// The k of the scene of that name.
std::span<const int> default_ks(std::string_view scene);

/// 300 tessellated spheres of random place and size, nested and crossing in a ball: 1,008,000
/// triangles.
StudyScene make_spheres();

/// 128 quads, each over the same half of the view, in shuffled order of depth.
StudyScene make_quads();

/// Colors the mesh by its normals and frames it to fill the view.
StudyScene make_mesh_scene(Mesh mesh);

/// The scene of that name. `dragon` is the file of the dragon's mesh: when there is none, a
/// generated mesh of similar size takes its place and the note says so.
Result<StudyScene> make_scene(const std::string &name, const std::filesystem::path &dragon);

} // namespace kb::bench
