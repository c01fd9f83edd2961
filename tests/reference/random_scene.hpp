// SPDX-License-Identifier: MIT
//
// Random scenes. A seed gives the same scene everywhere.

#pragma once

#include "tests/reference/scene.hpp"

#include <cstdint>
#include <random>

namespace kb::reference
{

/// Numbers that do not depend on the standard library, unlike those of std:: distributions.
class Random
{
public:
    explicit Random(std::uint64_t seed) : engine_(static_cast<std::mt19937_64::result_type>(seed))
    {
        engine_.discard(8);
    }

    /// From low to high, both included.
    int number(int low, int high)
    {
        const auto range = static_cast<std::uint64_t>(high - low) + 1;
        return low + static_cast<int>((engine_() >> 11U) % range);
    }

    bool one_in(int n) { return number(1, n) == 1; }

    double between(double low, double high)
    {
        return low + (high - low) * static_cast<double>(engine_() >> 11U) * 0x1p-53;
    }

    template <class Container>
    auto any_of(const Container &choices)
    {
        return *(std::begin(choices) + number(0, static_cast<int>(std::size(choices)) - 1));
    }

private:
    std::mt19937_64 engine_;
};

struct SceneLimits {
    int samples = 4;        ///< Of a pixel, if any.
    bool even_grid = false; ///< Corners at even multiples of 1/256 pixel, w is 1, nothing clipped.
    bool several_tiles = false; ///< Pictures of more than 64 pixels each way.
};

Scene random_scene(std::uint64_t seed, const SceneLimits &limits);

} // namespace kb::reference
