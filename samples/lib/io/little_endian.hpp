// SPDX-License-Identifier: MIT

#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace kb
{

/// The number whose bytes lie there, at any place, least significant first.
template <class T>
T read_little_endian(const void *bytes)
{
    std::array<char, sizeof(T)> value{};
    std::memcpy(value.data(), bytes, sizeof(T));
    if constexpr (std::endian::native == std::endian::big)
        std::reverse(value.begin(), value.end());
    return std::bit_cast<T>(value);
}

} // namespace kb
