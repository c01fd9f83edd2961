// SPDX-License-Identifier: MIT

#include "lib/io/file.hpp"
#include "lib/io/legacy_vtk.hpp"
#include "lib/io/tet_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace kb
{

static constexpr int vtk_tetra = 10;

static std::string cell_type_name(std::int64_t type)
{
    // VTK's numbers; a pixel and a voxel are a rectangle and a box along the axes.
    static constexpr std::array<const char *, 15> names{
        nullptr,      "a vertex",         "a set of vertices", "a line",  "a line",
        "a triangle", "a triangle strip", "a polygon",         "a pixel", "a quadrilateral",
        nullptr,      "a voxel",          "a hexahedron",      "a wedge", "a pyramid"};
    const auto place = static_cast<std::size_t>(type);
    const char *const name = place < names.size() ? names[place] : nullptr;
    return fmt::format("{} (type {})", name ? name : "no tetrahedron", type);
}

namespace
{

/// Sums of a few numbers of this magnitude are still finite as floats.
constexpr double greatest = 0x1p125;

/// What is wrong with a number of a file; empty if nothing is.
std::string fault_of(double number)
{
    if (std::isnan(number))
        return "not a number";
    if (std::isinf(number))
        return "infinite";
    return std::abs(number) > greatest ? fmt::format("{:g}, more than {:.1e}", number, greatest)
                                       : std::string();
}

/// Numbers as floats, and what has to be added to them.
struct Floats {
    std::vector<float> values;
    double offset;
};

/// Takes an offset off numbers of which those count that are chosen, if rounding them to floats as
/// they are loses more than rounding what is left.
template <class Chosen>
Floats to_floats(std::span<const double> numbers, const Chosen &is_chosen)
{
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    double loss = 0.0;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (!is_chosen(i) || !std::isfinite(static_cast<float>(numbers[i])))
            continue;
        low = std::min(low, numbers[i]);
        high = std::max(high, numbers[i]);
        loss = std::max(loss, std::abs(numbers[i] - double(static_cast<float>(numbers[i]))));
    }
    // Half a unit in the last place of floats as large as the extent.
    const bool is_far = low <= high && loss > (high - low) * 0x1p-24;
    Floats floats{std::vector<float>(numbers.size()), is_far ? low : 0.0};
    for (std::size_t i = 0; i < numbers.size(); ++i)
        floats.values[i] = static_cast<float>(numbers[i] - floats.offset);
    return floats;
}

/// The points of a file, of which those count that are chosen.
template <class Chosen>
Status take_points(std::span<const glm::dvec3> points, const Chosen &is_chosen,
                   std::vector<glm::vec3> &taken, glm::dvec3 &origin)
{
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3 &p = points[i];
        if (!is_chosen(i))
            continue;
        if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)))
            return Error{fmt::format("point {} is not finite", i)};
        for (int axis = 0; axis < 3; ++axis) {
            if (const std::string fault = fault_of(p[axis]); !fault.empty())
                return Error{fmt::format("point {} has the coordinate {}", i, fault)};
        }
    }
    taken.resize(points.size());
    std::vector<double> coordinates(points.size());
    for (int axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < points.size(); ++i)
            coordinates[i] = points[i][axis];
        const Floats floats = to_floats(coordinates, is_chosen);
        origin[axis] = floats.offset;
        for (std::size_t i = 0; i < points.size(); ++i)
            taken[i][axis] = floats.values[i];
    }
    return ok;
}

/// The arrays of a file's points, of which those count that are chosen.
template <class Chosen>
std::vector<ScalarField> take_fields(std::vector<VtkArray> &&arrays, std::size_t points,
                                     const Chosen &is_chosen)
{
    std::vector<ScalarField> fields;
    for (VtkArray &array : arrays) {
        ScalarField field;
        field.name = std::move(array.name);
        field.components = array.components;
        if (array.values.size() != points) {
            field.fault = fmt::format("the field '{}' has {} values, but there are {} points",
                                      field.name, array.values.size(), points);
            fields.push_back(std::move(field));
            continue;
        }
        Floats floats = to_floats(array.values, is_chosen);
        field.values = std::move(floats.values);
        field.offset = floats.offset;
        for (std::size_t i = 0; i < points && field.fault.empty(); ++i) {
            const std::string fault = is_chosen(i) ? fault_of(array.values[i]) : std::string();
            if (!fault.empty())
                field.fault =
                    fmt::format("the value of '{}' at point {} is {}", field.name, i, fault);
        }
        fields.push_back(std::move(field));
    }
    return fields;
}

