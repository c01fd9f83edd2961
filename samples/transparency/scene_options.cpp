// SPDX-License-Identifier: MIT

#include "scene_options.hpp"

namespace kb
{

void add_scene_options(CLI::App &app, SceneOptions &options, const std::string &alpha_help)
{
    app.add_option("--mesh", options.mesh,
                   "OBJ, PLY, STL or glTF 2.0 file; without, a knot is generated")
        ->type_name("FILE");
    app.add_option("--triangles", options.triangles, "Size of the generated knot")
        ->check(CLI::Range(100, 10'000'000))
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--alpha", options.alpha, alpha_help)
        ->check([](const std::string &text) { return check_number(text, 0.0, 1.0); })
        ->type_name("A");
    add_turning_options(app, options.camera);
}

Result<Mesh> make_mesh(const SceneOptions &options)
{
    if (options.mesh.empty())
        return make_knot(static_cast<std::size_t>(options.triangles));
    auto mesh = load_mesh(options.mesh);
    if (mesh)
        fit_to_unit_sphere(*mesh);
    return mesh;
}

} // namespace kb
