// SPDX-License-Identifier: MIT
//
// The shaders that draw faces of a grid: what all that look at its fragments have in common.

#pragma once

#include "camera.hpp"
#include "gl_objects.hpp"

#include <string>

namespace kb
{

/// A program that draws SortedFaces. `fragment_shader` is GLSL 3.30 without its #version line; it
/// may call
///
///     float ray_distance()   of the fragment from the eye, along the ray
///     float tagged_scalar()  the scalar from 0 to 1; + 4 where the ray enters the grid, - 4 where
///                            it leaves it
///
/// The position is invariant: all of them get the same fragments.
Result<Program> make_face_program(const Gl &gl, const std::string &fragment_shader);

/// Makes the program current and sets what it needs to know of the view.
void use_face_program(const Gl &gl, const Program &program, const OrbitCamera &camera, Size size);

} // namespace kb
