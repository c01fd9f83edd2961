// SPDX-License-Identifier: MIT
//
// Tetrahedral grids and sets of points, with scalar fields: plain structs, legacy VTK files, a
// generated grid.

#pragma once

#include "lib/result.hpp"
#include "lib/scene/unit_sphere.hpp"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace kb
{

/// Where floats are too coarse for numbers (a pressure of 101325.01, coordinates on a map) there is
/// an offset of all: what is stored is what is left without it.
struct ScalarField {
    std::string name;
    std::vector<float> values; ///< One a point.
    double offset = 0.0;
    std::size_t components = 1; ///< Of the file's array; the values of several are magnitudes.
    std::string fault = {};     ///< Why it cannot be drawn; empty if it can.
};

/// Cells are oriented as VTK's: seen from point 3, points 0, 1, 2 go counterclockwise, so that
/// dot(cross(p1 - p0, p2 - p0), p3 - p0) is positive.
struct TetGrid {
    std::vector<glm::vec3> points;
    std::vector<glm::uvec4> cells;
    std::vector<ScalarField> fields;
    glm::dvec3 origin{0.0};        ///< The offset of the points.
    std::size_t unused_points = 0; ///< Of the file; left out, as no cell has them.
};

/// Particles.
struct PointSet {
    std::vector<glm::vec3> points;
    std::vector<ScalarField> fields;
    glm::dvec3 origin{0.0}; ///< The offset of the points.
};

/// The volume of a cell, negative if the cell is inverted; zero if what is left of it is no more
/// than the rounding of its computation.
double signed_volume(const TetGrid &grid, const glm::uvec4 &cell);

/// An error that names the first thing that makes the grid unfit for drawing: no cells, a
/// coordinate or value that is no finite number, a field that has not one value for each point (but
/// for fields whose fault is known), a cell with a point that is not there, an inverted cell or one
/// without volume.
Status check_tet_grid(const TetGrid &grid);

/// The same, of points and fields.
Status check_point_set(const PointSet &set);

/// Reads a legacy VTK file, ASCII or binary, with an unstructured grid of tetrahedra. The fields
/// are the arrays of its points that are no text; of a vector, the magnitude. What is wrong with a
/// field is its fault, and an error only of find_field. The grid has passed check_tet_grid.
Result<TetGrid> load_tet_grid(const std::filesystem::path &path);

/// The same, of a file's content.
Result<TetGrid> parse_tet_grid(std::string_view text);

/// What repair_tet_grid did.
struct GridRepairs {
    std::size_t left_out = 0; ///< Cells without volume.
    std::size_t turned = 0;   ///< Cells that were inverted.
};

/// A line for people.
std::string describe(const GridRepairs &repairs);

/// Leaves cells without volume out and turns inverted ones.
GridRepairs repair_tet_grid(TetGrid &grid);

/// Leaves points that no cell has out; how many.
std::size_t leave_out_unused_points(TetGrid &grid);

/// Makes one point of those that are in one place and have one value of a field of the grid, so
/// that cells with points of their own, as finite element codes write them, share their faces; how
/// many points fewer there are.
std::size_t join_points(TetGrid &grid, const ScalarField &field);

/// How many points both left out, for people; nothing of none.
std::string describe_left_out(std::size_t unused_points, std::size_t joined_points);

/// As load_tet_grid, but repairs the grid before it is checked.
Result<TetGrid> load_and_repair_tet_grid(const std::filesystem::path &path, GridRepairs &repairs);

/// Reads the points and their fields of a legacy VTK file, ASCII or binary, that holds polygonal
/// data or an unstructured grid, whatever cells it has. The set has passed check_point_set.
Result<PointSet> load_point_set(const std::filesystem::path &path);

/// The field of that name, or the first if the name is empty. An error tells its fault or lists the
/// names.
Result<const ScalarField *> find_field(const std::vector<ScalarField> &fields,
                                       std::string_view name);
inline Result<const ScalarField *> find_field(const TetGrid &grid, std::string_view name)
{
    return find_field(grid.fields, name);
}

/// How a cube becomes tetrahedra: 5 about a middle one, mirrored from cube to cube; 6 about a
/// diagonal; 24 about the middles of the cube and of its faces.
enum class CubeSplit { five = 5, six = 6, twenty_four = 24 };

struct GeneratedGrid {
    unsigned cubes = 16; ///< Along each edge of the box, from 1 to 256.
    CubeSplit split = CubeSplit::five;
    /// How far a point is moved at most along each axis, as a share of a cube's edge. Points of the
    /// box's surface stay on it.
    float jitter = 0.2F;
    /// The share of cells that get a point inside, next to one of their faces, and so become a
    /// sliver and three cells that are not.
    float sliver_share = 0.02F;
    /// The smallest volume of a sliver, as a share of its cell's. Larger ones are as frequent, in
    /// the logarithm.
    float thinnest = 1e-6F;
    std::uint32_t seed = 1;
};

/// A grid that fills the box from -1 to 1, with cells of positive volume and the fields "wave"
/// (smooth, with a gradient everywhere: generated_wave) and "distance" (from the middle of the
/// box). The same on every machine.
TetGrid make_tet_grid(const GeneratedGrid &wanted = {});

float generated_wave(glm::vec3 p);

/// Moves and scales the grid so that its bounding sphere about the middle of its box is the unit
/// sphere; the sphere that it had. Rounding moves points by 1e-7 at most; cells thinner than that
/// may become flat or inverted.
BoundingSphere fit_to_unit_sphere(TetGrid &grid);

} // namespace kb
