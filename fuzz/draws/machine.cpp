// SPDX-License-Identifier: MIT

#include "fuzz/draws/machine.hpp"

#include "fuzz/finding.hpp"

#include <algorithm>

namespace kb::fuzz
{

Machine::Machine(std::FILE *file) : trace(file)
{
    contexts_[0] = std::make_unique<Offscreen>();
    contexts_[0]->make_current();
    if (!has_extension("GL_MESA_depth_peeling") || !has_extension("GL_MESA_kbuffer_program"))
        finding("this driver has not both extensions");
    for (Framebuffer &framebuffer : framebuffers)
        glGenFramebuffers(1, &framebuffer.name);
    glGenRenderbuffers(GLsizei(renderbuffers.size()), renderbuffers.data());
    glGenQueries(GLsizei(queries[0].size()), queries[0].data());
    lists = glGenLists(3);
    if (take_error() != GL_NO_ERROR)
        finding("a new context does not make names of objects");
}

Machine::~Machine() = default;

std::span<const Command> all_commands()
{
    static const std::vector<Command> all = [] {
        std::vector<Command> commands;
        for (const auto part : {object_commands(), state_commands(), stage_commands(),
                                draw_commands(), pixel_commands()})
            commands.insert(commands.end(), part.begin(), part.end());
        return commands;
    }();
    return all;
}

void Machine::run(std::span<const std::uint8_t> bytes)
{
    while (!bytes.empty()) {
        const auto record = bytes.first(std::min(record_size, bytes.size()));
        const Command &command = all_commands()[record.front() % all_commands().size()];
        bytes = bytes.subspan(record.size());
        if (compiling() && !command.in_lists)
            continue;
        Args args(record.subspan(1));
        command.run(*this, args);
        check_error(command.name, command.errors);
    }
    // Mesa does not free a list that is never ended.
    if (compiling())
        CALL(*this, glEndList);
    check_error("glEndList",
                invalid_enum | invalid_value | invalid_operation | invalid_framebuffer);
    glFinish();
    check_error("glFinish", no_error);
}

GLenum Machine::check_error(std::string_view command, unsigned allowed)
{
    const GLenum error = take_error();
    if (error == GL_NO_ERROR)
        return error;
    trace.comment("{}", error_name(error));
    unsigned bit = 0;
    switch (error) {
    case GL_INVALID_ENUM:
        bit = invalid_enum;
        break;
    case GL_INVALID_VALUE:
        bit = invalid_value;
        break;
    case GL_INVALID_OPERATION:
        bit = invalid_operation;
        break;
    case GL_INVALID_FRAMEBUFFER_OPERATION:
        bit = invalid_framebuffer;
        break;
    case GL_STACK_OVERFLOW:
    case GL_STACK_UNDERFLOW:
        bit = stack_error;
        break;
    case GL_OUT_OF_MEMORY:
        bit = out_of_memory;
        break;
    default:
        break;
    }
    if (!(allowed & bit))
        finding("{} gives {}", command, error_name(error));
    return error;
}

void Machine::switch_context()
{
    current_ = 1 - current_;
    trace.comment("context {}", current_);
    const bool first = !contexts_[current_];
    if (first)
        contexts_[current_] = std::make_unique<Offscreen>(contexts_[0].get());
    contexts_[current_]->make_current();
    if (first)
        glGenQueries(GLsizei(queries[current_].size()), queries[current_].data());
}

bool Machine::knows_framebuffer()
{
    const GLuint name = GLuint(get_integer(GL_DRAW_FRAMEBUFFER_BINDING));
    return name == 0 || (bound_framebuffer() && !orphaned_framebuffers.contains(name));
}

Framebuffer *Machine::bound_framebuffer()
{
    const GLuint name = GLuint(get_integer(GL_DRAW_FRAMEBUFFER_BINDING));
    for (Framebuffer &framebuffer : framebuffers)
        if (framebuffer.name == name && name != 0)
            return &framebuffer;
    return nullptr;
}

} // namespace kb::fuzz
