// SPDX-License-Identifier: MIT
//
// All fragments of each sample, in the order that the extensions promise: the A-buffer.

#pragma once

#include "tests/reference/scene.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace kb::reference
{

using Color = std::array<float, 4>;

struct Fragment {
    std::uint32_t depth;  ///< As stored, as a number that grows with the depth.
    std::size_t triangle; ///< Which of the scene's, in the order of drawing.
    Color color;          ///< As the fragment stage gave it.
};

/// What is not kept: at this depth, or not in front of it.
struct Empty {
    std::uint32_t depth;
};

class ABuffer
{
public:
    explicit ABuffer(std::size_t samples) : fragments_(samples) {}

    /// Fragments of a sample have to come in the order of drawing.
    void add(std::size_t sample, const Fragment &fragment)
    {
        fragments_[sample].push_back(fragment);
    }

    void clear(std::size_t sample) { fragments_[sample].clear(); }

    /// Drops what is not in front of the empty depth, and sorts the rest.
    void sort(Func func, Empty empty);

    const std::vector<Fragment> &at(std::size_t sample) const { return fragments_[sample]; }
    std::size_t sample_count() const { return fragments_.size(); }
    std::size_t deepest() const;

    /// Whether two fragments of a sample have the same depth.
    bool has_ties() const;

private:
    std::vector<std::vector<Fragment>> fragments_;
};

} // namespace kb::reference
