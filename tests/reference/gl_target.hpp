// SPDX-License-Identifier: MIT
//
// Array textures that are drawn to, as a whole or a layer at a time, and read back sample by
// sample.

#pragma once

#include "lib/gl/gl_objects.hpp"
#include "tests/reference/a_buffer.hpp"
#include "tests/reference/scene.hpp"

#include <map>
#include <optional>
#include <vector>

namespace kb::reference
{

GLenum internal_format(ColorFormat format);
GLenum internal_format(DepthFormat format);

/// A depth as it is stored: the bits of a float, or the integer.
std::uint32_t encode_depth(DepthFormat format, double depth);
double decode_depth(DepthFormat format, std::uint32_t code);

/// The distance of neighbors that the format tells apart.
double depth_step(DepthFormat format);

/// Copies samples to where they can be read. Shared by all targets.
class SampleReader
{
public:
    explicit SampleReader(const Gl &gl) : gl_(&gl), empty_(gl) {}

    /// All layers below each other, the samples of a layer below each other: RGBA as floats.
    Result<std::vector<Color>> read(GLuint texture, const char *sampler, int width, int height,
                                    int layers, int samples);

private:
    const Gl *gl_;
    VertexArray empty_;
    std::map<std::string, Program> programs_;
};

struct TargetShape {
    int width = 0;
    int height = 0;
    int layers = 1;
    int samples = 0;
    std::vector<GLenum> colors;
    std::optional<DepthFormat> depth;

    int samples_a_pixel() const { return samples > 0 ? samples : 1; }
    std::size_t samples_a_layer() const
    {
        return std::size_t(width) * std::size_t(height) * std::size_t(samples_a_pixel());
    }
};

/// The textures and one framebuffer.
class Target
{
public:
    static Result<Target> make(const Gl &gl, const TargetShape &shape);

    void bind_all() const;            ///< As a layered framebuffer.
    void bind_layer(int layer) const; ///< One layer.
    void bind_textures() const;       ///< Colors from unit 0 on.

    /// Layer by layer; in a layer row by row from the bottom, the samples of a pixel in a row.
    Result<std::vector<Color>> read_color(std::size_t attachment, SampleReader &reader) const;
    Result<std::vector<std::uint32_t>> read_depth(SampleReader &reader) const;

    const TargetShape &shape() const { return shape_; }
    const Gl &gl() const { return framebuffer_.gl(); }

private:
    Target(const Gl &gl, TargetShape shape) : framebuffer_(gl), shape_(std::move(shape)) {}

    GLenum texture_target() const
    {
        return shape_.samples > 0 ? GL_TEXTURE_2D_MULTISAMPLE_ARRAY : GL_TEXTURE_2D_ARRAY;
    }
    Texture make_texture(GLenum format) const;
    void attach(GLenum point, const Texture &texture, int layer) const;
    void bind(int layer) const;

    Framebuffer framebuffer_;
    std::vector<Texture> colors_;
    std::optional<Texture> depth_;
    TargetShape shape_;
};

} // namespace kb::reference
