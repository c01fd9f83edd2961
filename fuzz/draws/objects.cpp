// SPDX-License-Identifier: MIT
//
// Textures, renderbuffers and framebuffers: made, attached, changed while they are attached,
// deleted; and the parameters of framebuffers.

#include "fuzz/draws/formats.hpp"
#include "fuzz/draws/machine.hpp"
#include "fuzz/draws/promises.hpp"
#include "fuzz/finding.hpp"

#include <algorithm>

namespace kb::fuzz
{

namespace
{

constexpr std::array<Named, 10> targets = {
    GL_NAMED(GL_TEXTURE_2D_ARRAY),
    GL_NAMED(GL_TEXTURE_2D),
    GL_NAMED(GL_TEXTURE_2D_MULTISAMPLE_ARRAY),
    GL_NAMED(GL_TEXTURE_3D),
    GL_NAMED(GL_TEXTURE_CUBE_MAP),
    GL_NAMED(GL_TEXTURE_1D_ARRAY),
    GL_NAMED(GL_TEXTURE_2D_MULTISAMPLE),
    GL_NAMED(GL_TEXTURE_CUBE_MAP_ARRAY),
    GL_NAMED(GL_TEXTURE_RECTANGLE),
    GL_NAMED(GL_TEXTURE_1D),
};

constexpr std::array<Named, 10> points = {
    GL_NAMED(GL_COLOR_ATTACHMENT0),  GL_NAMED(GL_DEPTH_ATTACHMENT),
    GL_NAMED(GL_COLOR_ATTACHMENT1),  GL_NAMED(GL_COLOR_ATTACHMENT2),
    GL_NAMED(GL_COLOR_ATTACHMENT3),  GL_NAMED(GL_COLOR_ATTACHMENT5),
    GL_NAMED(GL_COLOR_ATTACHMENT6),  GL_NAMED(GL_COLOR_ATTACHMENT7),
    GL_NAMED(GL_STENCIL_ATTACHMENT), GL_NAMED(GL_DEPTH_STENCIL_ATTACHMENT),
};

constexpr std::array<int, 10> sizes = {16, 8, 4, 1, 2, 3, 17, 33, 65, 130};
constexpr std::array<int, 12> layer_counts = {4, 2, 1, 3, 8, 5, 6, 16, 40, 64, 256, 257};

/// Storage for a texture of any target that is bound; textures are small, whatever is asked for.
void allocate(Machine &machine, const Texture &texture, TextureForm &form)
{
    constexpr int most_texels = 1 << 16;
    while (form.width * form.height * form.layers * std::max(form.samples, 1) > most_texels) {
        form.width = (form.width + 1) / 2;
        form.height = (form.height + 1) / 2;
    }
    const auto [format, type, bytes] = transfer_of(format_kind(form.format));
    const Named target = texture.target;
    const auto [w, h, d] = std::array{form.width, form.height, form.layers};
    switch (target.value) {
    case GL_TEXTURE_1D:
        form.height = form.layers = 1;
        if (texture.immutable)
            CALL(machine, glTexStorage1D, target, 1, texture.format, w);
        else
            CALL(machine, glTexImage1D, target, 0, texture.format, w, 0, format, type, nullptr);
        break;
    case GL_TEXTURE_1D_ARRAY:
        form.height = 1;
        if (texture.immutable)
            CALL(machine, glTexStorage2D, target, 1, texture.format, w, d);
        else
            CALL(machine, glTexImage2D, target, 0, texture.format, w, d, 0, format, type, nullptr);
        break;
    case GL_TEXTURE_2D:
    case GL_TEXTURE_RECTANGLE:
        form.layers = 1;
        if (texture.immutable)
            CALL(machine, glTexStorage2D, target, 1, texture.format, w, h);
        else
            CALL(machine, glTexImage2D, target, 0, texture.format, w, h, 0, format, type, nullptr);
        break;
    case GL_TEXTURE_CUBE_MAP:
        form.layers = 6;
        form.height = w;
        if (texture.immutable)
            CALL(machine, glTexStorage2D, target, 1, texture.format, w, w);
        for (GLenum face = 0; face < 6 && !texture.immutable; ++face)
            CALL(machine, glTexImage2D, GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, texture.format, w,
                 w, 0, format, type, nullptr);
        break;
    case GL_TEXTURE_2D_MULTISAMPLE:
        form.layers = 1;
        CALL(machine, glTexImage2DMultisample, target, form.samples, texture.format, w, h, GL_TRUE);
        break;
    case GL_TEXTURE_2D_MULTISAMPLE_ARRAY:
        CALL(machine, glTexImage3DMultisample, target, form.samples, texture.format, w, h, d,
             GL_TRUE);
        break;
    default:
        if (target.value == GL_TEXTURE_CUBE_MAP_ARRAY) {
            form.height = form.width;
            form.layers = 6 * std::max(form.layers / 6, 1);
        }
        if (texture.immutable)
            CALL(machine, glTexStorage3D, target, 1, texture.format, form.width, form.height,
                 form.layers);
        else
            CALL(machine, glTexImage3D, target, 0, texture.format, form.width, form.height,
                 form.layers, 0, format, type, nullptr);
    }
}

void forget_name(Machine &machine, GLuint name)
{
    if (machine.forms.contains(name))
        machine.forms[name].certain = false;
}

/// Gives a slot a texture of this form. The same one is resized where GL allows it.
GLuint make_texture(Machine &machine, int slot, Named target, Named format, TextureForm form,
                    bool immutable)
{
    Texture &texture = machine.textures[std::size_t(slot)];
    if (texture.name != 0 && (texture.immutable || texture.target.value != target.value)) {
        forget_name(machine, texture.name);
        machine.trace.comment("texture {} of slot {}", texture.name, slot);
        glDeleteTextures(1, &texture.name);
        texture = {};
    }
    if (texture.name == 0)
        glGenTextures(1, &texture.name);
    texture.target = target;
    texture.format = format;
    texture.immutable = immutable && form.samples == 0;
    form.target = target.value;
    form.format = format.value;
    CALL(machine, glBindTexture, target, texture.name);
    allocate(machine, texture, form);
    // Once a name has been two textures it stays uncertain.
    form.certain = !machine.forms.contains(texture.name) || machine.forms[texture.name].certain;
    if (machine.check_error("allocating a texture",
                            invalid_enum | invalid_value | invalid_operation | out_of_memory) !=
        GL_NO_ERROR)
        form.certain = false; // What it is now depends on the target.
    machine.forms[texture.name] = form;
    if (form.samples == 0)
        CALL(machine, glTexParameteri, target, GL_NAMED(GL_TEXTURE_MIN_FILTER),
             GL_NAMED(GL_NEAREST));
    CALL(machine, glBindTexture, target, 0);
    return texture.name;
}

void texture(Machine &machine, Args &args)
{
    const int slot = args.below(Machine::texture_slots);
    const Named target = args.pick(targets);
    const Format format = args.pick(formats);
    TextureForm form;
    form.width = args.pick(sizes);
    form.layers = args.pick(layer_counts);
    const unsigned rest = args.byte();
    form.height = rest & 1 ? form.width : sizes[(rest >> 3) % sizes.size()];
    const bool multisample = target.value == GL_TEXTURE_2D_MULTISAMPLE ||
                             target.value == GL_TEXTURE_2D_MULTISAMPLE_ARRAY;
    form.samples = multisample ? (rest & 2 ? 4 : 1) : 0;
    make_texture(machine, slot, target, format.internal, form, rest & 4);
}

void delete_texture(Machine &machine, Args &args)
{
    Texture &texture = machine.textures[std::size_t(args.below(Machine::texture_slots))];
    forget_name(machine, texture.name);
    CALL(machine, glDeleteTextures, 1, &texture.name);
    texture = {};
}

void renderbuffer(Machine &machine, Args &args)
{
    const GLuint name = args.pick(machine.renderbuffers);
    const Format format = args.pick(formats);
    const int samples = args.flag() ? 4 : 0;
    const int size = args.pick(sizes);
    CALL(machine, glBindRenderbuffer, GL_NAMED(GL_RENDERBUFFER), name);
    CALL(machine, glRenderbufferStorageMultisample, GL_NAMED(GL_RENDERBUFFER), samples,
         format.internal, size, size);
}

void bind(Machine &machine, Named target, Framebuffer &framebuffer)
{
    CALL(machine, glBindFramebuffer, target, framebuffer.name);
    framebuffer.contexts |= 1U << machine.context();
}

void bind_framebuffer(Machine &machine, Args &args)
{
    static constexpr std::array<Named, 3> bindings = {
        GL_NAMED(GL_FRAMEBUFFER), GL_NAMED(GL_DRAW_FRAMEBUFFER), GL_NAMED(GL_READ_FRAMEBUFFER)};
    const Named target = args.pick(bindings);
    const int slot = args.below(Machine::framebuffer_slots + 1);
    if (slot == Machine::framebuffer_slots)
        CALL(machine, glBindFramebuffer, target, 0);
    else
        bind(machine, target, machine.framebuffers[std::size_t(slot)]);
}

void delete_framebuffer(Machine &machine, Args &args)
{
    Framebuffer &framebuffer =
        machine.framebuffers[std::size_t(args.below(Machine::framebuffer_slots))];
    if (framebuffer.contexts & ~(1U << machine.context()))
        machine.orphaned_framebuffers.insert(framebuffer.name);
    CALL(machine, glDeleteFramebuffers, 1, &framebuffer.name);
    framebuffer = {};
    glGenFramebuffers(1, &framebuffer.name);
}

void attach(Machine &machine, Args &args)
{
    const Named point = args.pick(points);
    const Named target = GL_NAMED(GL_DRAW_FRAMEBUFFER);
    const Texture &texture = machine.textures[std::size_t(args.below(Machine::texture_slots))];
    const int level = args.below(8) == 7;
    switch (args.below(6)) {
    case 0:
        CALL(machine, glFramebufferTexture, target, point, 0, 0);
        break;
    case 1:
        CALL(machine, glFramebufferRenderbuffer, target, point, GL_NAMED(GL_RENDERBUFFER),
             args.pick(machine.renderbuffers));
        break;
    case 2:
        CALL(machine, glFramebufferTextureLayer, target, point, texture.name, level, args.below(5));
        break;
    case 3:
        CALL(machine, glFramebufferTexture2D, target, point, texture.target, texture.name, level);
        break;
    default:
        CALL(machine, glFramebufferTexture, target, point, texture.name, level);
    }
}

void draw_buffers(Machine &machine, Args &args)
{
    std::array<GLenum, 8> buffers{};
    const int count = 1 + args.below(8);
    const unsigned holes = args.byte();
    const int turn = args.below(8);
    for (int i = 0; i < 8; ++i)
        buffers[std::size_t(i)] =
            holes >> i & 1 ? GL_NONE : GLenum(GL_COLOR_ATTACHMENT0 + (i + turn) % 8);
    CALL(machine, glDrawBuffers, count, buffers.data());
}

void draw_buffer(Machine &machine, Args &args)
{
    static constexpr std::array<Named, 7> buffers = {GL_NAMED(GL_COLOR_ATTACHMENT0),
                                                     GL_NAMED(GL_COLOR_ATTACHMENT1),
                                                     GL_NAMED(GL_NONE),
                                                     GL_NAMED(GL_FRONT),
                                                     GL_NAMED(GL_BACK),
                                                     GL_NAMED(GL_FRONT_AND_BACK),
                                                     GL_NAMED(GL_LEFT)};
    CALL(machine, glDrawBuffer, args.pick(buffers));
}

/// One command for what most sequences begin with: the layers, attached, drawn to, and cleared.
void peel_framebuffer(Machine &machine, Args &args)
{
    static constexpr std::array<Named, 5> depths = {
        GL_NAMED(GL_DEPTH_COMPONENT32F), GL_NAMED(GL_DEPTH_COMPONENT24),
        GL_NAMED(GL_DEPTH_COMPONENT16), GL_NAMED(GL_DEPTH24_STENCIL8),
        GL_NAMED(GL_DEPTH32F_STENCIL8)};
    const int slot = args.below(Machine::framebuffer_slots);
    TextureForm form;
    form.layers = args.pick(layer_counts);
    form.width = args.pick(sizes);
    form.height = args.pick(sizes);
    const Named depth = args.pick(depths);
    const unsigned rest = args.byte();
    const int colors = int(rest & 3) % 3;
    const bool multisample = (rest >> 2 & 7) == 7;
    const Named color = formats[args.byte() % formats.size()].internal;
    const Named target =
        multisample ? GL_NAMED(GL_TEXTURE_2D_MULTISAMPLE_ARRAY) : GL_NAMED(GL_TEXTURE_2D_ARRAY);
    form.samples = multisample ? 4 : 0;
    const bool immutable = rest & 32;

    bind(machine, GL_NAMED(GL_FRAMEBUFFER), machine.framebuffers[std::size_t(slot)]);
    for (int i = 0; i <= colors; ++i) {
        const int texture_slot = 3 * slot + i;
        const Named point = i == 0   ? GL_NAMED(GL_DEPTH_ATTACHMENT)
                            : i == 1 ? GL_NAMED(GL_COLOR_ATTACHMENT0)
                                     : GL_NAMED(GL_COLOR_ATTACHMENT1);
        const Named format = i == 0 ? depth : i == 1 ? color : GL_NAMED(GL_RGBA8);
        const GLuint name = make_texture(machine, texture_slot, target, format, form, immutable);
        CALL(machine, glFramebufferTexture, GL_NAMED(GL_FRAMEBUFFER), point, name, 0);
    }
    const std::array<GLenum, 2> buffers = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    CALL(machine, glDrawBuffers, colors, buffers.data());
    CALL(machine, glViewport, 0, 0, form.width, form.height);
    CALL(machine, glClear, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    CALL(machine, glEnable, GL_NAMED(GL_DEPTH_PEELING_MESA));
}

void kbuffer_framebuffer(Machine &machine, Args &args)
{
    const int slot = args.below(Machine::framebuffer_slots);
    const int attachments = 1 + args.below(3);
    TextureForm form;
    form.layers = layer_counts[args.byte() % 6];
    form.width = args.pick(sizes);
    form.height = args.pick(sizes);
    const Named format = formats[args.byte() % formats.size()].internal;
    const unsigned rest = args.byte();
    const bool multisample = (rest & 7) == 7, layered = rest & 8;
    form.samples = multisample ? 4 : 0;
    const Named target = layered       ? multisample ? GL_NAMED(GL_TEXTURE_2D_MULTISAMPLE_ARRAY)
                                                     : GL_NAMED(GL_TEXTURE_2D_ARRAY)
                               : multisample ? GL_NAMED(GL_TEXTURE_2D_MULTISAMPLE)
                                       : GL_NAMED(GL_TEXTURE_2D);

    bind(machine, GL_NAMED(GL_FRAMEBUFFER), machine.framebuffers[std::size_t(slot)]);
    CALL(machine, glFramebufferTexture, GL_NAMED(GL_FRAMEBUFFER), GL_NAMED(GL_DEPTH_ATTACHMENT), 0,
         0);
    std::array<GLenum, 3> buffers{};
    for (int i = 0; i < attachments; ++i) {
        const Named point = points[i == 0 ? 0 : std::size_t(i) + 1];
        const GLuint name =
            make_texture(machine, 3 * slot + i, target,
                         rest & 16 && i > 0 ? GL_NAMED(GL_RGBA32F) : format, form, rest & 32);
        buffers[std::size_t(i)] = point.value;
        CALL(machine, glFramebufferTexture, GL_NAMED(GL_FRAMEBUFFER), point, name, 0);
    }
    CALL(machine, glDrawBuffers, attachments, buffers.data());
    CALL(machine, glViewport, 0, 0, form.width, form.height);
    CALL(machine, glClear, GL_COLOR_BUFFER_BIT);
    CALL(machine, glEnable, GL_NAMED(GL_KBUFFER_PROGRAM_MESA));
}

void first_layer(Machine &machine, Args &args)
{
    static constexpr Named target = GL_NAMED(GL_DRAW_FRAMEBUFFER);
    static constexpr Named name = GL_NAMED(GL_DEPTH_PEELING_FIRST_LAYER_MESA);
    static constexpr std::array<int, 6> others = {1, -1, 4, 256, 0x7fffffff, -0x7fffffff - 1};
    Framebuffer *framebuffer = machine.bound_framebuffer();
    GLint value = 0;
    const int kind = args.below(8);
    if (kind == 7)
        value = args.pick(others);
    else if (kind > 0 && framebuffer)
        value =
            framebuffer->peel.first_layer + attachment_of(machine, GL_DEPTH_ATTACHMENT).form.layers;
    const bool known = machine.knows_framebuffer();
    Expected expected;
    if (known)
        expected = framebuffer ? expected_of_first_layer(machine, *framebuffer, value)
                               : Expected(invalid_operation);
    CALL(machine, glFramebufferParameteri, target, name, value);
    const GLenum error = machine.check_error("setting FIRST_LAYER",
                                             expected.value_or(invalid_value | invalid_operation));
    if (expected.value_or(no_error) != no_error && error == GL_NO_ERROR)
        finding("FIRST_LAYER is set to {} without the error that the specification demands", value);
    if (!framebuffer || !known)
        return;
    if (error == GL_NO_ERROR)
        note_first_layer(machine, *framebuffer, value);
    GLint got = -1, overflow = -1;
    CALL(machine, glGetFramebufferParameteriv, target, name, &got);
    if (got != framebuffer->peel.first_layer)
        finding("FIRST_LAYER is {}, not {}", got, framebuffer->peel.first_layer);
    CALL(machine, glGetFramebufferParameteriv, target, GL_NAMED(GL_DEPTH_PEELING_OVERFLOW_MESA),
         &overflow);
    if (error == GL_NO_ERROR && overflow != 0)
        finding("OVERFLOW is {} after FIRST_LAYER was set", overflow);
}

void overflow(Machine &machine, Args &args)
{
    static constexpr Named target = GL_NAMED(GL_DRAW_FRAMEBUFFER);
    static constexpr Named name = GL_NAMED(GL_DEPTH_PEELING_OVERFLOW_MESA);
    GLint value = 0;
    if (args.below(8) == 7)
        CALL(machine, glFramebufferParameteri, target, name, 1);
    else
        CALL(machine, glGetFramebufferParameteriv, target, name, &value);
}

/// Another width for a framebuffer without attachments, and for those with them without effect.
void default_size(Machine &machine, Args &args)
{
    static constexpr std::array<Named, 4> names = {
        GL_NAMED(GL_FRAMEBUFFER_DEFAULT_WIDTH), GL_NAMED(GL_FRAMEBUFFER_DEFAULT_HEIGHT),
        GL_NAMED(GL_FRAMEBUFFER_DEFAULT_LAYERS), GL_NAMED(GL_FRAMEBUFFER_DEFAULT_SAMPLES)};
    const Named name = args.pick(names);
    // Stock Mesa waits for itself forever if vertices of Begin and End are pending here and the
    // framebuffer's status is asked for next.
    CALL(machine, glFlush);
    CALL(machine, glFramebufferParameteri, GL_NAMED(GL_DRAW_FRAMEBUFFER), name,
         name.value == GL_FRAMEBUFFER_DEFAULT_SAMPLES ? 4 * args.below(2) : args.below(17));
}

constexpr unsigned object_errors =
    invalid_enum | invalid_value | invalid_operation | invalid_framebuffer;

constexpr std::array<Command, 13> commands{{
    {"texture", texture, object_errors, false, 2},
    {"delete_texture", delete_texture, no_error},
    {"renderbuffer", renderbuffer, object_errors},
    {"bind_framebuffer", bind_framebuffer, no_error, false, 2},
    {"delete_framebuffer", delete_framebuffer, no_error},
    {"attach", attach, object_errors, false, 2},
    {"draw_buffers", draw_buffers, object_errors, false, 2},
    {"draw_buffer", draw_buffer, object_errors},
    {"peel_framebuffer", peel_framebuffer, object_errors, false, 4},
    {"kbuffer_framebuffer", kbuffer_framebuffer, object_errors, false, 3},
    {"first_layer", first_layer, no_error, false, 5},
    {"overflow", overflow, invalid_enum | invalid_operation, false, 2},
    {"default_size", default_size, object_errors},
}};

} // namespace

std::span<const Command> object_commands()
{
    return commands;
}

} // namespace kb::fuzz
