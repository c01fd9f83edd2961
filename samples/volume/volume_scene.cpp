// SPDX-License-Identifier: MIT

#include "volume/volume_scene.hpp"

#include "volume/sorted_faces.hpp"

#include <algorithm>

namespace kb
{

static Result<TetGrid> make_grid(const VolumeSceneOptions &options, GridRepairs &repairs)
{
    if (options.grid.empty())
        return make_tet_grid({.cubes = options.cubes});
    return options.repair ? load_and_repair_tet_grid(options.grid, repairs)
                          : load_tet_grid(options.grid);
}

static Result<TransferFunction> make_transfer(const VolumeSceneOptions &options, ScalarRange range)
{
    if (!options.transfer_points.empty()) {
        std::string text = options.transfer_points;
        std::ranges::replace(text, ';', '\n');
        return parse_transfer_function(text, range);
    }
    const auto names = transfer_function_names();
    if (std::ranges::find(names, options.transfer) != names.end())
        return find_transfer_function(options.transfer);
    return load_transfer_function(options.transfer, range);
}

Result<VolumeScene> make_volume_scene(const VolumeSceneOptions &options)
{
    GridRepairs repairs;
    auto grid = make_grid(options, repairs);
    if (!grid)
        return grid.error();
    const auto field = find_field(*grid, options.field);
    if (!field)
        return field.error();
    const std::size_t joined = options.grid.empty() ? 0 : join_points(*grid, **field);
    const ScalarRange range = range_of(**field);
    auto transfer = make_transfer(options, range);
    if (!transfer)
        return transfer.error();

    const BoundingSphere sphere = fit_to_unit_sphere(*grid);
    const glm::dvec3 center = grid->origin + glm::dvec3(sphere.center);
    FaceMesh faces = make_face_mesh(*grid, **field);
    const std::string name = (*field)->name;
    const std::string description = describe_field(**field);
    return VolumeScene{std::move(*grid), repairs,
                       joined,           name,
                       description,      range,
                       center,           sphere.radius,
                       std::move(faces), std::move(*transfer)};
}

Result<std::string> list_fields(const VolumeSceneOptions &options)
{
    GridRepairs repairs;
    const auto grid = make_grid(options, repairs);
    if (!grid)
        return grid.error();
    return list_fields(grid->fields);
}

} // namespace kb
