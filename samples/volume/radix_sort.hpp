// SPDX-License-Identifier: MIT

#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace kb
{

/// The places of the keys in ascending order: keys[order[0]] <= keys[order[1]] <= ... Equal keys
/// keep their order, -0 comes before +0, NaNs come first or last by their sign. Least significant
/// digit first: linear time.
void sort_by_key(std::span<const float> keys, std::vector<std::uint32_t> &order);

} // namespace kb
