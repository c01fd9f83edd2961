// SPDX-License-Identifier: MIT
//
// Runs a sequence of commands, each decoded from a record of eight bytes, in two contexts that
// share their objects, and knows of these objects what the promises are checked against.

#pragma once

#include "fuzz/draws/trace.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <vector>

namespace kb::fuzz
{

/// The arguments of a command: the bytes of its record after the first, then zeros.
class Args
{
public:
    explicit Args(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    unsigned byte()
    {
        if (bytes_.empty())
            return 0;
        const unsigned value = bytes_.front();
        bytes_ = bytes_.subspan(1);
        return value;
    }
    int below(int count) { return int(byte()) % count; }
    bool flag() { return byte() & 1; }
    float unit() { return float(byte()) / 255.0F; }

    template <class Choices>
    const auto &pick(const Choices &choices)
    {
        return choices[byte() % std::size(choices)];
    }

private:
    std::span<const std::uint8_t> bytes_;
};

struct Texture {
    GLuint name = 0;
    Named target;
    Named format;
    bool immutable = false;
};

/// What the form of a texture is, by its name. No two textures of a run have the same name at once,
/// but a deleted one lives on while it is attached, and its name may be given away again.
struct TextureForm {
    GLenum target = 0;
    GLenum format = 0;
    int width = 0, height = 0;
    int layers = 0; ///< Also the depth of a 3D texture, the faces of a cube.
    int samples = 0;
    bool certain = true; ///< False when the name has been deleted.
};

/// What depth peeling remembers of a framebuffer.
struct PeelState {
    int first_layer = 0;
    GLenum depth_func = 0;
    GLenum format = 0;
    int width = 0, height = 0, layers = 0, samples = 0;
};

struct Framebuffer {
    GLuint name = 0;
    PeelState peel;
    unsigned contexts = 0; ///< A bit for each context in which it has been bound.
};

struct KbufferProgram {
    GLuint name = 0;
    int text = -1; ///< Index of what it was loaded with, or -1: not valid.
};

class Machine
{
public:
    static constexpr int texture_slots = 12;
    static constexpr int framebuffer_slots = 4;

    explicit Machine(std::FILE *trace);
    ~Machine();

    /// Runs records until the bytes end.
    void run(std::span<const std::uint8_t> bytes);

    template <class Result, class... Parameters, class... Args>
    Result call(const char *name, Result (*function)(Parameters...), const Args &...args)
    {
        return trace.call(name, function, args...);
    }

    void switch_context();
    /// The index of the current context.
    unsigned context() const { return current_; }

    Framebuffer *bound_framebuffer(); ///< The draw framebuffer, unless it is the window.
    /// Whether that is certain. One that is deleted lives on where another context has bound it,
    /// and its name may be given away again.
    bool knows_framebuffer();

    Trace trace;
    std::array<Texture, texture_slots> textures;
    std::map<GLuint, TextureForm> forms;
    std::array<Framebuffer, framebuffer_slots> framebuffers;
    std::set<GLuint> orphaned_framebuffers; ///< Names that were deleted while bound elsewhere.
    std::vector<KbufferProgram> kbuffer_programs;
    std::map<int, GLuint> shader_programs; ///< By the index of the fragment stage.
    std::array<GLuint, 2> renderbuffers{};
    std::array<GLuint, 2> fragment_programs{};
    std::array<std::array<GLuint, 2>, 2> queries{}; ///< For each context.
    GLuint lists = 0;
    int open_list = -1;
    bool list_executes = false;

    /// A list that was called may have drawn: what is promised of draws is then not checked.
    bool compiling() const { return open_list >= 0; }

    /// The error since the last check, which has to be one of these bits of Errors.
    GLenum check_error(std::string_view command, unsigned allowed);

private:
    std::array<std::unique_ptr<Offscreen>, 2> contexts_;
    unsigned current_ = 0;
};

/// CALL(machine, glEnable, GL_NAMED(GL_DEPTH_TEST))
#define CALL(machine, function, ...) (machine).call(#function, function __VA_OPT__(, ) __VA_ARGS__)

/// Errors that a command may generate.
enum Errors : unsigned {
    no_error = 0,
    invalid_enum = 1,
    invalid_value = 2,
    invalid_operation = 4,
    invalid_framebuffer = 8,
    stack_error = 16,
    out_of_memory = 32,
};

struct Command {
    std::string_view name;
    void (*run)(Machine &, Args &);
    unsigned errors;
    bool in_lists = false; ///< Whether it also runs while a display list is compiled.
    int weight = 1;        ///< How often the mutator takes it.
};

/// All commands; a record's first byte selects one (modulo their number).
std::span<const Command> all_commands();

constexpr std::size_t record_size = 8;

// The commands by subject: see the file of that name.
std::span<const Command> object_commands();
std::span<const Command> state_commands();
std::span<const Command> stage_commands();
std::span<const Command> draw_commands();
std::span<const Command> pixel_commands();

} // namespace kb::fuzz
