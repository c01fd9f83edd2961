// SPDX-License-Identifier: MIT
//
// Commands that move pixels: those that make fragments, clears, copies, and reads.

#include "fuzz/draws/formats.hpp"
#include "fuzz/draws/machine.hpp"

namespace kb::fuzz
{

namespace
{

struct PixelType {
    Named format, type;
};

constexpr std::array<PixelType, 7> pixel_types{{
    {GL_NAMED(GL_RGBA), GL_NAMED(GL_FLOAT)},
    {GL_NAMED(GL_DEPTH_COMPONENT), GL_NAMED(GL_FLOAT)},
    {GL_NAMED(GL_RGBA), GL_NAMED(GL_UNSIGNED_BYTE)},
    {GL_NAMED(GL_STENCIL_INDEX), GL_NAMED(GL_UNSIGNED_BYTE)},
    {GL_NAMED(GL_DEPTH_STENCIL), GL_NAMED(GL_FLOAT_32_UNSIGNED_INT_24_8_REV)},
    {GL_NAMED(GL_DEPTH_STENCIL), GL_NAMED(GL_UNSIGNED_INT_24_8)},
    {GL_NAMED(GL_RGBA_INTEGER), GL_NAMED(GL_INT)},
}};

constexpr int most_pixels = 140 * 140;
constexpr std::size_t most_bytes = 16 * std::size_t(most_pixels);

constexpr std::array<Named, 4> copies = {GL_NAMED(GL_COLOR), GL_NAMED(GL_DEPTH),
                                         GL_NAMED(GL_STENCIL), GL_NAMED(GL_DEPTH_STENCIL)};

void raster_pos(Machine &machine, Args &args)
{
    CALL(machine, glRasterPos3f, 2.0F * args.unit() - 1.0F, 2.0F * args.unit() - 1.0F,
         2.0F * args.unit() - 1.0F);
    static constexpr std::array<float, 4> zooms = {1.0F, 2.0F, -1.0F, 0.3F};
    CALL(machine, glPixelZoom, args.pick(zooms), args.pick(zooms));
}

void draw_pixels(Machine &machine, Args &args)
{
    const PixelType pixels = args.pick(pixel_types);
    const int width = args.below(20), height = args.below(20);
    std::vector<float> data(16 * 20 * 20, args.unit());
    CALL(machine, glDrawPixels, width, height, pixels.format, pixels.type, data.data());
}

void bitmap(Machine &machine, Args &args)
{
    const std::vector<GLubyte> bits(4 * 32, GLubyte(args.byte()));
    CALL(machine, glBitmap, args.below(32), args.below(32), 0.0F, 0.0F, float(args.below(5)),
         float(args.below(5)), bits.data());
}

void copy_pixels(Machine &machine, Args &args)
{
    CALL(machine, glCopyPixels, args.below(8), args.below(8), args.below(40), args.below(40),
         args.pick(copies));
}

void clear(Machine &machine, Args &args)
{
    const unsigned mask = args.byte();
    CALL(machine, glClear,
         (mask & 1 ? 0 : GLuint(GL_COLOR_BUFFER_BIT)) |
             (mask & 2 ? 0 : GLuint(GL_DEPTH_BUFFER_BIT)) |
             (mask & 4 ? GLuint(GL_STENCIL_BUFFER_BIT) : 0));
}

void clear_buffer(Machine &machine, Args &args)
{
    const std::array<GLfloat, 4> real = {args.unit(), args.unit(), args.unit(), args.unit()};
    const std::array<GLint, 4> integer = {int(args.byte()), -1, 7, 0x7fffffff};
    const int buffer = args.below(4);
    switch (args.below(5)) {
    case 0:
        CALL(machine, glClearBufferfv, GL_NAMED(GL_COLOR), buffer, real.data());
        break;
    case 1:
        CALL(machine, glClearBufferfv, GL_NAMED(GL_DEPTH), 0, real.data());
        break;
    case 2:
        CALL(machine, glClearBufferiv, GL_NAMED(GL_COLOR), buffer, integer.data());
        break;
    case 3:
        CALL(machine, glClearBufferiv, GL_NAMED(GL_STENCIL), 0, integer.data());
        break;
    default:
        CALL(machine, glClearBufferfi, GL_NAMED(GL_DEPTH_STENCIL), 0, real[0], integer[0]);
    }
}

void read_pixels(Machine &machine, Args &args)
{
    const PixelType pixels = args.pick(pixel_types);
    std::vector<std::uint8_t> data(most_bytes);
    CALL(machine, glReadPixels, args.below(20) - 4, args.below(20) - 4, int(args.byte()) % 140,
         int(args.byte()) % 140, pixels.format, pixels.type, data.data());
}

void read_buffer(Machine &machine, Args &args)
{
    const int buffer = args.below(9);
    CALL(machine, glReadBuffer,
         buffer == 8 ? GLenum(GL_NONE) : GLenum(GL_COLOR_ATTACHMENT0 + buffer));
}

void blit(Machine &machine, Args &args)
{
    static constexpr std::array<unsigned, 5> masks = {
        GL_COLOR_BUFFER_BIT, GL_DEPTH_BUFFER_BIT, GL_STENCIL_BUFFER_BIT,
        GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT,
        GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT};
    const unsigned mask = args.pick(masks);
    const int x = args.below(20), y = args.below(20), w = args.below(40), h = args.below(40);
    const bool scaled = args.flag();
    CALL(machine, glBlitFramebuffer, x, y, x + w, y + h, 0, 0, scaled ? 2 * h : w, h, mask,
         GL_NAMED(GL_NEAREST));
}

/// All layers of a texture, as a texel by texel copy of what they hold.
void read_texture(Machine &machine, Args &args)
{
    const Texture &texture = machine.textures[std::size_t(args.below(Machine::texture_slots))];
    const auto form = machine.forms.find(texture.name);
    if (form == machine.forms.end() || !form->second.certain || form->second.samples != 0 ||
        texture.target.value == GL_TEXTURE_CUBE_MAP)
        return;
    const Transfer transfer = transfer_of(format_kind(form->second.format));
    std::vector<std::uint8_t> texels(
        std::size_t(form->second.width) * std::size_t(form->second.height) *
        std::size_t(form->second.layers) * std::size_t(transfer.bytes));
    CALL(machine, glBindTexture, texture.target, texture.name);
    CALL(machine, glGetTexImage, texture.target, 0, transfer.format, transfer.type, texels.data());
    CALL(machine, glBindTexture, texture.target, 0);
}

/// Some texels of a texture, which may be attached, from memory or from the read framebuffer.
void update_texture(Machine &machine, Args &args)
{
    const Texture &texture = machine.textures[std::size_t(args.below(Machine::texture_slots))];
    if (texture.target.value != GL_TEXTURE_2D_ARRAY)
        return;
    const Transfer transfer = transfer_of(format_kind(texture.format.value));
    const std::vector<float> texels(4 * 8 * 8, args.unit());
    const int layer = args.below(9), x = args.below(9), w = 1 + args.below(8);
    CALL(machine, glBindTexture, texture.target, texture.name);
    switch (args.below(3)) {
    case 0:
        CALL(machine, glCopyTexSubImage3D, texture.target, 0, x, 0, layer, 0, 0, w, 4);
        break;
    case 1:
        CALL(machine, glClearTexImage, texture.name, 0, transfer.format, transfer.type,
             texels.data());
        break;
    default:
        CALL(machine, glTexSubImage3D, texture.target, 0, x, 0, layer, w, 4, 1, transfer.format,
             transfer.type, texels.data());
    }
    CALL(machine, glBindTexture, texture.target, 0);
}

void invalidate(Machine &machine, Args &args)
{
    const std::array<GLenum, 2> points = {GL_DEPTH_ATTACHMENT, GL_COLOR_ATTACHMENT0};
    CALL(machine, glInvalidateFramebuffer, GL_NAMED(GL_DRAW_FRAMEBUFFER), 1 + args.below(2),
         points.data());
}

constexpr unsigned pixel_errors =
    invalid_enum | invalid_value | invalid_operation | invalid_framebuffer;

constexpr std::array<Command, 12> commands{{
    {"raster_pos", raster_pos, pixel_errors, true},
    {"draw_pixels", draw_pixels, pixel_errors, true},
    {"bitmap", bitmap, pixel_errors, true},
    {"copy_pixels", copy_pixels, pixel_errors, true},
    {"clear", clear, invalid_framebuffer, true, 4},
    {"clear_buffer", clear_buffer, pixel_errors, true},
    {"read_pixels", read_pixels, pixel_errors},
    {"read_buffer", read_buffer, pixel_errors},
    {"blit", blit, pixel_errors},
    {"read_texture", read_texture, no_error},
    {"update_texture", update_texture, pixel_errors},
    {"invalidate", invalidate, pixel_errors},
}};

} // namespace

std::span<const Command> pixel_commands()
{
    return commands;
}

} // namespace kb::fuzz