Result<std::vector<glm::uvec4>> take_cells(const LegacyVtk &vtk)
{
    const std::size_t count = vtk.offsets.empty() ? 0 : vtk.offsets.size() - 1;
    if (vtk.cell_types.size() != count)
        return Error{
            fmt::format("there are {} cells, but {} cell types", count, vtk.cell_types.size())};
    std::vector<glm::uvec4> cells(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::int64_t size = vtk.offsets[i + 1] - vtk.offsets[i];
        if (vtk.cell_types[i] != vtk_tetra)
            return Error{fmt::format("cell {} is {}; scripts/convert-grid makes tetrahedra of it",
                                     i, cell_type_name(vtk.cell_types[i]))};
        if (size != 4)
            return Error{fmt::format("cell {} is a tetrahedron of {} points", i, size)};
        for (int corner = 0; corner < 4; ++corner) {
            const std::int64_t point =
                vtk.connectivity[static_cast<std::size_t>(vtk.offsets[i] + corner)];
            // Before it is narrowed; check_tet_grid says the same of grids from elsewhere.
            if (static_cast<std::size_t>(point) >= vtk.points.size())
                return Error{fmt::format("cell {} has point {}, but there are {} points", i, point,
                                         vtk.points.size())};
            cells[i][corner] = static_cast<std::uint32_t>(point);
        }
    }
    return cells;
}

} // namespace

static Result<TetGrid> make_grid(LegacyVtk &&vtk)
{
    if (vtk.is_polygonal)
        return Error{"its data set is POLYDATA, not UNSTRUCTURED_GRID: a surface has no cells"};
    auto cells = take_cells(vtk);
    if (!cells)
        return cells.error();
    if (vtk.point_arrays.empty() && vtk.has_cell_data)
        return Error{"it has values for its cells alone; scripts/convert-grid makes values of "
                     "points of them"};
    TetGrid grid;
    grid.cells = std::move(*cells);
    std::vector<bool> used(vtk.points.size());
    for (const glm::uvec4 &cell : grid.cells) {
        for (int corner = 0; corner < 4; ++corner)
            used[cell[corner]] = true;
    }
    const auto is_used = [&used](std::size_t i) { return used[i]; };
    if (auto taken = take_points(vtk.points, is_used, grid.points, grid.origin); !taken)
        return taken.error();
    grid.fields = take_fields(std::move(vtk.point_arrays), vtk.points.size(), is_used);
    return grid;
}

static Result<TetGrid> parse(std::string_view text, GridRepairs *repairs)
{
    auto vtk = parse_legacy_vtk(text);
    if (!vtk)
        return vtk.error();
    auto grid = make_grid(std::move(*vtk));
    if (!grid)
        return grid;
    if (repairs)
        *repairs = repair_tet_grid(*grid);
    grid->unused_points = leave_out_unused_points(*grid);
    if (auto checked = check_tet_grid(*grid); !checked)
        return checked.error();
    return grid;
}

static Result<PointSet> parse_point_set(std::string_view text)
{
    auto vtk = parse_legacy_vtk(text);
    if (!vtk)
        return vtk.error();
    const auto is_chosen = [](std::size_t) { return true; };
    PointSet set;
    if (auto taken = take_points(vtk->points, is_chosen, set.points, set.origin); !taken)
        return taken.error();
    set.fields = take_fields(std::move(vtk->point_arrays), vtk->points.size(), is_chosen);
    if (auto checked = check_point_set(set); !checked)
        return checked.error();
    return set;
}

template <class Parse>
static auto load(const char *what, const std::filesystem::path &path, const Parse &parse_text)
    -> decltype(parse_text(std::string()))
{
    const auto fail = [&](const Error &error) {
        return Error{fmt::format("cannot read the {} {}: {}", what, path.string(), error.message)};
    };
    const auto text = read_file(path);
    if (!text)
        return fail(text.error());
    auto loaded = parse_text(*text);
    if (!loaded)
        return fail(loaded.error());
    return loaded;
}

Result<TetGrid> parse_tet_grid(std::string_view text)
{
    return parse(text, nullptr);
}

Result<TetGrid> load_tet_grid(const std::filesystem::path &path)
{
    return load("grid", path, parse_tet_grid);
}

Result<TetGrid> load_and_repair_tet_grid(const std::filesystem::path &path, GridRepairs &repairs)
{
    return load("grid", path, [&](std::string_view text) { return parse(text, &repairs); });
}

Result<PointSet> load_point_set(const std::filesystem::path &path)
{
    return load("points", path, parse_point_set);
}

} // namespace kb
