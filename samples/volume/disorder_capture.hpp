// SPDX-License-Identifier: MIT

#pragma once

#include "camera.hpp"
#include "disorder.hpp"
#include "gl.hpp"
#include "result.hpp"

#include <functional>

namespace kb
{

/// The fragment shader of a pass whose fragments say when they arrive: the place of their triangle
/// in the draw call.
inline constexpr const char *arrival_fragment_shader = R"(#version 150
out uint arrival;

void main()
{
    arrival = uint(gl_PrimitiveID);
}
)";

/// The disorder of what `draw` draws, exactly: depth peeling with continuation puts the arrivals of
/// all fragments in depth order, equal depths in the order in which they arrive. `draw` is called
/// once a pass, has to use a program with arrival_fragment_shader, and to make one and the same
/// draw call of at most `triangles` triangles each time.
Result<Disorder> capture_disorder(const Gl &gl, Size size, std::size_t triangles,
                                  const std::function<void()> &draw);

} // namespace kb
