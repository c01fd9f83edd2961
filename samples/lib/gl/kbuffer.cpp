// SPDX-License-Identifier: MIT

#include "lib/gl/kbuffer.hpp"

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>

namespace kb
{

constexpr int max_attachments = 8;

Result<KBuffer> KBuffer::make(const Gl &gl, GLenum internal_format, Size size, int entries)
{
    // A driver without the extension has the entries that framebuffer fetch reaches: one layer.
    GLint max_entries = max_attachments;
    if (has_extension(gl, "GL_MESA_kbuffer_program"))
        gl.GetIntegerv(GL_MAX_KBUFFER_ENTRIES_MESA, &max_entries);
    if (entries < 1 || entries > max_entries)
        return Error{fmt::format("a k-buffer of {} entries is wanted, the driver has {}", entries,
                                 max_entries)};

    const int layers = (entries + max_attachments - 1) / max_attachments;
    const int attachments = (entries + layers - 1) / layers;
    KBuffer kbuffer(gl, size, layers);
    gl.BindFramebuffer(GL_FRAMEBUFFER, kbuffer.framebuffer_.id());
    std::vector<GLenum> draw_buffers;
    for (int a = 0; a < attachments; ++a) {
        kbuffer.textures_.push_back(
            make_texture_2d_array(gl, internal_format, size.width, size.height, layers));
        draw_buffers.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(a));
        gl.FramebufferTexture(GL_FRAMEBUFFER, draw_buffers.back(), kbuffer.textures_.back().id(),
                              0);
    }
    gl.DrawBuffers(attachments, draw_buffers.data());
    if (auto complete = check_framebuffer(gl); !complete)
        return complete.error();
    return kbuffer;
}

void KBuffer::bind() const
{
    const Gl &gl = framebuffer_.gl();
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    gl.Viewport(0, 0, size_.width, size_.height);
}

void KBuffer::clear(glm::vec4 value) const
{
    bind();
    for (int a = 0; a < attachments(); ++a)
        framebuffer_.gl().ClearBufferfv(GL_COLOR, a, glm::value_ptr(value));
}

void KBuffer::bind_textures() const
{
    const Gl &gl = framebuffer_.gl();
    for (std::size_t a = 0; a < textures_.size(); ++a) {
        gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(a));
        gl.BindTexture(GL_TEXTURE_2D_ARRAY, textures_[a].id());
    }
    gl.ActiveTexture(GL_TEXTURE0);
}

ImageRgbaF KBuffer::read_entry(int entry) const
{
    const Gl &gl = framebuffer_.gl();
    const Texture &texture = textures_[static_cast<std::size_t>(entry % attachments())];
    // One layer in a framebuffer of its own: reading a layered one gives layer 0.
    const Framebuffer layer(gl);
    gl.BindFramebuffer(GL_FRAMEBUFFER, layer.id());
    gl.FramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture.id(), 0,
                               entry / attachments());
    return read_color(gl, layer.id(), size_);
}

template <class Pixel>
static void flip(Image<Pixel> &image)
{
    for (int y = 0; y < image.height / 2; ++y)
        std::swap_ranges(&image.at(0, y), &image.at(0, y) + image.width,
                         &image.at(0, image.height - 1 - y));
}

ImageRgbaF read_color(const Gl &gl, GLuint framebuffer, Size size)
{
    ImageRgbaF image(size.width, size.height);
    gl.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    gl.ReadBuffer(GL_COLOR_ATTACHMENT0);
    gl.ReadPixels(0, 0, size.width, size.height, GL_RGBA, GL_FLOAT, image.pixels.data());
    flip(image);
    return image;
}

ImageF read_depth(const Gl &gl, GLuint framebuffer, Size size)
{
    ImageF image(size.width, size.height);
    gl.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    gl.ReadPixels(0, 0, size.width, size.height, GL_DEPTH_COMPONENT, GL_FLOAT, image.pixels.data());
    flip(image);
    return image;
}

} // namespace kb
