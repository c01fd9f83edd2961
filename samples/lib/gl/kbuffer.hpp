// SPDX-License-Identifier: MIT

#pragma once

#include "lib/gl/gl_objects.hpp"
#include "lib/io/image.hpp"
#include "lib/scene/camera.hpp"

#include <vector>

namespace kb
{

/// The textures of a k-buffer and the framebuffer that they are attached to: A color attachments,
/// each a 2D array of L layers. Entry e is attachment e mod A in layer e div A.
class KBuffer
{
public:
    /// Makes room for at least the given number of entries, with as few layers as possible. Also
    /// for framebuffer fetch, on drivers without k-buffer programs: one layer then.
    static Result<KBuffer> make(const Gl &gl, GLenum internal_format, Size size, int entries);

    /// Sets all components of all entries; leaves the framebuffer bound.
    void clear(glm::vec4 value) const;

    /// Binds framebuffer and viewport, so that programs find the entries.
    void bind() const;

    /// Binds the array texture of attachment a to texture unit a, for shaders.
    void bind_textures() const;

    /// Entry e of all pixels, bit for bit, top row first.
    ImageRgbaF read_entry(int entry) const;

    int attachments() const { return static_cast<int>(textures_.size()); }
    int layers() const { return layers_; }

private:
    KBuffer(const Gl &gl, Size size, int layers) : framebuffer_(gl), size_(size), layers_(layers) {}

    Framebuffer framebuffer_;
    std::vector<Texture> textures_;
    Size size_;
    int layers_;
};

/// Color attachment 0 of the framebuffer as floats, top row first.
ImageRgbaF read_color(const Gl &gl, GLuint framebuffer, Size size);

/// The depth attachment of the framebuffer, top row first.
ImageF read_depth(const Gl &gl, GLuint framebuffer, Size size);

} // namespace kb
