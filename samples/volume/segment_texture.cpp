// SPDX-License-Identifier: MIT

#include "segment_texture.hpp"

namespace kb
{

static Texture make_texture(const Gl &gl, const PreintegratedTable &table,
                            const std::vector<glm::vec4> &texels, GLint filter)
{
    Texture texture(gl);
    gl.BindTexture(GL_TEXTURE_2D, texture.id());
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, table.size().means, table.size().differences, 0,
                  GL_RGBA, GL_FLOAT, texels.data());
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return texture;
}

SegmentTextures::SegmentTextures(const Gl &gl, const PreintegratedTable &table, GLint filter)
    : thin_(make_texture(gl, table, table.thin(), filter)),
      fading_(make_texture(gl, table, table.fading(), filter))
{
}

void SegmentTextures::bind(int unit) const
{
    const Gl &gl = thin_.gl();
    gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    gl.BindTexture(GL_TEXTURE_2D, thin_.id());
    gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit) + 1);
    gl.BindTexture(GL_TEXTURE_2D, fading_.id());
    gl.ActiveTexture(GL_TEXTURE0);
}

} // namespace kb
