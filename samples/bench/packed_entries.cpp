// SPDX-License-Identifier: MIT

#include "bench/packed_entries.hpp"

#include "bench/background.hpp"
#include "programs/kbuffer_program.hpp"

#include <fmt/format.h>

namespace kb::bench
{

PackedEntries::PackedEntries(const Gl &gl, Size size, int k)
    : gl_(gl), entries_(entry_count(EntryLayout::packed, k)),
      buffer_(must(KBuffer::make(gl, GL_RGBA32F, size, entries_))), empty_(gl),
      resolve_(make_view_program(gl, resolve_source()))
{
    resolve_.use();
    for (int i = 0; i < buffer_.attachments(); ++i)
        gl.Uniform1i(resolve_.uniform(fmt::format("attachment{}", i).c_str()), i);
}

std::string PackedEntries::resolve_source() const
{
    const int attachments = buffer_.attachments();
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
        source += fmt::format("uniform sampler2DArray attachment{};\n", i);
    source += "\nvoid main()\n{\n    ivec2 pixel = ivec2(gl_FragCoord.xy);\n";
    for (int entry = 0; entry < entries_; ++entry)
        source += fmt::format("    add(texelFetch(attachment{}, ivec3(pixel, {}), 0));\n",
                              entry % attachments, entry / attachments);
    return source +
           fmt::format("    color = vec4(sum + transmittance * {}, 1.0);\n}}\n", background_glsl());
}

void PackedEntries::begin() const
{
    buffer_.clear({0.0F, 1.0F, 0.0F, 1.0F}); // no color, farthest depth
}

void PackedEntries::resolve(GLuint target) const
{
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target);
    buffer_.bind_textures();
    resolve_.use();
    draw_full_screen(gl_, empty_);
}

int PackedEntries::bytes_per_pixel() const
{
    return buffer_.attachments() * buffer_.layers() * 16;
}

} // namespace kb::bench
