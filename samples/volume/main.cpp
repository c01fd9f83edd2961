// SPDX-License-Identifier: MIT
//
// Direct volume rendering of a tetrahedral grid in ONE pass over its faces. They are drawn nearly
// front to back; a k-buffer program puts the fragments of every pixel in order and composites the
// segments of its ray, by a table of the integrals over them.
//
//     join    cluster_cells, once: the faces that matter
//     sort    SortedFaces: the faces by centroid, in linear time
//     draw    make_volume_program: two nearest fragments, table lookup, composition
//     flush   the fragments that still wait

#include "lib/app/long_work.hpp"
#include "lib/app/say.hpp"
#include "lib/app/timing.hpp"
#include "lib/gl/context.hpp"
#include "lib/gl/kbuffer.hpp"
#include "transparency/output.hpp"
#include "volume/cell_clusters.hpp"
#include "volume/segment_choice.hpp"
#include "volume/subdivide.hpp"
#include "volume/volume_disorder.hpp"
#include "volume/volume_options.hpp"
#include "volume/volume_renderer.hpp"
#include "volume/volume_report.hpp"
#include "volume/volume_scene.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <new>

namespace
{

/// What cannot go on, and the exit status that says whose fault it is.
struct Failure {
    kb::Error error;
    int status;
};

kb::Result<std::unique_ptr<kb::VolumeRenderer>>
make_renderer(const kb::Gl &gl, const kb::VolumeOptions &options, const kb::VolumeScene &scene,
              const kb::CellClusters *clusters, kb::VolumeReport &report)
{
    kb::VolumeSettings settings{options.size, options.k, scene.transfer, options.background,
                                kb::SegmentLookup()};
    if (options.exact)
        return kb::make_exact_renderer(gl, settings);
    if (auto supported = kb::require_kbuffer_program(gl); !supported)
        return supported.error();
    report.segments =
        kb::choose_lookup(scene.grid, scene.faces.scalars, scene.range, scene.transfer, clusters);
    settings.lookup = report.segments->lookup;
    return kb::make_kbuffer_renderer(gl, settings);
}

/// The cells that are drawn as one, unless all faces are wanted.
std::optional<kb::CellClusters> join_cells(const kb::Gl &gl, const kb::VolumeOptions &options,
                                           const kb::VolumeScene &scene, kb::VolumeReport &report)
{
    std::optional<kb::CellClusters> clusters;
    if (options.all_faces)
        return clusters;
    report.cluster_time = kb::milliseconds(gl, [&] {
        clusters = kb::cluster_cells(scene.grid, scene.faces, scene.range,
                                     kb::ColorTolerance(scene.transfer, options.tolerance));
    });
    report.clusters = clusters->count;
    return clusters;
}

/// What is drawn of the faces, in pieces if that is wanted.
kb::FaceMesh choose_faces(const kb::VolumeOptions &options, const kb::VolumeScene &scene,
                          const kb::CellClusters *clusters, kb::VolumeReport &report)
{
    kb::FaceMesh faces = scene.faces;
    if (clusters) {
        faces = kb::mark_inner_faces(scene.faces,
                                     [clusters](auto a, auto b) { return clusters->join(a, b); });
        report.inner_faces = faces.inner_count;
    }
    return options.budget > 1.0 ? kb::subdivide(faces, options.budget, options.split_first) : faces;
}

std::optional<Failure> run(kb::VolumeOptions options, const kb::VolumeScene &scene)
{
    const auto unsupported = [](const kb::Error &error) {
        return Failure{error, kb::exit_unsupported};
    };

    auto context = kb::make_context(options.context, options.size, "volume");
    if (!context)
        return unsupported(context.error());
    const kb::Gl &gl = (*context)->gl();
    kb::VolumeReport report;
    const auto joined = join_cells(gl, options, scene, report);
    const kb::CellClusters *clusters = joined ? &*joined : nullptr;
    auto renderer = make_renderer(gl, options, scene, clusters, report);
    if (!renderer)
        return unsupported(renderer.error());
    kb::SortedFaces faces(gl, choose_faces(options, scene, clusters, report), scene.range,
                          options.order);

    const auto draw = [&]() -> kb::Status {
        kb::Status drawn = kb::ok;
        const double sort =
            kb::milliseconds(gl, [&] { faces.sort(options.scene.camera, options.size); });
        const double rest = kb::milliseconds(gl, [&] { drawn = (*renderer)->draw(faces); });
        report.frames.push_back({sort, rest});
        return drawn;
    };
    for (int i = 0; i < options.repeat; ++i) {
        if (auto drawn = draw(); !drawn)
            return unsupported(drawn.error());
    }

    const kb::ImageRgbaF image = kb::read_color(gl, (*renderer)->framebuffer(), options.size);
    kb::ImageRgbaF opaque = image; // The background is in it.
    for (glm::vec4 &pixel : opaque.pixels)
        pixel.a = 1.0F;
    if (auto written = kb::write_outputs({options.picture, options.floats, {}}, opaque, {});
        !written)
        return Failure{written.error(), kb::exit_bad_input};
    report.covered = kb::count_covered(image);
    report.faces = faces.count();
    report.drawn = faces.order().size();
    report.passes = (*renderer)->passes();
    report.bytes_per_pixel = (*renderer)->bytes_per_pixel();
    kb::print_report(options, scene, report);

    // The picture is there: what takes longer than it comes now.
    kb::OrbitCamera &camera = options.scene.camera;
    const kb::OrbitCamera seen = camera;
    bool open = (*context)->has_window();
    const auto show = [&] {
        open = open && (*context)->present((*renderer)->framebuffer(), options.size, camera);
    };
    show();
    if (options.measure_disorder) {
        kb::LongWork work("volume", "measuring disorder", "--no-disorder does without", [&] {
            show();
            if (!(*context)->has_window())
                return std::string();
            if (!open)
                return std::string("the window was closed");
            return std::string(kb::is_same_view(camera, seen) ? "" : "the view has changed");
        });
        kb::VolumeOptions measured = options;
        measured.scene.camera = seen;
        auto disorder = kb::measure_disorder(gl, measured, scene, faces, image,
                                             [&work] { return work.go_on(); });
        if (disorder)
            report.disorder = std::move(*disorder);
        kb::say(disorder ? describe(*report.disorder, options.k)
                         : "disorder: not measured: " +
                               (work.reason().empty() ? disorder.error().message : work.reason()));
    }
    if (!options.json.empty()) {
        kb::VolumeOptions drawn = options;
        drawn.scene.camera = seen;
        if (auto written = kb::write_report(options.json, drawn, scene, report); !written)
            return Failure{written.error(), kb::exit_bad_input};
    }
    if (kb::LongWork::interrupted())
        return Failure{{}, kb::exit_interrupted};

    while (open) {
        if (auto drawn = draw(); !drawn)
            return unsupported(drawn.error());
        show();
    }
    return std::nullopt;
}

} // namespace

