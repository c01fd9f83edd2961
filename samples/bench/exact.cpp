// SPDX-License-Identifier: MIT

#include "bench/exact.hpp"

#include <algorithm>

namespace kb::bench
{

void sort_by_depth(std::span<Fragment> fragments)
{
    std::ranges::stable_sort(fragments, {}, &Fragment::z);
}

glm::dvec3 composite(std::span<const Fragment> sorted, int k)
{
    if (k == 0)
        return sorted.empty() ? background : glm::dvec3(sorted[0].color);

    glm::dvec3 color(0.0);
    double transmittance = 1.0;
    for (const Fragment &fragment :
         sorted.first(std::min(sorted.size(), static_cast<std::size_t>(k)))) {
        const double alpha = fragment.color.a;
        color += transmittance * alpha * glm::dvec3(fragment.color);
        transmittance *= 1.0 - alpha;
    }
    return color + transmittance * background;
}

} // namespace kb::bench
