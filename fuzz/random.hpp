// SPDX-License-Identifier: MIT
//
// The random choices of mutators: from the seed that the fuzzer gives.

#pragma once

#include <cstddef>
#include <random>

namespace kb::fuzz
{

class Random
{
public:
    explicit Random(unsigned seed) : engine_(seed) {}

    /// 0 to count - 1.
    std::size_t below(std::size_t count) { return count ? engine_() % count : 0; }

    bool one_in(std::size_t count) { return below(count) == 0; }

    template <class Choices>
    const auto &pick(const Choices &choices)
    {
        return choices[below(std::size(choices))];
    }

private:
    std::minstd_rand engine_;
};

} // namespace kb::fuzz
