// SPDX-License-Identifier: MIT

#include "transparency/mesh_report.hpp"

#include "lib/app/report_file.hpp"
#include "lib/version.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <span>

namespace kb
{

using nlohmann::json;

static std::string describe_colors(const SceneMesh &scene)
{
    if (scene.colors_of == "option")
        return "the color of --color";
    if (scene.colors_of == "default")
        return "a light blue, as the file has no colors";
    return fmt::format("the colors of its {}", scene.colors_of);
}

std::string describe(const SceneMesh &scene, const SceneOptions &options)
{
    std::string line = scene.file.empty() ? "mesh: a generated knot"
                                          : fmt::format("mesh {}: {}", scene.file, scene.format);
    line += fmt::format(", {} vertices, {} triangles", scene.mesh.positions.size(),
                        scene.mesh.triangle_count());
    if (!scene.file.empty())
        line += fmt::format(", radius {:.6g} about ({:.9g}, {:.9g}, {:.9g})", scene.radius,
                            scene.center.x, scene.center.y, scene.center.z);
    const auto [low, high] = alpha_range(scene.mesh, options.alpha);
    line += fmt::format(", in {}, alpha {:.3g}", describe_colors(scene), low);
    if (high > low)
        line += fmt::format(" to {:.3g}", high);
    return line;
}

void print_notes(const std::string &program, const SceneMesh &scene)
{
    for (const std::string &note : scene.notes)
        fmt::print(stderr, "{}: {}: {}\n", program, scene.file, note);
}

void print_emptiness(const std::string &program, const ImageRgbaF &picture, glm::vec3 background,
                     const AlphaRange &alpha)
{
    const bool is_empty = std::all_of(
        picture.pixels.begin(), picture.pixels.end(),
        [background](const glm::vec4 &pixel) { return glm::vec3(pixel) == background; });
    if (is_empty)
        fmt::print(stderr, "{}: the picture is empty: {}\n", program,
                   alpha.high == 0.0F ? "alpha is 0 everywhere"
                                      : "no triangle covers the middle of a pixel in another color "
                                        "than the background's");
}

json mesh_report(const SceneMesh &scene, const SceneOptions &options)
{
    const auto [low, high] = alpha_range(scene.mesh, options.alpha);
    return {
        {"version", version},
        {"mesh", scene.file.empty() ? json() : json(scene.file)},
        {"format", scene.format.empty() ? json() : json(scene.format)},
        {"vertices", scene.mesh.positions.size()},
        {"triangles", scene.mesh.triangle_count()},
        {"center", {scene.center.x, scene.center.y, scene.center.z}},
        {"radius", scene.radius},
        {"colors_of", scene.colors_of},
        {"alpha", {low, high}},
        {"notes", scene.notes},
        {"camera", to_json(options.camera)},
    };
}

} // namespace kb
