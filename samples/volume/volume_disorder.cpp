// SPDX-License-Identifier: MIT

#include "volume/volume_disorder.hpp"

#include "lib/gl/kbuffer.hpp"
#include "volume/disorder_capture.hpp"
#include "volume/volume_renderer.hpp"

namespace kb
{

static Result<ImageRgbaF> draw_exact(const Gl &gl, const VolumeOptions &options,
                                     const VolumeScene &scene, const GoOn &go_on)
{
    VolumeSettings settings{options.size, 0, scene.transfer, options.background};
    settings.k = 32; // Layers a pass: many, as each pass draws all faces.
    settings.go_on = go_on;
    const auto renderer = make_exact_renderer(gl, settings);
    if (!renderer)
        return renderer.error();
    SortedFaces faces(gl, scene.faces, scene.range);
    faces.sort(options.scene.camera, options.size);
    if (auto drawn = (*renderer)->draw(faces); !drawn)
        return drawn.error();
    return read_color(gl, (*renderer)->framebuffer(), options.size);
}

Result<DisorderReport> measure_disorder(const Gl &gl, const VolumeOptions &options,
                                        const VolumeScene &scene, const SortedFaces &faces,
                                        const ImageRgbaF &picture, const GoOn &go_on)
{
    auto fragments = capture_disorder(gl, faces, options.size, go_on);
    if (!fragments)
        return fragments.error();
    DisorderReport report{std::move(*fragments), {}};
    if (options.exact)
        return report;
    const auto exact = draw_exact(gl, options, scene, go_on);
    if (!exact)
        return exact.error();
    const auto colors = color_error(picture, *exact, report.fragments.pixels());
    if (!colors)
        return colors.error();
    report.colors = *colors;
    return report;
}

} // namespace kb
