// SPDX-License-Identifier: MIT
//
// The surfaces of any number of iso-values in one pass, of a tetrahedral grid or of particles.
//
//     declare what is captured   make_isosurface_program
//     draw                       FragmentStream, IsosurfaceRenderer::capture
//     resolve                    ShadingPass

#include "isosurface/isosurface_disorder.hpp"
#include "isosurface/isosurface_renderer.hpp"
#include "isosurface/isosurface_report.hpp"
#include "isosurface/options.hpp"
#include "isosurface/particles.hpp"
#include "isosurface/source.hpp"
#include "lib/app/long_work.hpp"
#include "lib/app/say.hpp"
#include "lib/app/timing.hpp"
#include "lib/gl/context.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>

namespace
{

/// What cannot go on, and the exit status that says whose fault it is.
struct Failure {
    kb::Error error;
    int status;
};

/// Particles of the default size overlap so that no ray passes between them.
float point_size(const kb::IsosurfaceOptions &options, const kb::Source &source)
{
    return options.point_size.value_or(
        std::clamp(2.0F * kb::mean_spacing(source.points), 1e-5F, 1.0F));
}

kb::IsosurfaceSettings settings_for(const kb::IsosurfaceOptions &options, const kb::Source &source)
{
    kb::IsosurfaceSettings settings;
    settings.k = options.k;
    settings.medium = source.medium;
    settings.shading.size = options.size;
    settings.shading.silhouettes = options.silhouettes;
    settings.shading.background = options.background;
    settings.shading.smoothing = options.smoothing.value_or(0);
    if (source.medium == kb::Medium::particles) {
        const float side = point_size(options, source);
        settings.gap = options.gap.value_or(std::min(1.0F, 4.0F * side));
        // What is smaller than a particle is noise.
        settings.shading.depth_step = std::max(settings.shading.depth_step, side);
        const float pixels = side / options.camera.distance *
                             options.camera.projection(options.size)[1][1] * 0.5F *
                             static_cast<float>(options.size.height);
        settings.shading.smoothing =
            options.smoothing.value_or(std::min(static_cast<int>(std::lround(pixels)), 64));
    }
    return settings;
}

/// Distance and iso-value, in the field's units, of each pixel's surface.
kb::ImageRgbaF surfaces_image(const kb::IsosurfaceRenderer &renderer,
                              std::span<const kb::IsoValue> values)
{
    kb::ImageRgbaF image = renderer.read_surfaces();
    for (glm::vec4 &pixel : image.pixels) {
        if (pixel.x == 0.0F)
            continue;
        const auto iso =
            std::find_if(values.begin(), values.end(),
                         [scalar = pixel.y](const kb::IsoValue &v) { return v.scalar == scalar; });
        pixel.y = static_cast<float>(iso->value);
    }
    return image;
}

std::optional<Failure> run(kb::IsosurfaceOptions options, const kb::Source &source)
{
    const auto unsupported = [](const kb::Error &error) {
        return Failure{error, kb::exit_unsupported};
    };
    const auto bad_input = [](const kb::Error &error) {
        return Failure{error, kb::exit_bad_input};
    };

    auto context = kb::make_context(options.context, options.size, "isosurface");
    if (!context)
        return unsupported(context.error());
    const kb::Gl &gl = (*context)->gl();
    if (auto supported = kb::require_kbuffer_program(gl); !supported)
        return unsupported(supported.error());
    const auto chosen = kb::choose_iso_values(options, source.range);
    const auto values = kb::normalized(chosen, source.range);
    auto stream = kb::make_stream(gl, source, values, point_size(options, source));
    if (!stream)
        return unsupported(stream.error());
    const kb::IsosurfaceSettings settings = settings_for(options, source);
    auto renderer = kb::IsosurfaceRenderer::make(gl, settings);
    if (!renderer)
        return unsupported(renderer.error());
    if (auto set = renderer->set_iso_values(values); !set)
        return bad_input(set.error());

    const auto draw = [&] {
        (*stream)->sort(options.camera, options.size);
        renderer->capture(**stream, options.camera);
        renderer->shade(options.camera);
    };
    std::vector<double> times;
    for (int i = 0; i < options.repeat; ++i)
        times.push_back(kb::milliseconds(gl, draw));
    if (auto drawn = kb::check_gl(gl, "drawing"); !drawn)
        return unsupported(drawn.error());

    const kb::ImageRgbaF picture = kb::read_color(gl, renderer->framebuffer(), options.size);
    if (auto written = kb::write_outputs(options.outputs, picture, {}); !written)
        return bad_input(written.error());
    if (!options.surfaces.empty()) {
        const auto image = surfaces_image(*renderer, values);
        if (auto written = kb::write_pfm(options.surfaces, image); !written)
            return bad_input(written.error());
    }

    kb::IsosurfaceReport report{
        .iso_values = chosen,
        .primitive = std::string((*stream)->primitive()),
        .primitives = (*stream)->count(),
        .bytes_per_pixel = renderer->bytes_per_pixel(),
        .covered = kb::count_surfaces(renderer->read_surfaces()),
        .times = times,
        .disorder = {},
    };
    kb::print_report(options, source, report);

    // The picture is there: what takes longer than it comes now.
    const kb::OrbitCamera seen = options.camera;
    bool open = (*context)->has_window();
    const auto show = [&] {
        open = open && (*context)->present(renderer->framebuffer(), options.size, options.camera);
    };
    show();
    if (options.measure_disorder) {
        kb::LongWork work("isosurface", "measuring disorder", "--no-disorder does without", [&] {
            show();
            if (!(*context)->has_window())
                return std::string();
            if (!open)
                return std::string("the window was closed");
            return std::string(kb::is_same_view(options.camera, seen) ? ""
                                                                      : "the view has changed");
        });
        auto disorder = kb::measure_disorder(gl, settings, **stream, seen, values, picture,
                                             [&work] { return work.go_on(); });
        kb::say(disorder ? describe(*disorder, options.k)
                         : "disorder: not measured: " +
                               (work.reason().empty() ? disorder.error().message : work.reason()));
        if (disorder)
            report.disorder = std::move(*disorder);
    }
    if (!options.json.empty()) {
        kb::IsosurfaceOptions drawn = options;
        drawn.camera = seen;
        if (auto written = kb::write_report(options.json, drawn, source, report); !written)
            return bad_input(written.error());
    }
    if (kb::LongWork::interrupted())
        return Failure{{}, kb::exit_interrupted};

    while (open) {
        draw();
        show();
    }
    return std::nullopt;
}

} // namespace

