// SPDX-License-Identifier: MIT

#pragma once

#include "lib/gl/depth_peeling.hpp"

#include <glm/vec3.hpp>

#include <cstdint>

namespace kb
{

/// Composes the layers of pass after pass, so that no more than one pass's layers need memory. Each
/// sample keeps what all fragments so far add up to, in their order from the front,
///
///     sum = sum of T[i] alpha[i] rgb[i],   T = product of (1 - alpha[j]),  T[i]: the same, j < i
///
/// and a pass with (sum', T') behind it makes that (sum + T sum', T T'), by blending. Where layers
/// come farthest first, a pass with (sum', T') is in front of it: (sum' + T' sum, T T').
class Accumulation
{
public:
    /// For layers like these; the picture has one sample a pixel in any case.
    static Result<Accumulation> make(const Gl &gl, const PeelingLayers &layers);

    void clear() const;

    /// Composes the layers of one more pass.
    void add(const DepthPeeling &peeling) const;

    /// Puts the background behind everything; the picture is then color attachment 0 of
    /// framebuffer(): the average of its samples.
    void finish(glm::vec3 background) const;
    GLuint framebuffer() const { return picture_framebuffer_.id(); }

    struct Count {
        std::uint64_t fragments = 0; ///< In all samples.
        int deepest = 0;             ///< Most of them in one sample: so many layers there are.
    };
    /// What add has composed; after finish.
    Count count() const;

private:
    Accumulation(const Gl &gl, const PeelingLayers &layers, Program compose, Program average);

    void attach(const Framebuffer &framebuffer, GLenum target, const Texture &first,
                const Texture &second) const;

    PeelingLayers layers_;
    Program compose_;
    Program average_;
    Texture sums_;   ///< Color: sum, alpha: T.
    Texture counts_; ///< Fragments so far.
    Framebuffer framebuffer_;
    Texture picture_;
    Texture picture_counts_; ///< Fragments of all samples, of the deepest sample.
    Framebuffer picture_framebuffer_;
    VertexArray empty_;
};

} // namespace kb
