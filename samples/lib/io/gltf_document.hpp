// SPDX-License-Identifier: MIT

#pragma once

#include "lib/result.hpp"

#include <string_view>

namespace kb
{

/// Finds out whether what meshes are made of in a glTF document (as JSON) has the type that glTF
/// 2.0 gives it, and each node one transform: tinygltf takes an optional property of another type,
/// and what stands beside a matrix, as not being there. A text that is no JSON is left to it.
Status check_gltf_document(std::string_view text);

} // namespace kb
