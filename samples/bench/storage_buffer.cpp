// SPDX-License-Identifier: MIT

#include "bench/storage_buffer.hpp"

#include <fmt/format.h>

namespace kb::bench
{

static int blocks_across(int pixels)
{
    return (pixels + 3) / 4;
}

StorageBuffer::StorageBuffer(const Gl &gl, std::size_t words, GLenum format)
    : gl_(&gl), format_(format), buffer_(gl), view_(gl)
{
    gl.BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer_.id());
    gl.BufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(words * sizeof(GLuint)),
                  nullptr, GL_DYNAMIC_COPY);
    gl.BindTexture(GL_TEXTURE_BUFFER, view_.id());
    gl.TexBuffer(GL_TEXTURE_BUFFER, format, buffer_.id());
}

void StorageBuffer::bind_storage(GLuint binding) const
{
    gl_->BindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer_.id());
}

void StorageBuffer::bind_image(GLuint unit) const
{
    gl_->BindImageTexture(unit, view_.id(), 0, GL_FALSE, 0, GL_READ_ONLY, format_);
}

void StorageBuffer::clear(std::size_t words, GLuint value) const
{
    gl_->BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer_.id());
    gl_->ClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0,
                            static_cast<GLsizeiptr>(words * sizeof(GLuint)), GL_RED_INTEGER,
                            GL_UNSIGNED_INT, &value);
}

GLuint StorageBuffer::read() const
{
    GLuint word = 0;
    gl_->MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    gl_->BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer_.id());
    gl_->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof word, &word);
    return word;
}

std::size_t block_count(Size size)
{
    return static_cast<std::size_t>(blocks_across(size.width)) *
           static_cast<std::size_t>(blocks_across(size.height));
}

std::string pixel_order_glsl(Size size)
{
    return fmt::format(R"(
int block_of_pixel()
{{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    return (pixel.y >> 2) * {} + (pixel.x >> 2);
}}

int place_in_block()
{{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    return (pixel.y & 3) * 4 + (pixel.x & 3);
}}
)",
                       blocks_across(size.width));
}

// No color is wanted. More than that: where a triangle covers a tile and writes all of its color,
// llvmpipe drops the triangles before it, with the stores that they would do.
void draw_without_color(const Gl &gl, const GlScene &scene, const Program &program)
{
    gl.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    scene.draw(program);
    gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

} // namespace kb::bench
