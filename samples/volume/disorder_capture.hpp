// SPDX-License-Identifier: MIT

#pragma once

#include "lib/app/long_work.hpp"
#include "volume/disorder.hpp"
#include "volume/sorted_faces.hpp"

#include <cstddef>
#include <functional>

namespace kb
{

/// The end of a fragment shader that says when a fragment arrives: in the order of the primitives
/// of the draw command.
inline constexpr const char *arrival_shader = R"(
layout(location = 0) out uint arrival;

void main()
{
    arrival = uint(gl_PrimitiveID);
}
)";

/// The disorder of the fragments that `draw` draws by one command and a program that ends with
/// arrival_shader; `nearer` compares depths. It is exact: depth peeling with continuation puts all
/// fragments of a pixel in depth order, equal depths in the order in which they arrive. A pixel
/// gets no more than `most_layers` of them. An error if `go_on` ends it after a pass.
Result<Disorder> capture_disorder(const Gl &gl, Size size, std::size_t most_layers, GLenum nearer,
                                  const std::function<void()> &draw, const GoOn &go_on = {});

/// That of all faces, in the order of their last sort, for its camera.
Result<Disorder> capture_disorder(const Gl &gl, const SortedFaces &faces, Size size,
                                  const GoOn &go_on = {});

} // namespace kb
