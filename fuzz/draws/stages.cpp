// SPDX-License-Identifier: MIT
//
// What runs for fragments: k-buffer programs and fragment stages of every kind.

#include "fuzz/draws/machine.hpp"
#include "fuzz/draws/programs.hpp"
#include "fuzz/finding.hpp"

#include <algorithm>

namespace kb::fuzz
{

namespace
{

constexpr Named kbuffer_target = GL_NAMED(GL_KBUFFER_PROGRAM_MESA);
constexpr Named ascii = GL_NAMED(GL_PROGRAM_FORMAT_ASCII_ARB);

/// Loads a text into a program that is bound. A program that was valid stays what it was if the
/// string is refused.
void load(Machine &machine, KbufferProgram &program, int index)
{
    const KbufferText &text = kbuffer_texts()[std::size_t(index)];
    machine.trace.comment("program {}: {}", index, text.text);
    CALL(machine, glProgramStringARB, kbuffer_target, ascii, int(text.text.size()),
         text.text.data());
    const GLenum error =
        machine.check_error("loading a program", text.valid ? no_error : invalid_operation);
    if (!text.valid && error == GL_NO_ERROR)
        finding("program {} is accepted", index);
    if (text.valid)
        program.text = index;
}

void bind_kbuffer_program(Machine &machine, Args &args)
{
    const int index = args.below(int(kbuffer_texts().size()) + 1);
    if (machine.compiling()) {
        if (std::size_t(index) < machine.kbuffer_programs.size())
            CALL(machine, glBindProgramARB, kbuffer_target,
                 machine.kbuffer_programs[std::size_t(index)].name);
        return;
    }
    if (machine.kbuffer_programs.empty()) {
        machine.kbuffer_programs.resize(kbuffer_texts().size());
        for (KbufferProgram &program : machine.kbuffer_programs)
            glGenProgramsARB(1, &program.name);
    }
    if (std::size_t(index) == kbuffer_texts().size()) {
        CALL(machine, glBindProgramARB, kbuffer_target, 0);
        return;
    }
    KbufferProgram &program = machine.kbuffer_programs[std::size_t(index)];
    CALL(machine, glBindProgramARB, kbuffer_target, program.name);
    if (program.text < 0)
        load(machine, program, index);
}

/// Another text for the bound program, if it is one of ours and not the default.
void reload_kbuffer_program(Machine &machine, Args &args)
{
    GLint name = 0;
    glGetProgramivARB(GL_KBUFFER_PROGRAM_MESA, GL_PROGRAM_BINDING_ARB, &name);
    const auto program =
        std::find_if(machine.kbuffer_programs.begin(), machine.kbuffer_programs.end(),
                     [&](const KbufferProgram &p) { return p.name == GLuint(name); });
    if (name != 0 && program != machine.kbuffer_programs.end())
        load(machine, *program, args.below(int(kbuffer_texts().size())));
}

void delete_kbuffer_program(Machine &machine, Args &args)
{
    if (machine.kbuffer_programs.empty())
        return;
    KbufferProgram &program =
        machine.kbuffer_programs[std::size_t(args.below(int(machine.kbuffer_programs.size())))];
    CALL(machine, glDeleteProgramsARB, 1, &program.name);
    program = {};
    glGenProgramsARB(1, &program.name);
}

void program_parameter(Machine &machine, Args &args)
{
    const unsigned index = args.byte();
    const float value = 4.0F * args.unit() - 1.0F;
    if (args.flag())
        CALL(machine, glProgramEnvParameter4fARB, kbuffer_target, index, value, 0.5F, -value, 1.0F);
    else
        CALL(machine, glProgramLocalParameter4fARB, kbuffer_target, index, value, 0.5F, -value,
             1.0F);
}

GLuint compile(GLuint program, GLenum stage, std::string_view source)
{
    const GLuint shader = glCreateShader(stage);
    const char *text = source.data();
    const GLint length = GLint(source.size());
    glShaderSource(shader, 1, &text, &length);
    glCompileShader(shader);
    glAttachShader(program, shader);
    glDeleteShader(shader);
    return shader;
}

/// 0 if the driver does not have what the stage needs.
GLuint make_stage(const FragmentStage &stage)
{
    const GLuint program = glCreateProgram();
    compile(program, GL_VERTEX_SHADER, vertex_shader());
    if (!stage.geometry.empty())
        compile(program, GL_GEOMETRY_SHADER, stage.geometry);
    compile(program, GL_FRAGMENT_SHADER, stage.fragment);
    glLinkProgram(program);
    GLint linked = GL_FALSE;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked)
        return program;
    glDeleteProgram(program);
    return 0;
}

void use_shaders(Machine &machine, Args &args)
{
    const int count = int(fragment_stages().size());
    const int index = args.below(count + 1);
    if (index == count) {
        CALL(machine, glUseProgram, 0);
        return;
    }
    if (!machine.shader_programs.contains(index)) {
        if (machine.compiling())
            return;
        machine.shader_programs[index] = make_stage(fragment_stages()[std::size_t(index)]);
    }
    machine.trace.comment("fragment stage {}", index);
    CALL(machine, glUseProgram, machine.shader_programs[index]);
    if (!fragment_stages()[std::size_t(index)].stores || machine.shader_programs[index] == 0 ||
        machine.compiling())
        return;
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, 64, nullptr, GL_DYNAMIC_DRAW);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glBindBufferBase(index % 2 ? GL_ATOMIC_COUNTER_BUFFER : GL_SHADER_STORAGE_BUFFER, 0, buffer);
    glDeleteBuffers(1, &buffer); // It lives while it is bound.
}

