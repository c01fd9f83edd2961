// SPDX-License-Identifier: MIT

#include "tests/isosurface/surface_reference.hpp"

namespace kb::test
{

std::optional<SurfacePoint> find_nearest(std::span<const integrator::RaySegment> segments,
                                         double length_per_depth, std::span<const double> values)
{
    std::optional<SurfacePoint> nearest;
    for (const integrator::RaySegment &segment : segments) {
        for (const double value : values) {
            const double before = value - segment.scalar_front;
            const double behind = segment.scalar_back - value;
            if (before * behind < 0.0) // Both are on one side of the value.
                continue;
            const double extent = before + behind;
            const double part = extent != 0.0 ? before / extent : 0.0;
            const double depth = segment.front + part * (segment.back - segment.front);
            const SurfacePoint point{depth * length_per_depth, value};
            if (!nearest || point.distance < nearest->distance)
                nearest = point;
        }
    }
    return nearest;
}

std::vector<std::optional<SurfacePoint>> find_surfaces(const integrator::Cells &cells,
                                                       const integrator::View &view,
                                                       std::span<const double> values,
                                                       glm::dvec2 offset)
{
    const integrator::RaySegments rays(cells, view, offset);
    const auto pixels = rays.find(0, view.size.height);
    std::vector<std::optional<SurfacePoint>> surfaces;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const int x = static_cast<int>(i) % view.size.width;
        const int y = static_cast<int>(i) / view.size.width;
        surfaces.push_back(
            find_nearest(pixels[i], view.length_per_depth(rays.device_coordinates(x, y)), values));
    }
    return surfaces;
}

} // namespace kb::test
