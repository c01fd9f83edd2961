// SPDX-License-Identifier: MIT

#include "tests/hard_cases/layers.hpp"

#include "bench/gl_scene.hpp"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace kb::hard
{

using bench::must;

Composite composite_front_to_back(std::span<const Fragment> fragments)
{
    Composite sum;
    float transmittance = 1.0F;
    for (const Fragment &fragment : fragments) {
        sum.color += transmittance * (fragment.alpha * fragment.value);
        transmittance *= 1.0F - fragment.alpha;
    }
    sum.alpha = 1.0F - transmittance;
    return sum;
}

Composite composite_back_to_front(std::span<const Fragment> fragments)
{
    Composite sum;
    std::for_each(fragments.rbegin(), fragments.rend(), [&](const Fragment &fragment) {
        sum.color = fragment.alpha * fragment.value + (1.0F - fragment.alpha) * sum.color;
        sum.alpha = fragment.alpha + (1.0F - fragment.alpha) * sum.alpha;
    });
    return sum;
}

double greatest_code(GLenum depth_format)
{
    switch (depth_format) {
    case GL_DEPTH_COMPONENT16:
        return std::ldexp(1.0, 16) - 1.0;
    case GL_DEPTH_COMPONENT24:
        return std::ldexp(1.0, 24) - 1.0;
    case GL_DEPTH_COMPONENT32:
        return std::ldexp(1.0, 32) - 1.0;
    default:
        return 0.0;
    }
}

static constexpr const char *copy_shader = R"(#version 330
uniform sampler2DMSArray layers;
uniform int layer;
uniform int index;
out vec4 color;

void main()
{
    color = texelFetch(layers, ivec3(gl_FragCoord.xy, layer), index);
}
)";

LayerReader::LayerReader(const Gl &gl, Size size, int samples)
    : gl_(gl), size_(size), samples_(std::max(samples, 1)), framebuffer_(gl)
{
    if (samples == 0)
        return;
    copy_.emplace(SampleCopy{must(Program::make(gl, full_screen_vertex_shader, copy_shader)),
                             make_texture_2d(gl, GL_RGBA32F, size.width, size.height),
                             VertexArray(gl)});
}

std::size_t LayerReader::pixels() const
{
    return static_cast<std::size_t>(size_.width) * static_cast<std::size_t>(size_.height);
}

/// Of samples: as a shader sees them.
std::vector<glm::vec4> LayerReader::read_floats(const Texture &texture, int layer, int sample) const
{
    gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    gl_.Viewport(0, 0, size_.width, size_.height);
    if (copy_) {
        gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                                 copy_->texture.id(), 0);
        gl_.BindTexture(GL_TEXTURE_2D_MULTISAMPLE_ARRAY, texture.id());
        copy_->program.use();
        gl_.Uniform1i(copy_->program.uniform("layer"), layer);
        gl_.Uniform1i(copy_->program.uniform("index"), sample);
        draw_full_screen(gl_, copy_->empty);
    } else {
        gl_.FramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture.id(), 0, layer);
    }
    std::vector<glm::vec4> values(pixels());
    gl_.ReadPixels(0, 0, size_.width, size_.height, GL_RGBA, GL_FLOAT, values.data());
    must(check_gl(gl_, "reading a layer"));
    return values;
}

std::vector<glm::vec4> LayerReader::read_color(const Texture &texture, int layer, int sample) const
{
    return read_floats(texture, layer, sample);
}

std::vector<double> LayerReader::read_depth(const Texture &texture, GLenum format, int layer,
                                            int sample) const
{
    std::vector<double> depths;
    depths.reserve(pixels());
    const double greatest = greatest_code(format);
    const auto append = [&](double depth) {
        depths.push_back(greatest == 0.0 ? depth : std::round(depth * greatest) / greatest);
    };
    if (copy_) {
        for (const glm::vec4 &value : read_floats(texture, layer, sample))
            append(static_cast<double>(value.r));
        return depths;
    }
    const Framebuffer single(gl_);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, single.id());
    gl_.FramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, texture.id(), 0, layer);
    if (greatest == 0.0) {
        std::vector<float> values(pixels());
        gl_.ReadPixels(0, 0, size_.width, size_.height, GL_DEPTH_COMPONENT, GL_FLOAT,
                       values.data());
        std::ranges::for_each(values, append);
    } else {
        std::vector<std::uint32_t> values(pixels());
        gl_.ReadPixels(0, 0, size_.width, size_.height, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT,
                       values.data());
        for (const std::uint32_t value : values)
            append(static_cast<double>(value) / greatest_code(GL_DEPTH_COMPONENT32));
    }
    must(check_gl(gl_, "reading the depths of a layer"));
    return depths;
}

} // namespace kb::hard
