// SPDX-License-Identifier: MIT

#include "volume/ray_chords.hpp"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <future>
#include <limits>
#include <optional>
#include <thread>

namespace kb
{

namespace
{

/// By barycentric coordinates, which are linear along the ray and positive inside of the cell.
std::optional<RayChord> find_chord(const TetGrid &grid, std::span<const double> scalars,
                                   std::uint32_t index, const Ray &ray)
{
    const glm::uvec4 &cell = grid.cells[index];
    const glm::dvec3 corner(grid.points[cell.x]);
    const glm::dmat3 edges(glm::dvec3(grid.points[cell.y]) - corner,
                           glm::dvec3(grid.points[cell.z]) - corner,
                           glm::dvec3(grid.points[cell.w]) - corner);
    const glm::dmat3 inverse = glm::inverse(edges);
    const auto with_first = [](glm::dvec3 others, double sum) {
        return glm::dvec4(sum - others.x - others.y - others.z, others);
    };
    const glm::dvec4 shares = with_first(inverse * (glm::dvec3(ray.origin) - corner), 1.0);
    const glm::dvec4 slopes = with_first(inverse * glm::dvec3(ray.direction), 0.0);
    double begin = -std::numeric_limits<double>::infinity();
    double end = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 4; ++i) {
        const double at = -shares[i] / slopes[i];
        if (slopes[i] > 0.0)
            begin = std::max(begin, at);
        else if (slopes[i] < 0.0)
            end = std::min(end, at);
        else if (!(shares[i] >= 0.0)) // Beside a face that it is parallel to, or a flat cell.
            return std::nullopt;
    }
    if (!(begin < end))
        return std::nullopt;
    const glm::dvec4 values(scalars[cell.x], scalars[cell.y], scalars[cell.z], scalars[cell.w]);
    return RayChord{begin, end, glm::dot(values, shares + begin * slopes),
                    glm::dot(values, shares + end * slopes), index};
}

using Chords = std::vector<std::vector<RayChord>>;

Chords find_in_cells(const TetGrid &grid, std::span<const double> scalars,
                     std::span<const Ray> rays, std::uint32_t first, std::uint32_t last)
{
    Chords chords(rays.size());
    for (std::uint32_t i = first; i < last; ++i) {
        const glm::uvec4 &cell = grid.cells[i];
        glm::vec3 middle(0.0F);
        for (int c = 0; c < 4; ++c)
            middle += 0.25F * grid.points[cell[c]];
        float squared_radius = 0.0F;
        for (int c = 0; c < 4; ++c) {
            const glm::vec3 arm = grid.points[cell[c]] - middle;
            squared_radius = std::max(squared_radius, glm::dot(arm, arm));
        }
        // Rounding is that of numbers up to 1: nearly missed is not missed.
        const float reach = 1.001F * squared_radius + 1e-6F;
        for (std::size_t r = 0; r < rays.size(); ++r) {
            const glm::vec3 away = middle - rays[r].origin;
            const float along = glm::dot(away, rays[r].direction);
            if (glm::dot(away, away) - along * along > reach)
                continue;
            if (const auto chord = find_chord(grid, scalars, i, rays[r]))
                chords[r].push_back(*chord);
        }
    }
    return chords;
}

} // namespace

Chords find_chords(const TetGrid &grid, std::span<const double> scalars, std::span<const Ray> rays)
{
    const auto cells = grid.cells.size();
    const std::size_t parts = std::clamp(std::thread::hardware_concurrency(), 1U, 16U);
    std::vector<std::future<Chords>> work;
    for (std::size_t i = 0; i < parts; ++i)
        work.push_back(std::async(std::launch::async, [&, i] {
            return find_in_cells(grid, scalars, rays, static_cast<std::uint32_t>(cells * i / parts),
                                 static_cast<std::uint32_t>(cells * (i + 1) / parts));
        }));
    Chords all(rays.size());
    for (auto &part : work) {
        const Chords chords = part.get();
        for (std::size_t r = 0; r < rays.size(); ++r)
            all[r].insert(all[r].end(), chords[r].begin(), chords[r].end());
    }
    for (auto &chords : all)
        std::ranges::sort(chords, {}, &RayChord::begin);
    return all;
}

} // namespace kb
