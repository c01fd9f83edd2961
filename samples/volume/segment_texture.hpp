// SPDX-License-Identifier: MIT

#pragma once

#include "gl_objects.hpp"
#include "preintegration.hpp"

namespace kb
{

/// The table as two textures: 2D, RGBA32F.
class SegmentTextures
{
public:
    /// GL_LINEAR filtering, or GL_NEAREST: a lookup is then a third of the work.
    SegmentTextures(const Gl &gl, const PreintegratedTable &table, GLint filter);

    /// Binds `thin` to a texture unit and `fading` to the next.
    void bind(int unit) const;

private:
    Texture thin_;
    Texture fading_;
};

} // namespace kb
