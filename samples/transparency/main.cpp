// SPDX-License-Identifier: MIT
//
// Exact order-independent transparency: the k nearest fragments of each pixel are captured in ONE
// pass over the geometry by a k-buffer program, or by depth peeling, then composed front to back.
//
//     declare what is captured   make_insertion_program (samples/programs), PeelingLayers
//     draw                       KBufferMethod::capture, PeelingMethod::capture
//     resolve                    ResolvePass

#include "lib/app/command_line.hpp"
#include "lib/app/report_file.hpp"
#include "lib/app/timing.hpp"
#include "lib/gl/context.hpp"
#include "lib/gl/kbuffer.hpp"
#include "transparency/mesh_report.hpp"
#include "transparency/method.hpp"
#include "transparency/output.hpp"
#include "transparency/scene_options.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <new>

namespace
{

struct Options {
    kb::SceneOptions scene;
    std::string method = "kbuffer";
    std::string layout = "packed";
    std::string context = "osmesa";
    int k = 8;
    int repeat = 1;
    kb::Size size;
    kb::OutputPaths outputs;
    std::filesystem::path json;
};

void declare_options(CLI::App &app, Options &options)
{
    kb::add_scene_options(
        app, options.scene,
        "Alpha of all fragments, 0 to 1, instead of the mesh's (rgbz, of a mesh with "
        "several: 0.4)");
    app.add_option("--method", options.method,
                   "kbuffer (one pass, a k-buffer program), peeling (one pass, "
                   "GL_DEPTH_PEELING), classic-peeling (k passes) or unsorted (wrong, one pass)")
        ->check(CLI::IsMember({"kbuffer", "peeling", "classic-peeling", "unsorted"}))
        ->type_name("NAME")
        ->capture_default_str();
    app.add_option("--k", options.k, "Layers to keep, 1 to 64")
        ->check(kb::integer_in(1, 64))
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--layout", options.layout,
                   "packed (two fragments of RGBA8 and depth an entry) or rgbz (one of float RGB "
                   "and depth; all fragments have the same alpha)")
        ->check(CLI::IsMember({"packed", "rgbz"}))
        ->type_name("NAME")
        ->capture_default_str();
    kb::add_context_option(app, options.context);
    kb::add_size_option(app, options.size);
    app.add_option("--repeat", options.repeat, "Draw this many times and print the median time")
        ->check(kb::integer_in(1, 10'000))
        ->type_name("N");
    app.add_option("--out", options.outputs.picture, "Write the picture")->type_name("FILE.png");
    app.add_option("--float-out", options.outputs.floats, "Write the picture before rounding")
        ->type_name("FILE.pfm");
    app.add_option("--layers-out", options.outputs.layers, "Write color and depth of each layer")
        ->type_name("DIR");
    kb::add_json_option(app, options.json);
}

/// RGBZ keeps no alpha: all fragments have the one that the resolve pass uses.
void settle_alpha(Options &options, kb::EntryLayout layout, const kb::Mesh &mesh)
{
    if (layout != kb::EntryLayout::rgbz || options.scene.alpha)
        return;
    const auto [low, high] = kb::alpha_range(mesh, std::nullopt);
    options.scene.alpha = low == high ? low : kb::MethodOptions{}.alpha;
}

kb::Result<std::unique_ptr<kb::Method>> make_method(const kb::Gl &gl, const Options &options,
                                                    kb::EntryLayout layout)
{
    kb::MethodOptions method;
    method.size = options.size;
    method.k = options.k;
    method.layout = layout;
    method.alpha = options.scene.alpha.value_or(method.alpha);
    if (options.method == "classic-peeling")
        return kb::make_classic_peeling_method(gl, method);
    if (options.method == "peeling")
        return kb::make_peeling_method(gl, method);
    if (options.method == "unsorted")
        return kb::make_unsorted_method(gl, method);
    if (auto supported = kb::require_kbuffer_program(gl); !supported)
        return supported.error();
    return kb::make_kbuffer_method(gl, method);
}

/// What cannot go on, and the exit status that says whose fault it is.
struct Failure {
    kb::Error error;
    int status;
};

std::optional<Failure> run(Options options, const kb::SceneMesh &mesh, kb::EntryLayout layout)
{
    const auto unsupported = [](const kb::Error &error) {
        return Failure{error, kb::exit_unsupported};
    };

    auto context = kb::make_context(options.context, options.size, "transparency");
    if (!context)
        return unsupported(context.error());
    const kb::Gl &gl = (*context)->gl();
    auto method = make_method(gl, options, layout);
    if (!method)
        return unsupported(method.error());

    const kb::Scene scene(gl, mesh.mesh, options.scene.alpha);
    const kb::Texture picture =
        kb::make_texture_2d(gl, GL_RGBA32F, options.size.width, options.size.height);
    const kb::Framebuffer framebuffer(gl);
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, picture.id(), 0);
    if (auto complete = kb::check_framebuffer(gl); !complete)
        return unsupported(complete.error());

    const auto draw = [&] {
        (*method)->capture(scene, options.scene.camera);
        (*method)->resolve(framebuffer.id());
    };
    std::vector<double> times;
    for (int i = 0; i < options.repeat; ++i)
        times.push_back(kb::milliseconds(gl, draw));
    if (auto drawn = kb::check_gl(gl, "drawing"); !drawn)
        return unsupported(drawn.error());

    const kb::ImageRgbaF image = kb::read_color(gl, framebuffer.id(), options.size);
    const auto layers =
        options.outputs.layers.empty() ? std::vector<kb::Layer>{} : (*method)->read_layers();
    if (auto written = kb::write_outputs(options.outputs, image, layers); !written)
        return Failure{written.error(), kb::exit_bad_input};

    nlohmann::json report = kb::mesh_report(mesh, options.scene);
    report.update({{"size", {options.size.width, options.size.height}},
                   {"method", options.method},
                   {"k", options.k},
                   {"layout", options.layout},
                   {"passes", (*method)->geometry_passes()},
                   {"bytes_per_pixel", (*method)->bytes_per_pixel()},
                   {"ms", times}});
    if (auto written = kb::write_report(options.json, report); !written)
        return Failure{written.error(), kb::exit_bad_input};

    kb::print_notes("transparency", mesh);
    kb::print_emptiness("transparency", image, kb::MethodOptions{}.background,
                        kb::alpha_range(mesh.mesh, options.scene.alpha));
    fmt::print("{}\n", kb::describe(mesh, options.scene));
    fmt::print("{} k={} {}x{}: {}, {} geometry pass{}, {} triangles, {} bytes per pixel\n",
               options.method, options.k, options.size.width, options.size.height,
               describe(kb::spread_of(times)), (*method)->geometry_passes(),
               (*method)->geometry_passes() == 1 ? "" : "es", scene.triangle_count(),
               (*method)->bytes_per_pixel());

    while ((*context)->present(framebuffer.id(), options.size, options.scene.camera))
        draw();
    return std::nullopt;
}

} // namespace

