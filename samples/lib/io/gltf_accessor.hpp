// SPDX-License-Identifier: MIT

#pragma once

#include "lib/result.hpp"

#include <tiny_gltf.h>

#include <cstddef>
#include <vector>

namespace kb
{

/// The values of an accessor, as numbers: what is normalized is from -1 or 0 to 1.
struct AccessorValues {
    std::size_t count;      ///< Elements
    std::size_t components; ///< Of an element.
    std::vector<double> values;
};

/// Reads an accessor of scalars or vectors, sparse ones too. An error says what of it lies outside
/// of the file's buffers.
Result<AccessorValues> read_accessor(const tinygltf::Model &model, int index);

} // namespace kb
