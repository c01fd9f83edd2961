// SPDX-License-Identifier: MIT

#include "tests/reference/gl_target.hpp"

#include "lib/gl/mesh_buffers.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>

namespace kb::reference
{

namespace
{

constexpr int all_layers = -1;

// Row y of the result is row y % height of sample (y / height) % samples of a layer.
constexpr const char *copy_shader = R"(#version 330
uniform {} samples_texture;
uniform int height;
uniform int samples;
layout(location = 0) out vec4 result;

void main()
{{
    ivec2 at = ivec2(gl_FragCoord.xy);
    int slice = at.y / height;
    result = vec4(texelFetch(samples_texture, ivec3(at.x, at.y % height, slice / samples),
                             slice % samples));
}}
)";

int bits_of(DepthFormat format)
{
    return format == DepthFormat::d24 ? 24 : 16;
}

} // namespace

GLenum internal_format(ColorFormat format)
{
    switch (format) {
    case ColorFormat::rgba32f:
        return GL_RGBA32F;
    case ColorFormat::rgba16f:
        return GL_RGBA16F;
    case ColorFormat::rgba8:
        return GL_RGBA8;
    case ColorFormat::rgb10_a2:
        return GL_RGB10_A2;
    case ColorFormat::r8:
        return GL_R8;
    case ColorFormat::r32ui:
        break;
    }
    return GL_R32UI;
}

GLenum internal_format(DepthFormat format)
{
    switch (format) {
    case DepthFormat::d24:
        return GL_DEPTH_COMPONENT24;
    case DepthFormat::d16:
        return GL_DEPTH_COMPONENT16;
    case DepthFormat::d32f:
        break;
    }
    return GL_DEPTH_COMPONENT32F;
}

std::uint32_t encode_depth(DepthFormat format, double depth)
{
    // Adding zero makes one of the two zeros.
    if (format == DepthFormat::d32f)
        return std::bit_cast<std::uint32_t>(static_cast<float>(depth) + 0.0F);
    return static_cast<std::uint32_t>(std::lround(depth * (std::exp2(bits_of(format)) - 1.0)));
}

double decode_depth(DepthFormat format, std::uint32_t code)
{
    if (format == DepthFormat::d32f)
        return static_cast<double>(std::bit_cast<float>(code));
    return code / (std::exp2(bits_of(format)) - 1.0);
}

double depth_step(DepthFormat format)
{
    return format == DepthFormat::d32f ? 0x1p-24 : 1.0 / (std::exp2(bits_of(format)) - 1.0);
}

Result<std::vector<Color>> SampleReader::read(GLuint texture, const char *sampler, int width,
                                              int height, int layers, int samples)
{
    const Gl &gl = *gl_;
    auto found = programs_.find(sampler);
    if (found == programs_.end()) {
        auto program = Program::make(gl, full_screen_vertex_shader,
                                     fmt::format(fmt::runtime(copy_shader), sampler));
        if (!program)
            return program.error();
        found = programs_.emplace(sampler, std::move(*program)).first;
    }
    const int rows = height * layers * samples;
    const Texture copy = make_texture_2d(gl, GL_RGBA32F, width, rows);
    const Framebuffer framebuffer(gl);
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, copy.id(), 0);
    if (auto complete = check_framebuffer(gl); !complete)
        return complete.error();
    gl.Viewport(0, 0, width, rows);
    gl.ActiveTexture(GL_TEXTURE0);
    gl.BindTexture(GL_TEXTURE_2D_MULTISAMPLE_ARRAY, texture);
    found->second.use();
    gl.Uniform1i(found->second.uniform("height"), height);
    gl.Uniform1i(found->second.uniform("samples"), samples);
    draw_full_screen(gl, empty_);

    const auto size = std::size_t(width) * std::size_t(height);
    std::vector<Color> by_sample(std::size_t(width) * std::size_t(rows));
    gl.ReadPixels(0, 0, width, rows, GL_RGBA, GL_FLOAT, by_sample.data());
    std::vector<Color> colors(by_sample.size());
    const auto s = std::size_t(samples);
    for (std::size_t i = 0; i < by_sample.size(); ++i) {
        const std::size_t slice = i / size;
        colors[((slice / s) * size + i % size) * s + slice % s] = by_sample[i];
    }
    return colors;
}

