// SPDX-License-Identifier: MIT
//
// GL objects that delete themselves. Each keeps a pointer to the function table of its context and
// must be destroyed before the context.

#pragma once

#include "lib/gl/gl.hpp"

#include <span>
#include <string>
#include <utility>

namespace kb
{

/// A name made by a glGen* function and deleted by the matching glDelete* function.
template <auto Gen, auto Delete>
class Handle
{
public:
    explicit Handle(const Gl &gl) : gl_(&gl) { (gl.*Gen)(1, &id_); }
    Handle(Handle &&other) noexcept : gl_(other.gl_), id_(std::exchange(other.id_, 0)) {}
    Handle &operator=(Handle &&other) noexcept
    {
        std::swap(gl_, other.gl_);
        std::swap(id_, other.id_);
        return *this;
    }
    ~Handle()
    {
        if (id_)
            (gl_->*Delete)(1, &id_);
    }

    GLuint id() const { return id_; }
    const Gl &gl() const { return *gl_; }

private:
    const Gl *gl_;
    GLuint id_ = 0;
};

using Texture = Handle<&Gl::GenTextures, &Gl::DeleteTextures>;
using Framebuffer = Handle<&Gl::GenFramebuffers, &Gl::DeleteFramebuffers>;
using Buffer = Handle<&Gl::GenBuffers, &Gl::DeleteBuffers>;
using VertexArray = Handle<&Gl::GenVertexArrays, &Gl::DeleteVertexArrays>;
using Query = Handle<&Gl::GenQueries, &Gl::DeleteQueries>;

/// A texture of one level, nearest filtering, undefined contents.
Texture make_texture_2d(const Gl &gl, GLenum internal_format, int width, int height);
Texture make_texture_2d_array(const Gl &gl, GLenum internal_format, int width, int height,
                              int layers);

/// The same with a number of samples a pixel.
Texture make_texture_2d_multisample(const Gl &gl, GLenum internal_format, int samples, int width,
                                    int height);
Texture make_texture_2d_multisample_array(const Gl &gl, GLenum internal_format, int samples,
                                          int width, int height, int layers);

/// An error unless the framebuffer bound for drawing is complete.
Status check_framebuffer(const Gl &gl);

/// A GLSL program of a vertex and a fragment shader.
class Program
{
public:
    static Result<Program> make(const Gl &gl, const std::string &vertex_source,
                                const std::string &fragment_source);
    Program(Program &&other) noexcept : gl_(other.gl_), id_(std::exchange(other.id_, 0)) {}
    Program &operator=(Program &&other) noexcept
    {
        std::swap(gl_, other.gl_);
        std::swap(id_, other.id_);
        return *this;
    }
    ~Program();

    void use() const { gl_->UseProgram(id_); }
    GLint uniform(const char *name) const { return gl_->GetUniformLocation(id_, name); }
    GLuint id() const { return id_; }

private:
    Program(const Gl &gl, GLuint id) : gl_(&gl), id_(id) {}

    const Gl *gl_;
    GLuint id_;
};

/// An assembly program of any target: GL_KBUFFER_PROGRAM_MESA, GL_FRAGMENT_PROGRAM_ARB...
class ArbProgram
{
public:
    /// Leaves the program bound. The error has GL's error string and the line that it points to.
    static Result<ArbProgram> make(const Gl &gl, GLenum target, const std::string &source);

    void bind() const { handle_.gl().BindProgramARB(target_, handle_.id()); }

private:
    ArbProgram(const Gl &gl, GLenum target) : handle_(gl), target_(target) {}

    Handle<&Gl::GenProgramsARB, &Gl::DeleteProgramsARB> handle_;
    GLenum target_;
};

} // namespace kb