void delete_shaders(Machine &machine, Args &args)
{
    const auto found = machine.shader_programs.find(args.below(int(fragment_stages().size())));
    if (found == machine.shader_programs.end())
        return;
    CALL(machine, glDeleteProgram, found->second);
    machine.shader_programs.erase(found);
}

void fragment_program(Machine &machine, Args &args)
{
    static constexpr std::array<std::string_view, 3> texts = {
        "!!ARBfp1.0\nMUL result.color, fragment.color, 0.5;\nEND\n",
        "!!ARBfp1.0\nOPTION ARB_draw_buffers;\nMOV result.color[0], fragment.color;\n"
        "MOV result.color[2], fragment.position;\nMOV result.depth.z, fragment.color.x;\nEND\n",
        "!!ARBfp1.0\nTEMP t;\nSUB t, fragment.color.x, 0.5;\nKIL t;\n"
        "MOV result.color, state.fog.color;\nEND\n"};
    GLuint &name = machine.fragment_programs[args.flag()];
    if (name == 0)
        glGenProgramsARB(1, &name);
    const std::string_view text = args.pick(texts);
    CALL(machine, glBindProgramARB, GL_NAMED(GL_FRAGMENT_PROGRAM_ARB), name);
    CALL(machine, glProgramStringARB, GL_NAMED(GL_FRAGMENT_PROGRAM_ARB), ascii, int(text.size()),
         text.data());
    CALL(machine, glEnable, GL_NAMED(GL_FRAGMENT_PROGRAM_ARB));
    CALL(machine, glUseProgram, 0);
}

constexpr std::array<Command, 7> commands{{
    {"bind_kbuffer_program", bind_kbuffer_program, no_error, true, 5},
    {"reload_kbuffer_program", reload_kbuffer_program, no_error},
    {"delete_kbuffer_program", delete_kbuffer_program, no_error},
    {"program_parameter", program_parameter, invalid_value, true},
    // A program that was deleted while a list names it is no longer one.
    {"use_shaders", use_shaders, invalid_value, true, 2},
    {"delete_shaders", delete_shaders, no_error},
    {"fragment_program", fragment_program, no_error},
}};

} // namespace

std::span<const Command> stage_commands()
{
    return commands;
}

} // namespace kb::fuzz
