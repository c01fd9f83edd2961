// SPDX-License-Identifier: MIT

#include "lib/gl/depth_peeling.hpp"

#include "lib/gl/context.hpp"
#include "lib/gl/kbuffer.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kb
{

static int bytes_of(GLenum internal_format)
{
    switch (internal_format) {
    case GL_DEPTH_COMPONENT16:
        return 2;
    case GL_RGBA16F:
    case GL_RG32F:
        return 8;
    case GL_RGBA32F:
        return 16;
    default:
        return 4;
    }
}

static int bytes_of(const PeelingLayers &layers)
{
    int bytes = bytes_of(layers.depth_format);
    for (const GLenum format : layers.color_formats)
        bytes += bytes_of(format);
    return bytes * layers.count * std::max(layers.samples, 1);
}

static int limit(const Gl &gl, GLenum name)
{
    GLint value = 0;
    gl.GetIntegerv(name, &value);
    return value;
}

/// Says which limit of the driver the layers exceed.
static Status check_limits(const Gl &gl, const PeelingLayers &layers)
{
    if (auto supported = require_depth_peeling(gl); !supported)
        return supported;
    const int max_layers = limit(gl, GL_MAX_DEPTH_PEELING_LAYERS_MESA);
    if (layers.count < 1 || layers.count > max_layers)
        return Error{fmt::format("{} layers a pass are wanted, the driver has 1 to {}",
                                 layers.count, max_layers)};
    const int max_attachments =
        std::min(limit(gl, GL_MAX_COLOR_ATTACHMENTS), limit(gl, GL_MAX_DRAW_BUFFERS));
    if (static_cast<int>(layers.color_formats.size()) > max_attachments)
        return Error{fmt::format("{} color attachments are wanted, the driver has {}",
                                 layers.color_formats.size(), max_attachments)};
    const int max_side = limit(gl, GL_MAX_TEXTURE_SIZE);
    if (std::max(layers.size.width, layers.size.height) > max_side)
        return Error{fmt::format("layers of {}x{} pixels are wanted, the driver has {}x{}",
                                 layers.size.width, layers.size.height, max_side, max_side)};
    if (layers.samples == 0)
        return ok;
    const int max_samples =
        std::min(limit(gl, GL_MAX_COLOR_TEXTURE_SAMPLES), limit(gl, GL_MAX_DEPTH_TEXTURE_SAMPLES));
    if (layers.samples > max_samples)
        return Error{fmt::format("{} samples are wanted, this driver's textures have {} ({})",
                                 layers.samples, max_samples, describe_driver(gl))};
    return ok;
}

static Texture make_array(const Gl &gl, GLenum internal_format, const PeelingLayers &layers)
{
    const auto [width, height] = layers.size;
    return layers.samples > 0
               ? make_texture_2d_multisample_array(gl, internal_format, layers.samples, width,
                                                   height, layers.count)
               : make_texture_2d_array(gl, internal_format, width, height, layers.count);
}

Result<DepthPeeling> DepthPeeling::make(const Gl &gl, const PeelingLayers &layers)
{
    if (auto checked = check_limits(gl, layers); !checked)
        return checked.error();
    DepthPeeling peeling(gl, layers, make_array(gl, layers.depth_format, layers));
    gl.BindFramebuffer(GL_FRAMEBUFFER, peeling.framebuffer_.id());
    gl.FramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, peeling.depth_.id(), 0);
    std::vector<GLenum> draw_buffers;
    for (const GLenum format : layers.color_formats) {
        draw_buffers.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(draw_buffers.size()));
        peeling.colors_.push_back(make_array(gl, format, layers));
        gl.FramebufferTexture(GL_FRAMEBUFFER, draw_buffers.back(), peeling.colors_.back().id(), 0);
    }
    gl.DrawBuffers(static_cast<GLsizei>(draw_buffers.size()), draw_buffers.data());
    if (auto complete = check_framebuffer(gl); !complete)
        return Error{fmt::format("{} layers of {}x{} pixels, {} bytes per pixel: {}", layers.count,
                                 layers.size.width, layers.size.height, peeling.bytes_per_pixel(),
                                 complete.error().message)};
    return peeling;
}

void DepthPeeling::bind() const
{
    const Gl &gl = framebuffer_.gl();
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    gl.Viewport(0, 0, layers_.size.width, layers_.size.height);
}

