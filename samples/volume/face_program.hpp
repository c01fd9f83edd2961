// SPDX-License-Identifier: MIT
//
// The shaders that draw faces of a grid: what all that look at its fragments have in common.

#pragma once

#include "lib/gl/gl_objects.hpp"
#include "volume/sorted_faces.hpp"

#include <string>

namespace kb
{

/// A scalar from 0 to 1 and a tag, 1 where the ray enters the grid, -1 where it leaves it, else 0,
/// in one number: tag + scale * scalar + offset. The tag is the number rounded down, also where the
/// scalar is a little below 0 or above 1.
struct CodedScalar {
    static constexpr float scale = 1.0F / SortedFaces::boundary_tag;
    static constexpr float offset = 0.375F;
};

/// A program that draws SortedFaces. `fragment_shader` is GLSL 3.30 without its #version line; it
/// may call
///
///     float eye_depth()      of the fragment, along the axis of the view: more than 0
///     float ray_distance()   of the fragment from the eye, along the ray
///     float tagged_scalar()  the scalar from 0 to 1; + 4 where the ray enters the grid, - 4 where
///                            it leaves it
///     float coded_scalar()   a CodedScalar
///
/// The position is invariant: all of them get the same fragments.
Result<Program> make_face_program(const Gl &gl, const std::string &fragment_shader);

/// GLSL: float ray_length(), of the pixel's ray from the eye to eye_depth() 1, and the uniform that
/// it needs.
extern const char *const ray_length_shader;

/// Draws the faces by the program, for the view that they are sorted for. Of depths GL_GREATER is
/// the nearer one: they are the near plane's over the fragment's, which floats tell apart near and
/// far alike.
void draw_faces(const Gl &gl, const Program &program, const SortedFaces &faces, Size size);

/// Sets the uniform of ray_length() of the current program.
void set_rays(const Gl &gl, const Program &program, const OrbitCamera &camera, Size size);

} // namespace kb
