// SPDX-License-Identifier: MIT

#include "isosurface/surface_faces.hpp"

#include <algorithm>
#include <vector>

namespace kb
{

/// For each cell whether one of the ascending scalars is among its own.
static std::vector<bool> find_surfaces(const FaceMesh &mesh, std::span<const glm::uvec4> cells,
                                       ScalarRange range, std::span<const float> iso)
{
    // The scalars of fragments are this far from those of their vertices at most: some roundings.
    constexpr float margin = 1e-6F;
    std::vector<bool> found;
    for (const glm::uvec4 &cell : cells) {
        const auto scalar = [&](int corner) {
            return normalized(mesh.scalars[cell[corner]], range);
        };
        const auto [low, high] = std::minmax({scalar(0), scalar(1), scalar(2), scalar(3)});
        const auto next = std::ranges::lower_bound(iso, low - margin);
        found.push_back(next != iso.end() && *next <= high + margin);
    }
    return found;
}

FaceMesh mark_faces_without_surface(const FaceMesh &mesh, std::span<const glm::uvec4> cells,
                                    ScalarRange range, std::span<const IsoValue> values)
{
    std::vector<float> iso;
    for (const IsoValue &value : values)
        iso.push_back(value.scalar);
    std::ranges::sort(iso);
    const std::vector<bool> surfaces = find_surfaces(mesh, cells, range, iso);
    return mark_inner_faces(mesh,
                            [&surfaces](auto a, auto b) { return !surfaces[a] && !surfaces[b]; });
}

} // namespace kb
