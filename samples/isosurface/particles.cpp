// SPDX-License-Identifier: MIT

#include "isosurface/particles.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace kb
{

namespace
{

struct Drop {
    glm::vec3 center;
    float radius;
};

constexpr std::array<Drop, 7> drops{{{{0.0F, 0.05F, 0.0F}, 0.34F},
                                     {{0.5F, 0.25F, 0.15F}, 0.2F},
                                     {{-0.45F, 0.35F, 0.2F}, 0.22F},
                                     {{0.1F, -0.5F, 0.25F}, 0.24F},
                                     {{-0.35F, -0.35F, -0.3F}, 0.25F},
                                     {{0.35F, 0.0F, -0.5F}, 0.2F},
                                     {{0.05F, 0.62F, -0.2F}, 0.16F}}};

/// 1 in the middle of a drop that is alone, and at its radius exp(-1).
float drop_density(const glm::vec3 &p)
{
    float sum = 0.0F;
    for (const Drop &drop : drops) {
        const glm::vec3 offset = (p - drop.center) / drop.radius;
        sum += std::exp(-glm::dot(offset, offset));
    }
    return sum;
}

} // namespace

PointSet make_particles(std::size_t count)
{
    // The ball is pi / 6 of its box.
    const double cubes = std::cbrt(static_cast<double>(count) * 6.0 / std::numbers::pi);
    const int side = std::max(1, static_cast<int>(std::lround(cubes)));
    std::mt19937 engine(1);
    // Not a distribution of the standard library: those differ.
    const auto random = [&engine] { return static_cast<float>(engine() >> 8U) * 0x1p-24F; };

    PointSet set;
    ScalarField density{"density", {}};
    for (int z = 0; z < side; ++z) {
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                glm::vec3 p(x, y, z);
                for (int axis = 0; axis < 3; ++axis)
                    p[axis] = 2.0F * (p[axis] + random()) / static_cast<float>(side) - 1.0F;
                if (glm::dot(p, p) > 1.0F)
                    continue;
                set.points.push_back(p);
                density.values.push_back(drop_density(p));
            }
        }
    }
    set.fields.push_back(std::move(density));
    return set;
}

float mean_spacing(std::span<const glm::vec3> points)
{
    if (points.empty())
        return 0.0F;
    glm::vec3 low = points[0];
    glm::vec3 high = points[0];
    for (const glm::vec3 &p : points) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    std::array<double, 3> box{high.x - low.x, high.y - low.y, high.z - low.z};
    std::ranges::sort(box, std::greater());
    // Points in a plane or in a line have neighbours only there.
    const auto count = static_cast<double>(points.size());
    double spacing = std::cbrt(box[0] * box[1] * box[2] / count);
    if (spacing >= box[2])
        spacing = std::sqrt(box[0] * box[1] / count);
    if (spacing >= box[1])
        spacing = box[0] / count;
    return static_cast<float>(spacing);
}

} // namespace kb
