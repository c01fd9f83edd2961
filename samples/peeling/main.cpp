// SPDX-License-Identifier: MIT
//
// Depth peeling by GL_MESA_depth_peeling. One pass over the geometry fills k layers with the k
// nearest fragments of every pixel, sorted, equal depths in the order of drawing. Further passes
// (--all) go on behind the last layer until there is nothing more: that is an A-buffer, every
// fragment of the scene in its place, in the memory of k layers.
//
//     declare what is captured   PeelingLayers
//     draw                       Renderer::draw_pass
//     resolve                    Accumulation

#include "lib/app/report_file.hpp"
#include "lib/app/timing.hpp"
#include "lib/gl/context.hpp"
#include "lib/gl/kbuffer.hpp"
#include "lib/io/layer_files.hpp"
#include "peeling/accumulation.hpp"
#include "peeling/options.hpp"
#include "transparency/mesh_report.hpp"
#include "transparency/scene.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <new>
#include <optional>

namespace
{

constexpr glm::vec3 background{1.0F};

class Renderer
{
public:
    Renderer(const kb::Gl &gl, const kb::PeelingOptions &options, const kb::Mesh &mesh,
             kb::DepthPeeling peeling, kb::Accumulation accumulation, kb::Program shading)
        : gl_(gl), options_(options), scene_(gl, mesh, options.scene.alpha),
          peeling_(std::move(peeling)), accumulation_(std::move(accumulation)),
          shading_(std::move(shading)), inserted_(gl)
    {
    }

    /// What a pass did, for those who watch.
    struct Pass {
        int number; ///< From 1.
        double milliseconds;
    };
    using Watcher = std::function<kb::Status(const Pass &)>;

    /// Draws the picture in as many passes as it takes; gives the milliseconds of all together.
    kb::Result<double> draw_frame(const kb::OrbitCamera &camera, const Watcher &watch = {})
    {
        double sum = 0.0;
        kb::Status status = kb::ok;
        accumulation_.clear();
        passes_ = 0;
        for (bool more = true; more; ++passes_) {
            const double time = kb::milliseconds(gl_, [&] {
                status = passes_ == 0 ? peeling_.restart() : peeling_.advance();
                if (!status)
                    return;
                draw_pass(camera);
                accumulation_.add(peeling_);
                more = options_.all && peeling_.overflow();
            });
            if (status && watch)
                status = watch({passes_ + 1, time});
            if (!status)
                return status.error();
            // A pass takes k fragments of a pixel, of which there is at most one a triangle; the
            // last pass may find nothing.
            const auto passed =
                static_cast<std::size_t>(passes_) * static_cast<std::size_t>(options_.layers.count);
            if (more && passed > scene_.triangle_count())
                return kb::Error{fmt::format("{} passes have not come to the end of {} triangles: "
                                             "this is an error of the driver",
                                             passes_ + 1, scene_.triangle_count())};
            sum += time;
        }
        sum += kb::milliseconds(gl_, [&] { accumulation_.finish(background); });
        if (auto drawn = kb::check_gl(gl_, "drawing"); !drawn)
            return drawn.error();
        return sum;
    }

    int passes() const { return passes_; }
    const kb::DepthPeeling &peeling() const { return peeling_; }
    const kb::Accumulation &accumulation() const { return accumulation_; }
    std::size_t triangle_count() const { return scene_.triangle_count(); }

    /// How often a fragment went into the layers in the last pass.
    GLuint64 insertions() const
    {
        GLuint64 count = 0;
        gl_.GetQueryObjectui64v(inserted_.id(), GL_QUERY_RESULT, &count);
        return count;
    }

private:
    /// The effect itself: layer i of each pixel comes to hold its fragment of rank first_layer() +
    /// i.
    void draw_pass(const kb::OrbitCamera &camera) const
    {
        peeling_.clear();
        gl_.Enable(GL_DEPTH_PEELING_MESA);
        gl_.BeginQuery(GL_SAMPLES_PASSED, inserted_.id());
        scene_.draw(shading_, camera, options_.layers.size);
        gl_.EndQuery(GL_SAMPLES_PASSED);
        gl_.Disable(GL_DEPTH_PEELING_MESA);
    }

