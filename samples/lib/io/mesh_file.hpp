// SPDX-License-Identifier: MIT
//
// The readers of mesh files, one a format. load_mesh makes of what they give what can be drawn.

#pragma once

#include "lib/result.hpp"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace kb
{

/// The triangles of a file, in the file's own units and precision.
struct FileMesh {
    std::string format; ///< For people, for example "binary PLY".
    std::vector<glm::dvec3> positions;
    std::vector<glm::vec3> normals; ///< One a vertex, or empty. A missing one is zero.
    std::vector<glm::vec4> colors;  ///< RGBA, one a vertex, or empty: the file gives none.
    std::string colors_of; ///< What the file gives colors to, for example "vertices"; else empty.
    std::vector<std::uint32_t> indices; ///< Three a triangle; each has a vertex.
    std::vector<std::string> notes;     ///< What the file has and is left out, one line each.
};

/// ASCII and binary of both byte orders; faces of any number of corners and triangle strips, in any
/// order of elements and properties; colors and alpha of vertices or faces.
Result<FileMesh> read_ply(std::string_view content);

/// Polygons, with the colors (Kd) and opacities (d, Tr) of the material libraries beside the file,
/// and colors that follow the coordinates of vertices.
Result<FileMesh> read_obj(std::string_view content, const std::filesystem::path &directory);

/// ASCII and binary; colors of facets as VisCAM and Magics write them. Without a normal a facet has
/// that of its plane.
Result<FileMesh> read_stl(std::string_view content);

/// glTF 2.0 as JSON or .glb, with buffers in it or beside it: the triangles of the scene, with the
/// transforms of their nodes, colors of vertices and materials. Without normals a triangle has that
/// of its plane.
Result<FileMesh> read_gltf(std::string_view content, const std::filesystem::path &directory);

} // namespace kb