int main(int argc, char **argv)
{
    kb::IsosurfaceOptions options;
    CLI::App app("Draws the surfaces of any number of iso-values in one pass: of a tetrahedral "
                 "grid, or of\nparticles drawn as points. A k-buffer program "
                 "(GL_MESA_kbuffer_program) puts the fragments in\norder and finds the surfaces "
                 "between them.",
                 "isosurface");
    kb::declare_options(app, options);
    if (const auto status = kb::parse_command_line(app, argc, argv))
        return *status;
    for (const auto &checked : {kb::check_options(options),
                                kb::prepare_outputs(options.outputs, {{options.surfaces, ".pfm"},
                                                                      {options.json, ".json"}})}) {
        if (!checked)
            return kb::fail(app, checked.error(), kb::exit_bad_input);
    }
    if (options.list_fields) {
        const auto fields = kb::list_fields(options);
        if (!fields)
            return kb::fail(app, fields.error(), kb::exit_bad_input);
        fmt::print("{}", *fields);
        return kb::finish(app);
    }
    kb::outlive_readers();
    const auto source = kb::make_source(options);
    if (!source)
        return kb::fail(app, source.error(), kb::exit_bad_input);

    try {
        if (const auto failure = run(options, *source))
            return failure->status == kb::exit_interrupted
                       ? failure->status
                       : kb::fail(app, failure->error, failure->status);
    } catch (const std::bad_alloc &) {
        return kb::fail(app, kb::Error{"there is not enough memory for --size and --k"},
                        kb::exit_unsupported);
    }
    return kb::finish(app);
}