float DepthPeeling::empty_depth() const
{
    return layers_.func == GL_GREATER || layers_.func == GL_GEQUAL ? 0.0F : 1.0F;
}

void DepthPeeling::clear() const
{
    bind();
    const Gl &gl = framebuffer_.gl();
    gl.DepthFunc(layers_.func);
    gl.DepthMask(GL_TRUE);
    gl.ClearColor(0.0F, 0.0F, 0.0F, 0.0F);
    // Also while drawing: it says from which depth on a fragment is none.
    gl.ClearDepth(empty_depth());
    gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

Status DepthPeeling::set_first_layer(int rank)
{
    const Gl &gl = framebuffer_.gl();
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    gl.FramebufferParameteri(GL_DRAW_FRAMEBUFFER, GL_DEPTH_PEELING_FIRST_LAYER_MESA, rank);
    if (auto set = check_gl(gl, fmt::format("peeling from layer {} on", rank)); !set)
        return set;
    first_layer_ = rank;
    return ok;
}

Status DepthPeeling::restart()
{
    return set_first_layer(0);
}

Status DepthPeeling::advance()
{
    return set_first_layer(first_layer_ + layers_.count);
}

bool DepthPeeling::overflow() const
{
    const Gl &gl = framebuffer_.gl();
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    GLint overflow = 0;
    gl.GetFramebufferParameteriv(GL_DRAW_FRAMEBUFFER, GL_DEPTH_PEELING_OVERFLOW_MESA, &overflow);
    return overflow != 0;
}

void DepthPeeling::bind_textures() const
{
    const Gl &gl = framebuffer_.gl();
    const GLenum target =
        layers_.samples > 0 ? GL_TEXTURE_2D_MULTISAMPLE_ARRAY : GL_TEXTURE_2D_ARRAY;
    GLenum unit = GL_TEXTURE0;
    for (const Texture &color : colors_) {
        gl.ActiveTexture(unit++);
        gl.BindTexture(target, color.id());
    }
    gl.ActiveTexture(unit);
    gl.BindTexture(target, depth_.id());
    gl.ActiveTexture(GL_TEXTURE0);
}

void DepthPeeling::with_single_layer(const Attachment &attachment, int layer,
                                     const std::function<void(GLuint)> &read) const
{
    const Gl &gl = framebuffer_.gl();
    const Framebuffer single(gl);
    gl.BindFramebuffer(GL_FRAMEBUFFER, single.id());
    gl.FramebufferTextureLayer(GL_FRAMEBUFFER, attachment.point, attachment.texture.id(), 0, layer);
    if (layers_.samples == 0)
        return read(single.id());

    const auto [width, height] = layers_.size;
    const Texture texture = make_texture_2d(gl, attachment.format, width, height);
    const Framebuffer resolved(gl);
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved.id());
    gl.FramebufferTexture2D(GL_DRAW_FRAMEBUFFER, attachment.point, GL_TEXTURE_2D, texture.id(), 0);
    gl.BlitFramebuffer(0, 0, width, height, 0, 0, width, height,
                       attachment.point == GL_DEPTH_ATTACHMENT ? GL_DEPTH_BUFFER_BIT
                                                               : GL_COLOR_BUFFER_BIT,
                       GL_NEAREST);
    read(resolved.id());
}

ImageRgbaF DepthPeeling::read_color(int layer, int attachment) const
{
    const auto a = static_cast<std::size_t>(attachment);
    ImageRgbaF image;
    with_single_layer({GL_COLOR_ATTACHMENT0, colors_[a], layers_.color_formats[a]}, layer,
                      [&](GLuint framebuffer) {
                          image = kb::read_color(framebuffer_.gl(), framebuffer, layers_.size);
                      });
    return image;
}

ImageF DepthPeeling::read_depth(int layer) const
{
    ImageF image;
    with_single_layer({GL_DEPTH_ATTACHMENT, depth_, layers_.depth_format}, layer,
                      [&](GLuint framebuffer) {
                          image = kb::read_depth(framebuffer_.gl(), framebuffer, layers_.size);
                      });
    return image;
}

int DepthPeeling::bytes_per_pixel() const
{
    return bytes_of(layers_);
}

} // namespace kb
