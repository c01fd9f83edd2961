// SPDX-License-Identifier: MIT

#include "tests/reference/a_buffer.hpp"

#include <algorithm>

namespace kb::reference
{

void ABuffer::sort(Func func, Empty empty)
{
    const bool farthest_first = func == Func::greater || func == Func::gequal;
    const auto in_front = [farthest_first](std::uint32_t a, std::uint32_t b) {
        return farthest_first ? a > b : a < b;
    };
    for (auto &fragments : fragments_) {
        std::erase_if(fragments,
                      [&](const Fragment &f) { return !in_front(f.depth, empty.depth); });
        // Of equal depths the first one drawn is in front, or the last.
        if (func == Func::lequal || func == Func::gequal)
            std::reverse(fragments.begin(), fragments.end());
        std::stable_sort(
            fragments.begin(), fragments.end(),
            [&](const Fragment &a, const Fragment &b) { return in_front(a.depth, b.depth); });
    }
}

std::size_t ABuffer::deepest() const
{
    std::size_t deepest = 0;
    for (const auto &fragments : fragments_)
        deepest = std::max(deepest, fragments.size());
    return deepest;
}

bool ABuffer::has_ties() const
{
    return std::any_of(fragments_.begin(), fragments_.end(), [](const auto &fragments) {
        return std::adjacent_find(fragments.begin(), fragments.end(), [](auto &a, auto &b) {
                   return a.depth == b.depth;
               }) != fragments.end();
    });
}

} // namespace kb::reference
