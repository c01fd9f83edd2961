// SPDX-License-Identifier: MIT
//
// Memory that fragment shaders of the rival methods write, and the order in which pixels lie there.
#pragma once

#include "bench/gl_scene.hpp"
#include "lib/scene/camera.hpp"

#include <cstddef>
#include <string>

namespace kb::bench
{

/// Words of 32 bits. llvmpipe loads from an image several times as fast as from a shader storage
/// buffer, and stores faster into the latter; so it can be seen as both.
class StorageBuffer
{
public:
    /// `format` is that of the texels: GL_R32UI, GL_R32F, GL_RG32UI...
    StorageBuffer(const Gl &gl, std::size_t words, GLenum format);

    void bind_storage(GLuint binding) const;
    void bind_image(GLuint unit) const;

    /// Sets the first words.
    void clear(std::size_t words, GLuint value) const;
    /// The first word. Waits for what is being drawn.
    GLuint read() const;

private:
    const Gl *gl_;
    GLenum format_;
    Buffer buffer_;
    Texture view_;
};

/// Pixels lie in blocks of 4x4, as llvmpipe shades them: a block of words is one cache line.
inline constexpr int block_pixels = 16;

/// The number of blocks that cover the view.
std::size_t block_count(Size size);

/// `int block_of_pixel()` and `int place_in_block()` for a fragment shader.
std::string pixel_order_glsl(Size size);

/// Draws a scene with a program that only writes to memory.
void draw_without_color(const Gl &gl, const GlScene &scene, const Program &program);

} // namespace kb::bench