int main(int argc, char **argv)
{
    Options options;
    CLI::App app("Draws a translucent mesh: the k nearest fragments of each pixel are captured in "
                 "one pass by\na k-buffer program (GL_MESA_kbuffer_program) or by depth peeling "
                 "(GL_MESA_depth_peeling)\nand composed front to back.",
                 "transparency");
    declare_options(app, options);
    if (const auto status = kb::parse_command_line(app, argc, argv))
        return *status;

    const auto layout = kb::parse_entry_layout(options.layout);
    if (!layout)
        return kb::fail(app, layout.error(), kb::exit_bad_input);
    if (options.method == "unsorted" && !options.outputs.layers.empty())
        return kb::fail(app, kb::Error{"--layers-out: the method unsorted keeps no layers"},
                        kb::exit_bad_input);
    const auto mesh = kb::make_mesh(options.scene);
    if (!mesh)
        return kb::fail(app, mesh.error(), kb::exit_bad_input);
    if (auto writable = kb::prepare_outputs(options.outputs, {{options.json, ".json"}}); !writable)
        return kb::fail(app, writable.error(), kb::exit_bad_input);
    settle_alpha(options, *layout, mesh->mesh);

    try {
        if (const auto failure = run(options, *mesh, *layout))
            return kb::fail(app, failure->error, failure->status);
    } catch (const std::bad_alloc &) {
        return kb::fail(app, kb::Error{"there is not enough memory for --size and --k"},
                        kb::exit_unsupported);
    }
    return kb::finish(app);
}
