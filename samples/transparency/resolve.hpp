// SPDX-License-Identifier: MIT

#pragma once

#include "transparency/method.hpp"

#include <string>

namespace kb
{

/// A pass over all pixels that composes layers front to back:
///
///     color = sum of alpha[i] rgb[i] T[i] + T[n] background,  T[i] = product of (1 - alpha[j]), j
///     < i
class ResolvePass
{
public:
    /// `fetch` is GLSL that calls `add(vec4 rgba)` for each layer at `ivec2 pixel`, nearest first;
    /// `declarations` is GLSL that stands before it.
    static Result<ResolvePass> make(const Gl &gl, const MethodOptions &options,
                                    const std::string &declarations, const std::string &fetch);

    /// Sampler `attachment<n>` reads texture unit n; the caller binds the textures.
    void draw(GLuint framebuffer) const;

private:
    ResolvePass(const Gl &gl, const MethodOptions &options, Program program);

    Program program_;
    VertexArray empty_;
    MethodOptions options_;
};

} // namespace kb
