// SPDX-License-Identifier: MIT

#include "volume/radix_sort.hpp"

#include <array>
#include <bit>
#include <utility>

namespace kb
{

namespace
{

constexpr int digit_bits = 11; // Three digits: a histogram of 8 KiB fits the first cache.
constexpr int digits = 3;
constexpr std::uint32_t radix = 1U << digit_bits;

/// An integer that orders as the float does: negative floats backwards and below the others.
std::uint32_t ordered_bits(float key)
{
    const auto bits = std::bit_cast<std::uint32_t>(key);
    return bits ^ ((bits >> 31U) != 0 ? 0xffffffffU : 0x80000000U);
}

std::uint32_t digit_of(std::uint32_t bits, int digit)
{
    return (bits >> static_cast<unsigned>(digit * digit_bits)) & (radix - 1U);
}

struct Item {
    std::uint32_t bits;
    std::uint32_t place;
};

} // namespace

void sort_by_key(std::span<const float> keys, std::vector<std::uint32_t> &order)
{
    std::vector<Item> items(keys.size());
    std::vector<Item> scratch(keys.size());
    std::array<std::array<std::uint32_t, radix>, digits> counts{};
    for (std::uint32_t i = 0; i < items.size(); ++i) {
        items[i] = {ordered_bits(keys[i]), i};
        for (int d = 0; d < digits; ++d)
            ++counts[std::size_t(d)][digit_of(items[i].bits, d)];
    }
    for (int d = 0; d < digits; ++d) {
        auto &places = counts[std::size_t(d)];
        std::uint32_t sum = 0;
        for (std::uint32_t &place : places)
            sum += std::exchange(place, sum);
        for (const Item &item : items)
            scratch[places[digit_of(item.bits, d)]++] = item;
        items.swap(scratch);
    }
    order.resize(items.size());
    for (std::size_t i = 0; i < items.size(); ++i)
        order[i] = items[i].place;
}

} // namespace kb
