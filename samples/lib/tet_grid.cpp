// SPDX-License-Identifier: MIT

#include "tet_grid.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace kb
{

double signed_volume(const TetGrid &grid, const glm::uvec4 &cell)
{
    const glm::dvec3 origin = grid.points[cell[0]];
    const glm::dvec3 a = glm::dvec3(grid.points[cell[1]]) - origin;
    const glm::dvec3 b = glm::dvec3(grid.points[cell[2]]) - origin;
    const glm::dvec3 c = glm::dvec3(grid.points[cell[3]]) - origin;
    const double determinant = glm::dot(glm::cross(a, b), c);
    // The determinant of three differences is a sum of six products: three roundings of each
    // difference, two products and three sums make less than 8 units of the sum of magnitudes.
    const glm::dvec3 magnitudes(std::abs(a.y * b.z) + std::abs(a.z * b.y),
                                std::abs(a.z * b.x) + std::abs(a.x * b.z),
                                std::abs(a.x * b.y) + std::abs(a.y * b.x));
    const double rounding =
        8.0 * (std::numeric_limits<double>::epsilon() / 2.0) * glm::dot(magnitudes, glm::abs(c));
    return std::abs(determinant) <= rounding ? 0.0 : determinant / 6.0;
}

static Status check_points(const std::vector<glm::vec3> &points,
                           const std::vector<ScalarField> &fields)
{
    const auto is_finite = [](float value) { return std::isfinite(value); };
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::vec3 &p = points[i];
        if (!is_finite(p.x) || !is_finite(p.y) || !is_finite(p.z))
            return Error{fmt::format("point {} is not finite", i)};
    }
    if (fields.empty())
        return Error{"it has no scalars at its points"};
    for (const ScalarField &field : fields) {
        if (field.values.size() != points.size())
            return Error{fmt::format("the field '{}' has {} values, but there are {} points",
                                     field.name, field.values.size(), points.size())};
        const auto bad = std::ranges::find_if_not(field.values, is_finite);
        if (bad != field.values.end())
            return Error{fmt::format("the value of '{}' at point {} is {}", field.name,
                                     bad - field.values.begin(),
                                     std::isnan(*bad) ? "not a number" : "infinite")};
    }
    return ok;
}

static Status check_cell_points(const TetGrid &grid)
{
    if (grid.cells.empty())
        return Error{"it has no cells"};
    for (std::size_t i = 0; i < grid.cells.size(); ++i) {
        for (int corner = 0; corner < 4; ++corner) {
            if (grid.cells[i][corner] >= grid.points.size())
                return Error{fmt::format("cell {} has point {}, but there are {} points", i,
                                         grid.cells[i][corner], grid.points.size())};
        }
    }
    return ok;
}

Status check_tet_grid(const TetGrid &grid)
{
    if (auto checked = check_cell_points(grid); !checked)
        return checked;
    if (auto checked = check_points(grid.points, grid.fields); !checked)
        return checked;
    for (std::size_t i = 0; i < grid.cells.size(); ++i) {
        const double volume = signed_volume(grid, grid.cells[i]);
        if (volume == 0.0)
            return Error{fmt::format("cell {} has no volume (--repair leaves such cells out)", i)};
        if (volume < 0.0)
            return Error{fmt::format("cell {} is inverted (--repair turns such cells)", i)};
    }
    return ok;
}

Status check_point_set(const PointSet &set)
{
    if (set.points.empty())
        return Error{"it has no points"};
    return check_points(set.points, set.fields);
}

std::string describe(const GridRepairs &repairs)
{
    return fmt::format("repaired: {} cells without volume left out, {} turned", repairs.left_out,
                       repairs.turned);
}

GridRepairs repair_tet_grid(TetGrid &grid)
{
    GridRepairs repairs;
    repairs.left_out = std::erase_if(
        grid.cells, [&grid](const glm::uvec4 &cell) { return signed_volume(grid, cell) == 0.0; });
    for (glm::uvec4 &cell : grid.cells) {
        if (signed_volume(grid, cell) < 0.0) {
            std::swap(cell[1], cell[2]);
            ++repairs.turned;
        }
    }
    return repairs;
}

Result<const ScalarField *> find_field(const std::vector<ScalarField> &fields,
                                       std::string_view name)
{
    if (fields.empty())
        return Error{"there are no scalar fields"};
    if (name.empty())
        return &fields.front();
    const auto found = std::ranges::find(fields, name, &ScalarField::name);
    if (found != fields.end())
        return &*found;
    std::string names;
    for (const ScalarField &field : fields)
        names += (names.empty() ? "" : ", ") + field.name;
    return Error{fmt::format("there is no scalar field '{}', but {}", name, names)};
}

BoundingSphere fit_to_unit_sphere(TetGrid &grid)
{
    return fit_to_unit_sphere(std::span(grid.points));
}

} // namespace kb
