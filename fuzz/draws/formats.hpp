// SPDX-License-Identifier: MIT
//
// The formats of textures and renderbuffers that a sequence can use.

#pragma once

#include "fuzz/draws/trace.hpp"

#include <array>

namespace kb::fuzz
{

enum class FormatKind { color, integer, depth, depth_stencil, stencil };

struct Format {
    Named internal;
    FormatKind kind;
};

inline constexpr std::array<Format, 24> formats{{
    {GL_NAMED(GL_DEPTH_COMPONENT32F), FormatKind::depth},
    {GL_NAMED(GL_RGBA32F), FormatKind::color},
    {GL_NAMED(GL_RGBA8), FormatKind::color},
    {GL_NAMED(GL_DEPTH_COMPONENT24), FormatKind::depth},
    {GL_NAMED(GL_DEPTH_COMPONENT16), FormatKind::depth},
    {GL_NAMED(GL_DEPTH24_STENCIL8), FormatKind::depth_stencil},
    {GL_NAMED(GL_DEPTH32F_STENCIL8), FormatKind::depth_stencil},
    {GL_NAMED(GL_STENCIL_INDEX8), FormatKind::stencil},
    {GL_NAMED(GL_R32UI), FormatKind::integer},
    {GL_NAMED(GL_RGBA8I), FormatKind::integer},
    {GL_NAMED(GL_RG16UI), FormatKind::integer},
    {GL_NAMED(GL_RGBA32I), FormatKind::integer},
    {GL_NAMED(GL_SRGB8_ALPHA8), FormatKind::color},
    {GL_NAMED(GL_RGBA16F), FormatKind::color},
    {GL_NAMED(GL_R11F_G11F_B10F), FormatKind::color},
    {GL_NAMED(GL_RGB10_A2), FormatKind::color},
    {GL_NAMED(GL_RGB565), FormatKind::color},
    {GL_NAMED(GL_RGBA4), FormatKind::color},
    {GL_NAMED(GL_R8), FormatKind::color},
    {GL_NAMED(GL_RG16), FormatKind::color},
    {GL_NAMED(GL_RGBA8_SNORM), FormatKind::color},
    {GL_NAMED(GL_R32F), FormatKind::color},
    {GL_NAMED(GL_RGB8), FormatKind::color},
    {GL_NAMED(GL_ALPHA8), FormatKind::color},
}};

inline FormatKind format_kind(GLenum internal)
{
    for (const Format &format : formats)
        if (format.internal.value == internal)
            return format.kind;
    return FormatKind::color;
}

/// How texels of a format are transferred.
struct Transfer {
    Named format, type;
    int bytes;
};

inline Transfer transfer_of(FormatKind kind)
{
    switch (kind) {
    case FormatKind::integer:
        return {GL_NAMED(GL_RGBA_INTEGER), GL_NAMED(GL_INT), 16};
    case FormatKind::depth:
        return {GL_NAMED(GL_DEPTH_COMPONENT), GL_NAMED(GL_FLOAT), 4};
    case FormatKind::depth_stencil:
        return {GL_NAMED(GL_DEPTH_STENCIL), GL_NAMED(GL_FLOAT_32_UNSIGNED_INT_24_8_REV), 8};
    case FormatKind::stencil:
        return {GL_NAMED(GL_STENCIL_INDEX), GL_NAMED(GL_UNSIGNED_BYTE), 1};
    default:
        return {GL_NAMED(GL_RGBA), GL_NAMED(GL_FLOAT), 16};
    }
}

} // namespace kb::fuzz
