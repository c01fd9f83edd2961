// SPDX-License-Identifier: MIT

#include "segment_texture.hpp"

namespace kb
{

Texture make_segment_texture(const Gl &gl, const PreintegratedTable &table)
{
    Texture texture(gl);
    gl.BindTexture(GL_TEXTURE_3D, texture.id());
    gl.TexImage3D(GL_TEXTURE_3D, 0, GL_RGBA32F, PreintegratedTable::scalars,
                  PreintegratedTable::scalars, PreintegratedTable::lengths, 0, GL_RGBA, GL_FLOAT,
                  table.texels().data());
    gl.TexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl.TexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    gl.TexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAX_LEVEL, 0);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        gl.TexParameteri(GL_TEXTURE_3D, wrap, GL_CLAMP_TO_EDGE);
    return texture;
}

} // namespace kb
