// SPDX-License-Identifier: MIT

#include "packed_entries.hpp"

#include "background.hpp"
#include "kbuffer_program.hpp"

#include <array>

namespace kb::bench
{

namespace
{

constexpr int max_attachments = 8;

constexpr int divide_up(int dividend, int divisor)
{
    return (dividend + divisor - 1) / divisor;
}

} // namespace

PackedEntries::PackedEntries(const Gl &gl, Size size, int k)
    : gl_(gl), entries_(entry_count(EntryLayout::packed, k)),
      layers_(divide_up(entries_, max_attachments)), framebuffer_(gl), empty_(gl),
      resolve_(make_view_program(gl, resolve_source()))
{
    const int attachments = divide_up(entries_, layers_);
    std::vector<GLenum> draw_buffers;
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    for (int i = 0; i < attachments; ++i) {
        attachments_.push_back(
            layers_ == 1 ? make_texture_2d(gl, GL_RGBA32F, size.width, size.height)
                         : make_texture_2d_array(gl, GL_RGBA32F, size.width, size.height, layers_));
        draw_buffers.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i));
        gl.FramebufferTexture(GL_FRAMEBUFFER, draw_buffers.back(), attachments_.back().id(), 0);
    }
    gl.DrawBuffers(attachments, draw_buffers.data());
    must(check_framebuffer(gl));

    resolve_.use();
    for (int i = 0; i < attachments; ++i)
        gl.Uniform1i(resolve_.uniform(fmt::format("attachment{}", i).c_str()), i);
}

std::string PackedEntries::resolve_source() const
{
    const int attachments = divide_up(entries_, layers_);
    std::string source = R"(
out vec4 color;
vec3 sum = vec3(0.0);
float transmittance = 1.0;

void add(float packed_color)
{
    vec4 fragment = unpackUnorm4x8(floatBitsToUint(packed_color));
    sum += transmittance * fragment.a * fragment.rgb;
    transmittance *= 1.0 - fragment.a;
}

void add(vec4 entry)
{
    add(entry.x);
    add(entry.z);
}
)";
    for (int i = 0; i < attachments; ++i)
        source += fmt::format("uniform {} attachment{};\n",
                              layers_ == 1 ? "sampler2D" : "sampler2DArray", i);
    source += "\nvoid main()\n{\n    ivec2 pixel = ivec2(gl_FragCoord.xy);\n";
    for (int entry = 0; entry < entries_; ++entry) {
        const std::string place =
            layers_ == 1 ? "pixel" : fmt::format("ivec3(pixel, {})", entry / attachments);
        source +=
            fmt::format("    add(texelFetch(attachment{}, {}, 0));\n", entry % attachments, place);
    }
    return source +
           fmt::format("    color = vec4(sum + transmittance * {}, 1.0);\n}}\n", background_glsl());
}

void PackedEntries::begin() const
{
    constexpr std::array<GLfloat, 4> no_fragments{0.0F, 1.0F, 0.0F, 1.0F};
    gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    for (std::size_t i = 0; i < attachments_.size(); ++i)
        gl_.ClearBufferfv(GL_COLOR, static_cast<GLint>(i), no_fragments.data());
}

void PackedEntries::resolve(GLuint target) const
{
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target);
    for (std::size_t i = 0; i < attachments_.size(); ++i) {
        gl_.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
        gl_.BindTexture(layers_ == 1 ? GL_TEXTURE_2D : GL_TEXTURE_2D_ARRAY, attachments_[i].id());
    }
    resolve_.use();
    draw_full_screen(gl_, empty_);
}

int PackedEntries::bytes_per_pixel() const
{
    return static_cast<int>(attachments_.size()) * layers_ * 16;
}

} // namespace kb::bench
