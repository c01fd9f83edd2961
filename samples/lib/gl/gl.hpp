// SPDX-License-Identifier: MIT
//
// The GL functions that the samples use, as a table of pointers. A context fills it through its own
// GetProcAddress, so that one program runs on any libOSMesa, libEGL or libGL that the loader finds,
// whether or not it was built for the vendor-neutral dispatch library.

#pragma once

#ifndef GL_GLEXT_PROTOTYPES
#define GL_GLEXT_PROTOTYPES 1 // Only for the types: nothing is linked with these.
#endif
#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/mesa_kbuffer.h>

#include "lib/result.hpp"

#include <functional>
#include <string_view>

// clang-format off
#define KB_GL_FUNCTIONS(F) \
    F(ActiveTexture) F(AttachShader) F(BeginQuery) F(BindBuffer) F(BindBufferBase) \
    F(BindFramebuffer) F(BindImageTexture) F(BindProgramARB) F(BindTexture) F(BindVertexArray) \
    F(BlendEquation) F(BlendFunc) F(BlendFuncSeparate) F(BlendFuncSeparatei) F(BlendFunci) \
    F(BlitFramebuffer) F(BufferData) F(CheckFramebufferStatus) F(Clear) F(ClearBufferSubData) \
    F(ClearBufferfv) F(ClearBufferiv) F(ClearBufferuiv) F(ClearColor) F(ClearDepth) F(ClipControl) \
    F(ColorMask) F(CompileShader) F(CreateProgram) F(CreateShader) F(CullFace) F(DeleteBuffers) \
    F(DeleteFramebuffers) F(DeleteProgram) F(DeleteProgramsARB) F(DeleteQueries) F(DeleteShader) \
    F(DeleteTextures) F(DeleteVertexArrays) F(DepthFunc) F(DepthMask) F(DepthRange) F(Disable) \
    F(DrawArrays) F(DrawBuffers) F(DrawElements) F(Enable) F(EnableVertexAttribArray) F(EndQuery) \
    F(Finish) F(Flush) F(FramebufferParameteri) F(FramebufferTexture) F(FramebufferTexture2D) \
    F(FramebufferTextureLayer) F(GenBuffers) F(GenFramebuffers) F(GenProgramsARB) F(GenQueries) \
    F(GenTextures) F(GenVertexArrays) F(GetBufferSubData) F(GetError) F(GetFramebufferParameteriv) \
    F(GetIntegerv) F(GetMultisamplefv) F(GetProgramInfoLog) F(GetProgramiv) F(GetQueryObjectui64v) \
    F(GetQueryObjectuiv) F(GetShaderInfoLog) F(GetShaderiv) F(GetString) F(GetStringi) \
    F(GetTexImage) F(GetUniformLocation) F(LinkProgram) F(MemoryBarrier) F(PixelStorei) \
    F(ProgramEnvParameter4fARB) F(ProgramLocalParameter4fARB) F(ProgramStringARB) F(ReadBuffer) \
    F(ReadPixels) F(Scissor) F(ShaderSource) F(TexBuffer) F(TexImage2D) F(TexImage2DMultisample) \
    F(TexImage3D) F(TexImage3DMultisample) F(TexParameteri) F(Uniform1f) F(Uniform1i) F(Uniform3f) \
    F(Uniform4f) F(UniformMatrix3fv) F(UniformMatrix4fv) F(UseProgram) F(VertexAttrib4f) \
    F(VertexAttribPointer) F(Viewport)
// clang-format on

namespace kb
{

struct Gl {
#define KB_GL_DECLARE(name) decltype(&::gl##name) name = nullptr;
    KB_GL_FUNCTIONS(KB_GL_DECLARE)
#undef KB_GL_DECLARE
};

using GlProc = void (*)();

/// Fills the table, or names the first function that is missing.
Result<Gl> load_gl(const std::function<GlProc(const char *)> &proc_address);

bool has_extension(const Gl &gl, std::string_view name);

/// GL_RENDERER and GL_VERSION, for messages.
std::string describe_driver(const Gl &gl);

/// An error that names the first GL error since the last call, if there was one.
Status check_gl(const Gl &gl, std::string_view doing);

} // namespace kb
