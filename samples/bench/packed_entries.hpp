// SPDX-License-Identifier: MIT
//
// A k-buffer in RGBA32F attachments of which each entry holds two fragments: (color, depth, color,
// depth), the color as four bytes. Both k-buffer methods store in it, so that what is compared is
// how they get there.
#pragma once

#include "bench/gl_scene.hpp"
#include "lib/gl/kbuffer.hpp"
#include "lib/scene/camera.hpp"

namespace kb::bench
{

class PackedEntries
{
public:
    PackedEntries(const Gl &gl, Size size, int k);

    /// Binds the framebuffer of the entries and clears them: no color, farthest depth.
    void begin() const;
    /// Composites the fragments front to back into the framebuffer.
    void resolve(GLuint target) const;

    int entries() const { return entries_; }
    int bytes_per_pixel() const;

private:
    std::string resolve_source() const;

    const Gl &gl_;
    int entries_;
    KBuffer buffer_;
    VertexArray empty_;
    Program resolve_;
};

} // namespace kb::bench
