// SPDX-License-Identifier: MIT

#pragma once

#include "gl_objects.hpp"
#include "preintegration.hpp"

namespace kb
{

/// The table as a texture: 3D, RGBA32F, linear filtering. Stays bound to the texture unit that was
/// active.
Texture make_segment_texture(const Gl &gl, const PreintegratedTable &table);

} // namespace kb
