// SPDX-License-Identifier: MIT

#include "tests/integrator/integrator.hpp"

#include "tests/integrator/segment.hpp"

#include <algorithm>

namespace kb::integrator
{

Picture integrate(const Volume &volume, glm::dvec2 offset)
{
    constexpr int band = 32; // Rows at a time: the segments of a whole picture fill gigabytes.
    const RaySegments rays(volume.cells, volume.view, offset);
    const auto [width, height] = volume.view.size;
    Picture picture(width, height);
    for (int first = 0; first < height; first += band) {
        const auto segments = rays.find(first, std::min(band, height - first));
        for (std::size_t i = 0; i < segments.size(); ++i) {
            const int x = static_cast<int>(i) % width;
            const int y = first + static_cast<int>(i) / width;
            const double length = volume.view.length_per_depth(rays.device_coordinates(x, y));
            Light light;
            for (const RaySegment &segment : segments[i])
                light.append(integrate_segment(volume.medium, segment.scalar_front,
                                               segment.scalar_back,
                                               (segment.back - segment.front) * length));
            const double alpha = light.alpha();
            picture.at(x, y) = {light.color + (1.0 - alpha) * volume.background, alpha};
        }
    }
    return picture;
}

Bounds integrate_bounds(const Volume &volume, double distance)
{
    Bounds bounds;
    bounds.low = bounds.high = integrate(volume);
    for (const glm::dvec2 corner : {glm::dvec2(-1.0, -1.0), glm::dvec2(1.0, -1.0),
                                    glm::dvec2(-1.0, 1.0), glm::dvec2(1.0, 1.0)}) {
        const Picture moved = integrate(volume, distance * corner);
        for (std::size_t i = 0; i < moved.pixels.size(); ++i) {
            bounds.low.pixels[i] = glm::min(bounds.low.pixels[i], moved.pixels[i]);
            bounds.high.pixels[i] = glm::max(bounds.high.pixels[i], moved.pixels[i]);
        }
    }
    return bounds;
}

ImageRgbaF to_floats(const Picture &picture)
{
    ImageRgbaF floats(picture.width, picture.height);
    std::ranges::transform(picture.pixels, floats.pixels.begin(),
                           [](const glm::dvec4 &pixel) { return glm::vec4(pixel); });
    return floats;
}

} // namespace kb::integrator
