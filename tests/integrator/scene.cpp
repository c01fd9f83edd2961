// SPDX-License-Identifier: MIT

#include "tests/integrator/scene.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <limits>

namespace kb::integrator
{

using nlohmann::json;

/// JSON has no infinity: it is a string.
static double extinction_of(const json &number)
{
    return number == "inf" ? std::numeric_limits<double>::infinity() : number.get<double>();
}

static glm::dvec3 color_of(const json &list, std::size_t first)
{
    return {list.at(first), list.at(first + 1), list.at(first + 2)};
}

/// Of scalars without the field's offset.
static Medium medium_of(const json &list, double offset)
{
    std::vector<ControlPoint> points;
    for (const json &point : list)
        points.push_back(
            {point.at(0).get<double>() - offset, color_of(point, 1), extinction_of(point.at(4))});
    return Medium(std::move(points));
}

static View view_of(const json &camera, const json &size)
{
    const OrbitCamera orbit{.azimuth = camera.at("azimuth"),
                            .elevation = camera.at("elevation"),
                            .distance = camera.at("distance"),
                            .field_of_view = camera.at("field_of_view")};
    return make_view(orbit, {size.at(0), size.at(1)});
}

Result<Scene> load_scene(const std::filesystem::path &path)
{
    std::ifstream file(path);
    if (!file)
        return Error{fmt::format("cannot read {}", path.string())};
    try {
        const json document = json::parse(file);
        const json &name = document.at("grid"); // null: the generated grid
        GridRepairs repairs;
        auto grid = name.is_null() ? Result<TetGrid>(make_tet_grid({.cubes = document.at("cubes")}))
                                   : load_and_repair_tet_grid(name.get<std::string>(), repairs);
        if (!grid)
            return grid.error();
        fit_to_unit_sphere(*grid);
        const auto field = find_field(*grid, document.at("field").get<std::string>());
        if (!field)
            return field.error();
        std::vector<float> scalars = (*field)->values;
        const double offset = (*field)->offset;
        return Scene{std::move(*grid), std::move(scalars),
                     medium_of(document.at("transfer"), offset),
                     view_of(document.at("camera"), document.at("size")),
                     color_of(document.at("background"), 0)};
    } catch (const json::exception &error) {
        return Error{fmt::format("{}: {}", path.string(), error.what())};
    }
}

} // namespace kb::integrator