Texture Target::make_texture(GLenum format) const
{
    return shape_.samples > 0
               ? make_texture_2d_multisample_array(gl(), format, shape_.samples, shape_.width,
                                                   shape_.height, shape_.layers)
               : make_texture_2d_array(gl(), format, shape_.width, shape_.height, shape_.layers);
}

Result<Target> Target::make(const Gl &gl, const TargetShape &shape)
{
    Target target(gl, shape);
    for (const GLenum format : shape.colors)
        target.colors_.push_back(target.make_texture(format));
    if (shape.depth)
        target.depth_ = target.make_texture(internal_format(*shape.depth));
    target.bind_all();
    std::vector<GLenum> buffers;
    for (std::size_t a = 0; a < shape.colors.size(); ++a)
        buffers.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(a));
    if (buffers.empty())
        buffers.push_back(GL_NONE);
    gl.DrawBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
    if (auto complete = check_framebuffer(gl); !complete)
        return complete.error();
    return target;
}

void Target::attach(GLenum point, const Texture &texture, int layer) const
{
    if (layer == all_layers)
        gl().FramebufferTexture(GL_FRAMEBUFFER, point, texture.id(), 0);
    else
        gl().FramebufferTextureLayer(GL_FRAMEBUFFER, point, texture.id(), 0, layer);
}

void Target::bind(int layer) const
{
    gl().BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    for (std::size_t a = 0; a < colors_.size(); ++a)
        attach(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(a), colors_[a], layer);
    if (depth_)
        attach(GL_DEPTH_ATTACHMENT, *depth_, layer);
}

void Target::bind_all() const
{
    bind(all_layers);
}

void Target::bind_layer(int layer) const
{
    bind(layer);
}

void Target::bind_textures() const
{
    for (std::size_t a = 0; a < colors_.size(); ++a) {
        gl().ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(a));
        gl().BindTexture(texture_target(), colors_[a].id());
    }
    gl().ActiveTexture(GL_TEXTURE0);
}

Result<std::vector<Color>> Target::read_color(std::size_t attachment, SampleReader &reader) const
{
    const bool integer = shape_.colors[attachment] == GL_R32UI;
    const Texture &texture = colors_[attachment];
    if (shape_.samples > 0)
        return reader.read(texture.id(), integer ? "usampler2DMSArray" : "sampler2DMSArray",
                           shape_.width, shape_.height, shape_.layers, shape_.samples);
    std::vector<Color> colors(shape_.samples_a_layer() * std::size_t(shape_.layers));
    gl().BindTexture(GL_TEXTURE_2D_ARRAY, texture.id());
    if (!integer) {
        gl().GetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA, GL_FLOAT, colors.data());
        return colors;
    }
    std::vector<std::uint32_t> numbers(colors.size());
    gl().GetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, numbers.data());
    for (std::size_t i = 0; i < numbers.size(); ++i)
        colors[i] = {static_cast<float>(numbers[i]), 0.0F, 0.0F, 1.0F};
    return colors;
}

Result<std::vector<std::uint32_t>> Target::read_depth(SampleReader &reader) const
{
    std::vector<std::uint32_t> codes(shape_.samples_a_layer() * std::size_t(shape_.layers));
    if (shape_.samples > 0) {
        auto depths = reader.read(depth_->id(), "sampler2DMSArray", shape_.width, shape_.height,
                                  shape_.layers, shape_.samples);
        if (!depths)
            return depths.error();
        for (std::size_t i = 0; i < codes.size(); ++i)
            codes[i] = encode_depth(*shape_.depth, static_cast<double>((*depths)[i][0]));
        return codes;
    }
    // glGetTexImage takes integers through floats, which 24 bits do not survive.
    const bool is_float = shape_.depth == DepthFormat::d32f;
    for (int layer = 0; layer < shape_.layers; ++layer) {
        bind_layer(layer);
        gl().ReadPixels(0, 0, shape_.width, shape_.height, GL_DEPTH_COMPONENT,
                        is_float ? GL_FLOAT : GL_UNSIGNED_INT,
                        codes.data() + std::size_t(layer) * shape_.samples_a_layer());
    }
    for (std::uint32_t &code : codes) {
        if (is_float)
            code = encode_depth(DepthFormat::d32f, static_cast<double>(std::bit_cast<float>(code)));
        else // GL widens by repeating the leading bits.
            code >>= 32 - bits_of(*shape_.depth);
    }
    return codes;
}

} // namespace kb::reference
