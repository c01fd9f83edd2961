// SPDX-License-Identifier: MIT

#include "tests/hard_cases/method.hpp"

#include <algorithm>
#include <bit>

namespace kb::hard
{

/// FNV-1a, by words instead of bytes.
static void add(std::uint64_t &digest, std::uint64_t word)
{
    digest = (digest ^ word) * 0x100000001b3;
}

Layers Method::deliver(Layers layers)
{
    const std::size_t needed = flaw_ == Flaw::lost_layer ? 1 : 2;
    const auto sample = std::ranges::find_if(
        layers, [needed](const auto &fragments) { return fragments.size() >= needed; });
    if (flaw_ != Flaw::none && sample != layers.end()) {
        if (flaw_ == Flaw::lost_layer)
            sample->erase(sample->begin());
        else
            std::iter_swap(sample->begin(), sample->begin() + 1);
        flaw_ = Flaw::none;
    }
    for (const auto &fragments : layers) {
        add(digest_, fragments.size());
        for (const Fragment &fragment : fragments) {
            add(digest_, std::bit_cast<std::uint64_t>(fragment.depth));
            for (const float number : {fragment.value, fragment.alpha, fragment.id})
                add(digest_, std::bit_cast<std::uint32_t>(number));
        }
    }
    return layers;
}

} // namespace kb::hard
