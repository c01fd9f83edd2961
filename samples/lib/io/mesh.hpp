// SPDX-License-Identifier: MIT
//
// Triangle meshes: a plain struct, meshes of files, generated models.

#pragma once

#include "lib/result.hpp"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace kb
{

struct Mesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals; ///< One a vertex.
    std::vector<glm::vec4> colors;  ///< RGBA, one a vertex, or empty: then the sample chooses.
    std::vector<std::uint32_t> indices;

    std::size_t triangle_count() const { return indices.size() / 3; }
};

/// An error that names the first thing that makes the mesh unfit for drawing: no triangles, lists
/// of different lengths, a coordinate that is no finite number, an index without a vertex.
Status check_mesh(const Mesh &mesh);

/// A mesh of a file, and what to tell about it.
struct LoadedMesh {
    Mesh mesh;             ///< Fills the unit sphere. Has passed check_mesh.
    std::string format;    ///< For people, for example "binary PLY".
    std::string colors_of; ///< What the file gives colors to, for example "vertices"; else empty.
    glm::dvec3 center;     ///< Of the file's mesh, in its units.
    double radius;         ///< Of the sphere about it, in the file's units.
    std::vector<std::string> notes; ///< What the file has and is left out, one line each.
};

/// Reads OBJ, PLY, STL or glTF 2.0, by the ending of the file's name. Polygons are cut into
/// triangles, points and lines left out, missing normals computed, vertices without a triangle
/// forgotten. Coordinates are rounded to floats when they are in the unit sphere.
Result<LoadedMesh> load_mesh(const std::filesystem::path &path);

/// Makes one vertex of those that are the same in all bits; triangles keep their order.
void join_identical_vertices(Mesh &mesh);

/// Moves and scales the mesh so that its bounding sphere about the middle of its box is the unit
/// sphere.
void fit_to_unit_sphere(Mesh &mesh);

/// A translucent model for those who have none at hand: a tube within a tube along a trefoil knot,
/// colored along its way, with about the given number of triangles. Up to 8 fragments meet.
Mesh make_knot(std::size_t triangles);

void append_sphere(Mesh &mesh, glm::vec3 center, float radius, glm::vec4 color, int slices,
                   int stacks);

/// The parallelogram of a corner and two edges, with the normal cross(u, v).
void append_quad(Mesh &mesh, glm::vec3 corner, glm::vec3 u, glm::vec3 v, glm::vec4 color);

} // namespace kb
