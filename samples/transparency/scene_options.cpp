// SPDX-License-Identifier: MIT

#include "transparency/scene_options.hpp"

#include "transparency/scene.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>

namespace kb
{

void add_scene_options(CLI::App &app, SceneOptions &options, const std::string &alpha_help)
{
    app.add_option("--mesh", options.mesh,
                   "OBJ, PLY, STL or glTF 2.0 file; without, a knot is generated")
        ->type_name("FILE");
    app.add_option("--triangles", options.triangles, "Size of the generated knot")
        ->check(integer_in(100, 10'000'000))
        ->type_name("N")
        ->capture_default_str();
    add_color_option(
        app, "--color", [&options](glm::vec3 color) { options.color = color; },
        "Color of all fragments, instead of the mesh's");
    app.add_option("--alpha", options.alpha, alpha_help)
        ->check([](const std::string &text) { return check_number(text, 0.0, 1.0); })
        ->type_name("A");
    add_turning_options(app, options.camera);
}

Result<SceneMesh> make_mesh(const SceneOptions &options)
{
    SceneMesh scene;
    if (options.mesh.empty()) {
        scene.mesh = make_knot(static_cast<std::size_t>(options.triangles));
        scene.colors_of = "vertices";
    } else {
        auto loaded = load_mesh(options.mesh);
        if (!loaded)
            return loaded.error();
        scene.mesh = std::move(loaded->mesh);
        scene.file = options.mesh;
        scene.format = loaded->format;
        scene.colors_of = loaded->colors_of.empty() ? "default" : loaded->colors_of;
        scene.center = loaded->center;
        scene.radius = loaded->radius;
        scene.notes = std::move(loaded->notes);
    }
    auto &colors = scene.mesh.colors;
    if (colors.empty())
        colors.assign(scene.mesh.positions.size(), default_color);
    if (options.color) {
        scene.colors_of = "option";
        for (glm::vec4 &color : colors)
            color = glm::vec4(*options.color, color.a);
    }
    return scene;
}

AlphaRange alpha_range(const Mesh &mesh, std::optional<float> alpha)
{
    if (alpha)
        return {*alpha, *alpha};
    const auto [low, high] =
        std::minmax_element(mesh.colors.begin(), mesh.colors.end(),
                            [](const glm::vec4 &a, const glm::vec4 &b) { return a.a < b.a; });
    return {low->a, high->a};
}

} // namespace kb
