// SPDX-License-Identifier: MIT

#include "isosurface/isosurface_disorder.hpp"

#include <fmt/format.h>

namespace kb
{

static Result<ImageRgbaF> draw(const Gl &gl, const IsosurfaceSettings &settings,
                               const FragmentStream &stream, const OrbitCamera &camera,
                               std::span<const IsoValue> values)
{
    auto renderer = IsosurfaceRenderer::make(gl, settings);
    if (!renderer)
        return renderer.error();
    if (auto set = renderer->set_iso_values(values); !set)
        return set.error();
    renderer->capture(stream, camera);
    renderer->shade(camera);
    if (auto drawn = check_gl(gl, "drawing without disorder"); !drawn)
        return drawn.error();
    return read_color(gl, renderer->framebuffer(), settings.shading.size);
}

Result<DisorderReport> measure_disorder(const Gl &gl, const IsosurfaceSettings &settings,
                                        const FragmentStream &stream, const OrbitCamera &camera,
                                        std::span<const IsoValue> values, const ImageRgbaF &picture,
                                        const GoOn &go_on)
{
    auto fragments = stream.capture_disorder(camera, settings.shading.size, go_on);
    if (!fragments)
        return fragments.error();
    DisorderReport report{std::move(*fragments), {}};
    const int displacement = report.fragments.displacement();
    if (displacement > max_isosurface_k)
        return Error{fmt::format("fragments are up to {} places late, and no k-buffer of more than "
                                 "{} can tell what that does",
                                 displacement, max_isosurface_k)};
    IsosurfaceSettings large = settings;
    large.k = std::max(settings.k, displacement);
    const auto exact = draw(gl, large, stream, camera, values);
    if (!exact)
        return exact.error();
    const auto colors = color_error(picture, *exact, report.fragments.pixels());
    if (!colors)
        return colors.error();
    report.colors = *colors;
    return report;
}

} // namespace kb
