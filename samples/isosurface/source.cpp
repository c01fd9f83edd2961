// SPDX-License-Identifier: MIT

#include "isosurface/source.hpp"

#include "isosurface/particles.hpp"
#include "isosurface/surface_faces.hpp"
#include "lib/scene/unit_sphere.hpp"

namespace kb
{

static Result<TetGrid> make_grid(const IsosurfaceOptions &options, GridRepairs &repairs)
{
    if (options.grid.empty())
        return make_tet_grid();
    return options.repair ? load_and_repair_tet_grid(options.grid, repairs)
                          : load_tet_grid(options.grid);
}

static void take_field(Source &source, const ScalarField &field)
{
    source.field = field.name;
    source.field_description = describe_field(field);
    source.range = range_of(field);
}

static Result<Source> make_grid_source(const IsosurfaceOptions &options)
{
    Source source;
    auto grid = make_grid(options, source.repairs);
    if (!grid)
        return grid.error();
    const auto field = find_field(grid->fields, options.field);
    if (!field)
        return field.error();
    source.unused_points = grid->unused_points;
    source.joined_points = options.grid.empty() ? 0 : join_points(*grid, **field);
    fit_to_unit_sphere(grid->points);
    take_field(source, **field);
    source.order = options.order;
    source.faces = make_face_mesh(*grid, **field);
    source.cells = std::move(grid->cells);
    return source;
}

static Result<PointSet> make_point_set(const IsosurfaceOptions &options)
{
    return options.particles.empty()
               ? make_particles(static_cast<std::size_t>(options.particle_count))
               : load_point_set(options.particles);
}

static Result<Source> make_particle_source(const IsosurfaceOptions &options)
{
    auto set = make_point_set(options);
    if (!set)
        return set.error();
    const auto field = find_field(set->fields, options.field);
    if (!field)
        return field.error();
    fit_to_unit_sphere(set->points);
    Source source;
    source.medium = Medium::particles;
    take_field(source, **field);
    source.points = std::move(set->points);
    source.scalars = (*field)->values;
    return source;
}

Result<Source> make_source(const IsosurfaceOptions &options)
{
    return options.has_particles ? make_particle_source(options) : make_grid_source(options);
}

Result<std::string> list_fields(const IsosurfaceOptions &options)
{
    if (options.has_particles) {
        const auto set = make_point_set(options);
        return set ? Result<std::string>(list_fields(set->fields)) : set.error();
    }
    GridRepairs repairs;
    const auto grid = make_grid(options, repairs);
    return grid ? Result<std::string>(list_fields(grid->fields)) : grid.error();
}

Result<std::unique_ptr<FragmentStream>>
make_stream(const Gl &gl, const Source &source, std::span<const IsoValue> values, float point_size)
{
    if (source.medium == Medium::grid)
        return make_face_stream(
            gl, mark_faces_without_surface(source.faces, source.cells, source.range, values),
            source.range, source.order);
    return make_particle_stream(gl, source.points, source.scalars, source.range, point_size);
}

} // namespace kb
