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
    /// Linear filtering, of `fading` that which is given: GL_NEAREST costs half of the time, and
    /// its error counts little where segments are thin.
    SegmentTextures(const Gl &gl, const PreintegratedTable &table, GLint fading_filter);

    /// Binds `thin` to a texture unit and `fading` to the next.
    void bind(int unit) const;

private:
    Texture thin_;
    Texture fading_;
};

} // namespace kb