    const kb::Gl &gl_;
    const kb::PeelingOptions &options_;
    kb::Scene scene_;
    kb::DepthPeeling peeling_;
    kb::Accumulation accumulation_;
    kb::Program shading_;
    kb::Query inserted_;
    int passes_ = 0;
};

kb::Result<Renderer> make_renderer(const kb::Gl &gl, const kb::PeelingOptions &options,
                                   const kb::Mesh &mesh)
{
    auto peeling = kb::DepthPeeling::make(gl, options.layers);
    if (!peeling)
        return peeling.error();
    auto accumulation = kb::Accumulation::make(gl, options.layers);
    if (!accumulation)
        return accumulation.error();
    auto shading = kb::Scene::make_program(gl);
    if (!shading)
        return shading.error();
    return Renderer(gl, options, mesh, std::move(*peeling), std::move(*accumulation),
                    std::move(*shading));
}

/// Writes the layers of a pass: all of k, or with --all those that have a fragment.
kb::Status write_layers(const kb::DepthPeeling &peeling, bool all, kb::LayerFiles &files)
{
    for (int i = 0; files.wanted() && i < peeling.layers().count; ++i) {
        const kb::ImageF depth = peeling.read_depth(i);
        const bool empty = std::all_of(depth.pixels.begin(), depth.pixels.end(),
                                       [&](float z) { return z == peeling.empty_depth(); });
        if (empty && all)
            break;
        if (auto written =
                files.write_layer(peeling.first_layer() + i, peeling.read_color(i), depth);
            !written)
            return written;
    }
    return kb::ok;
}

/// What cannot go on, and the exit status that says whose fault it is.
struct Failure {
    kb::Error error;
    int status;
};

/// What was drawn, for programs.
nlohmann::json make_report(const kb::PeelingOptions &options, const kb::SceneMesh &mesh,
                           const Renderer &renderer, const kb::Accumulation::Count &count,
                           const std::vector<double> &times)
{
    nlohmann::json report = kb::mesh_report(mesh, options.scene);
    report.update({{"size", {options.layers.size.width, options.layers.size.height}},
                   {"k", options.layers.count},
                   {"all", options.all},
                   {"func", kb::word_of(options.layers.func)},
                   {"depth_format", kb::word_of(options.layers.depth_format)},
                   {"color_format", kb::word_of(options.layers.color_formats.front())},
                   {"samples", options.layers.samples},
                   {"passes", renderer.passes()},
                   {"layers", count.deepest},
                   {"fragments", count.fragments},
                   {"bytes_per_pixel", renderer.peeling().bytes_per_pixel()},
                   {"ms", times}});
    return report;
}

std::optional<Failure> run(kb::PeelingOptions options, const kb::SceneMesh &mesh,
                           kb::LayerFiles &files)
{
    const auto unsupported = [](const kb::Error &error) {
        return Failure{error, kb::exit_unsupported};
    };
    const auto unwritten = [](const kb::Error &error) {
        return Failure{error, kb::exit_bad_input};
    };

    auto context = kb::make_context(options.context, options.layers.size, "peeling");
    if (!context)
        return unsupported(context.error());
    const kb::Gl &gl = (*context)->gl();
    auto renderer = make_renderer(gl, options, mesh.mesh);
    if (!renderer)
        return unsupported(renderer.error());
    if (auto started = files.start(); !started)
        return unwritten(started.error());

    fmt::print("{}\n", kb::describe(mesh, options.scene));
    kb::Status written = kb::ok;
    const auto watch = [&](const Renderer::Pass &pass) {
        const int first = renderer->peeling().first_layer();
        fmt::print("pass {}: layers {} to {}, {} insertions, {:.2f} ms\n", pass.number, first,
                   first + options.layers.count - 1, renderer->insertions(), pass.milliseconds);
        std::fflush(stdout);
        return written = write_layers(renderer->peeling(), options.all, files);
    };
    std::vector<double> times;
    for (int i = 1; i <= options.repeat; ++i) {
        const auto time = renderer->draw_frame(options.scene.camera,
                                               i == options.repeat ? watch : Renderer::Watcher{});
        if (!written)
            return unwritten(written.error());
        if (!time)
            return unsupported(time.error());
        times.push_back(*time);
    }
    const GLuint framebuffer = renderer->accumulation().framebuffer();
    const kb::ImageRgbaF picture = kb::read_color(gl, framebuffer, options.layers.size);
    if (files.wanted())
        written = files.write_color("picture", picture);
    if (written)
        written = files.finish();
    if (written)
        written = kb::write_outputs(options.outputs, picture, {});
    if (!written)
        return unwritten(written.error());

    const kb::Accumulation::Count count = renderer->accumulation().count();
    if (written =
            kb::write_report(options.json, make_report(options, mesh, *renderer, count, times));
        !written)
        return unwritten(written.error());
    kb::print_notes("peeling", mesh);
    kb::print_emptiness("peeling", picture, background,
                        kb::alpha_range(mesh.mesh, options.scene.alpha));
    fmt::print("peeling k={} {}x{}: {}, {} geometry pass{}, {} triangles, {} layers, {} "
               "fragments, {} bytes per pixel\n",
               options.layers.count, options.layers.size.width, options.layers.size.height,
               describe(kb::spread_of(times)), renderer->passes(),
               renderer->passes() == 1 ? "" : "es", renderer->triangle_count(), count.deepest,
               count.fragments, renderer->peeling().bytes_per_pixel());

    while ((*context)->present(framebuffer, options.layers.size, options.scene.camera)) {
        if (auto drawn = renderer->draw_frame(options.scene.camera); !drawn)
            return unsupported(drawn.error());
    }
    return std::nullopt;
}

} // namespace

int main(int argc, char **argv)
{
    kb::PeelingOptions options;
    CLI::App app("Depth peeling by GL_MESA_depth_peeling: fills k layers with the k nearest "
                 "fragments of each\npixel in one pass, writes the layers as pictures and composes "
                 "them. With --all it goes on\nuntil all layers have been.",
                 "peeling");
    kb::declare_options(app, options);
    if (const auto status = kb::parse_command_line(app, argc, argv))
        return *status;
    if (auto checked = kb::check_options(options); !checked)
        return kb::fail(app, checked.error(), kb::exit_bad_input);
    const auto mesh = kb::make_mesh(options.scene);
    if (!mesh)
        return kb::fail(app, mesh.error(), kb::exit_bad_input);
    kb::LayerFiles files(options.directory, options.floats);
    for (const auto &writable :
         {files.check(), kb::prepare_outputs(options.outputs, {{options.json, ".json"}})}) {
        if (!writable)
            return kb::fail(app, writable.error(), kb::exit_bad_input);
    }

    try {
        if (const auto failure = run(options, *mesh, files))
            return kb::fail(app, failure->error, failure->status);
    } catch (const std::bad_alloc &) {
        return kb::fail(app, kb::Error{"there is not enough memory for --size and --k"},
                        kb::exit_unsupported);
    }
    return kb::finish(app);
}
