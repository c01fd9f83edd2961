// SPDX-License-Identifier: MIT

#include "volume/radix_sort.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace
{

constexpr float infinity = std::numeric_limits<float>::infinity();

std::vector<std::uint32_t> sorted(const std::vector<float> &keys)
{
    std::vector<std::uint32_t> order{7, 7, 7}; // What was there does not matter.
    kb::sort_by_key(keys, order);
    return order;
}

std::vector<std::uint32_t> stably_sorted(const std::vector<float> &keys)
{
    std::vector<std::uint32_t> order(keys.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&keys](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
    return order;
}

TEST(RadixSort, SortsNothing)
{
    EXPECT_TRUE(sorted({}).empty());
    EXPECT_EQ(sorted({3.0F}), std::vector<std::uint32_t>{0});
}

TEST(RadixSort, SortsNumbersOfAllSizesAndSigns)
{
    std::mt19937 random(1);
    std::uniform_int_distribution<std::uint32_t> any;
    std::vector<float> keys{infinity, -infinity, 1e-45F, -1e-45F};
    while (keys.size() < 100'000) {
        const auto key = std::bit_cast<float>(any(random));
        if (!std::isnan(key))
            keys.push_back(key);
    }
    EXPECT_EQ(sorted(keys), stably_sorted(keys));
}

TEST(RadixSort, EqualKeysKeepTheirOrder)
{
    std::mt19937 random(2);
    std::uniform_int_distribution<int> few(-3, 3);
    std::vector<float> keys(10'000);
    for (float &key : keys)
        key = static_cast<float>(few(random)) + 0.5F; // No zeros, which differ by their signs.
    EXPECT_EQ(sorted(keys), stably_sorted(keys));
}

TEST(RadixSort, MinusZeroComesBeforeZeroAndNansAreAtTheEnds)
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<float> keys{nan, 0.0F, infinity, -nan, -0.0F, -infinity};
    EXPECT_EQ(sorted(keys), (std::vector<std::uint32_t>{3, 5, 4, 1, 2, 0}));
}

} // namespace
