// SPDX-License-Identifier: MIT
//
// Composites the layers that a peeling method has filled, front to back.

#pragma once

#include "bench/gl_scene.hpp"

namespace kb::bench
{

/// Where layers may be empty.
enum class EmptyLayers { behind, anywhere };

/// The layers are those of an RGBA8 array texture, nearest first, cleared to zeros. A layer of
/// alpha 0 is empty, as are all behind it unless they may be anywhere: no fragment of the study's
/// scenes has that alpha.
class LayerResolve
{
public:
    LayerResolve(const Gl &gl, int layers, EmptyLayers empty_layers = EmptyLayers::behind);

    /// Draws the whole framebuffer.
    void draw(const Texture &layers, GLuint target) const;

private:
    const Gl &gl_;
    Program program_;
    VertexArray empty_;
};

} // namespace kb::bench
