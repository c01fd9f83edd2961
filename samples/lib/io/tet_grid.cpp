// SPDX-License-Identifier: MIT

#include "lib/io/tet_grid.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <array>
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
        if (!field.fault.empty())
            continue;
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

std::string describe_left_out(std::size_t unused_points, std::size_t joined_points)
{
    std::string text;
    if (unused_points > 0)
        text += fmt::format(", {} points that no cell has left out", unused_points);
    if (joined_points > 0)
        text += fmt::format(", {} points joined with others in their places", joined_points);
    return text;
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
    const auto found =
        name.empty() ? fields.begin() : std::ranges::find(fields, name, &ScalarField::name);
    if (found != fields.end() && found->fault.empty())
        return &*found;
    std::string names;
    for (const ScalarField &field : fields) {
        if (field.fault.empty())
            names += (names.empty() ? "" : ", ") + field.name;
    }
    if (names.empty())
        return Error{found == fields.end() ? fields.front().fault : found->fault};
    if (found == fields.end())
        return Error{fmt::format("there is no scalar field '{}', but {}", name, names)};
    return Error{fmt::format("{} (--field may be {})", found->fault, names)};
}

std::size_t leave_out_unused_points(TetGrid &grid)
{
    constexpr auto unused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> places(grid.points.size(), unused);
    for (const glm::uvec4 &cell : grid.cells) {
        for (int corner = 0; corner < 4; ++corner)
            places[cell[corner]] = 0;
    }
    std::uint32_t kept = 0;
    for (std::uint32_t &place : places)
        place = place == unused ? unused : kept++;
    if (kept == places.size())
        return 0;

    const auto compact = [&places, kept](auto &items) {
        if (items.size() != places.size())
            return; // Of a field with a fault.
        for (std::size_t i = 0; i < places.size(); ++i) {
            if (places[i] != unused)
                items[places[i]] = items[i];
        }
        items.resize(kept);
    };
    compact(grid.points);
    for (ScalarField &field : grid.fields)
        compact(field.values);
    for (glm::uvec4 &cell : grid.cells)
        cell = {places[cell[0]], places[cell[1]], places[cell[2]], places[cell[3]]};
    return places.size() - kept;
}

std::size_t join_points(TetGrid &grid, const ScalarField &field)
{
    // Places in the order of coordinates and value: equal ones follow one another, the first of
    // the grid first.
    std::vector<std::pair<std::array<float, 4>, std::uint32_t>> sorted;
    for (std::uint32_t i = 0; i < grid.points.size(); ++i) {
        const glm::vec3 &p = grid.points[i];
        sorted.push_back({{p.x, p.y, p.z, field.values[i]}, i});
    }
    std::ranges::sort(sorted);
    std::vector<std::uint32_t> first_of(sorted.size());
    std::uint32_t first = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        if (i == 0 || sorted[i].first != sorted[i - 1].first)
            first = sorted[i].second;
        first_of[sorted[i].second] = first;
    }
    for (glm::uvec4 &cell : grid.cells)
        cell = {first_of[cell[0]], first_of[cell[1]], first_of[cell[2]], first_of[cell[3]]};
    return leave_out_unused_points(grid);
}

BoundingSphere fit_to_unit_sphere(TetGrid &grid)
{
    return fit_to_unit_sphere(std::span(grid.points));
}

} // namespace kb
