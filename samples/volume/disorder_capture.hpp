// SPDX-License-Identifier: MIT

#pragma once

#include "disorder.hpp"
#include "sorted_faces.hpp"

namespace kb
{

/// The disorder of the fragments of all faces, in the order of their last sort, which was for this
/// camera. It is exact: depth peeling with continuation puts all fragments of a pixel in depth
/// order, equal depths in the order in which they arrive, and each says when that is.
Result<Disorder> capture_disorder(const Gl &gl, const SortedFaces &faces, const OrbitCamera &camera,
                                  Size size);

} // namespace kb
