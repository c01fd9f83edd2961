// SPDX-License-Identifier: MIT
//
// What the specifications of the extensions promise of a command in the present state. The state
// is asked from GL; what cannot be asked is in the machine's records. Where these are not certain
// nothing is expected.

#pragma once

#include "fuzz/draws/machine.hpp"

#include <string>

namespace kb::fuzz
{

/// Of the draw framebuffer.
struct Attachment {
    GLenum point = 0;
    GLuint texture = 0; ///< 0 for a renderbuffer, too.
    bool renderbuffer = false;
    bool layered = false;
    int level = 0;
    TextureForm form; ///< Of the level that is attached.

    bool exists() const { return texture != 0 || renderbuffer; }
    bool certain() const { return texture == 0 || form.certain; }
};

Attachment attachment_of(const Machine &machine, GLenum point);

/// The errors, as bits of Errors, of which a command has to give one; no_error alone if it has to
/// succeed; nothing if neither is known.
using Expected = std::optional<unsigned>;

Expected expected_of_draw(Machine &machine);
Expected expected_of_first_layer(Machine &machine, const Framebuffer &framebuffer, GLint value);

/// After glFramebufferParameteri has set it.
void note_first_layer(Machine &machine, Framebuffer &framebuffer, GLint value);

/// Checks a draw: made before it, asked after it.
class DrawPromise
{
public:
    explicit DrawPromise(Machine &machine);

    /// The draw has given this error. A draw for which stock GL has reasons of its own to refuse it
    /// may do so.
    void check(Machine &machine, GLenum error, bool may_be_refused) const;

private:
    struct Contents {
        Attachment attachment;
        std::vector<std::uint8_t> texels;
    };

    std::vector<Contents> read(Machine &machine) const;
    void check_unchanged(const std::vector<Contents> &after) const;
    void check_peeled(const std::vector<Contents> &after, GLint overflow) const;

    Expected expected_;
    bool peels_ = false;
    GLint depth_func_ = 0;
    GLint overflow_ = 0;
    std::vector<Contents> before_;
};

} // namespace kb::fuzz