int main(int argc, char **argv)
{
    kb::VolumeOptions options;
    CLI::App app("Draws a tetrahedral grid as a volume, in one pass over its faces: a k-buffer "
                 "program\n(GL_MESA_kbuffer_program) puts fragments in order and composites the "
                 "segments between them.",
                 "volume");
    kb::declare_options(app, options);
    if (const auto status = kb::parse_command_line(app, argc, argv))
        return *status;
    kb::outlive_readers();
    if (auto writable =
            kb::prepare_outputs({options.picture, options.floats, {}}, {{options.json, ".json"}});
        !writable)
        return kb::fail(app, writable.error(), kb::exit_bad_input);

    try {
        if (options.list_fields) {
            const auto fields = kb::list_fields(options.scene);
            if (!fields)
                return kb::fail(app, fields.error(), kb::exit_bad_input);
            fmt::print("{}", *fields);
            return kb::finish(app);
        }
        const auto scene = kb::make_volume_scene(options.scene);
        if (!scene)
            return kb::fail(app, scene.error(), kb::exit_bad_input);
        if (const auto failure = run(options, *scene))
            return failure->status == kb::exit_interrupted
                       ? failure->status
                       : kb::fail(app, failure->error, failure->status);
    } catch (const std::bad_alloc &) {
        return kb::fail(app, kb::Error{"there is not enough memory for --grid, --size and --k"},
                        kb::exit_unsupported);
    }
    return kb::finish(app);
}
