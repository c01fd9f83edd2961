// SPDX-License-Identifier: MIT

#include "file.hpp"
#include "legacy_vtk.hpp"
#include "tet_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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

static Result<TetGrid> make_grid(LegacyVtk &&vtk)
{
    if (vtk.is_polygonal)
        return Error{"its data set is POLYDATA, not UNSTRUCTURED_GRID: a surface has no cells"};
    const std::size_t cells = vtk.offsets.empty() ? 0 : vtk.offsets.size() - 1;
    if (vtk.cell_types.size() != cells)
        return Error{
            fmt::format("there are {} cells, but {} cell types", cells, vtk.cell_types.size())};
    TetGrid grid;
    grid.cells.resize(cells);
    for (std::size_t i = 0; i < cells; ++i) {
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
            grid.cells[i][corner] = static_cast<std::uint32_t>(point);
        }
    }
    if (vtk.point_fields.empty() && vtk.has_cell_data)
        return Error{"it has values for its cells alone; scripts/convert-grid makes values of "
                     "points of them"};
    grid.points = std::move(vtk.points);
    grid.fields = std::move(vtk.point_fields);
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
    if (auto checked = check_tet_grid(*grid); !checked)
        return checked.error();
    return grid;
}

static Result<PointSet> parse_point_set(std::string_view text)
{
    auto vtk = parse_legacy_vtk(text);
    if (!vtk)
        return vtk.error();
    PointSet set{std::move(vtk->points), std::move(vtk->point_fields)};
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
