// SPDX-License-Identifier: MIT

#include "fuzz/draws/promises.hpp"

#include "fuzz/draws/formats.hpp"
#include "fuzz/draws/programs.hpp"
#include "fuzz/finding.hpp"

#include <algorithm>
#include <cstring>

namespace kb::fuzz
{

namespace
{

constexpr int most_peel_layers = 256;

GLint parameter(GLenum point, GLenum pname)
{
    GLint value = 0;
    glGetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER, point, pname, &value);
    return value;
}

bool is_array(const Attachment &attachment)
{
    return attachment.layered && (attachment.form.target == GL_TEXTURE_2D_ARRAY ||
                                  attachment.form.target == GL_TEXTURE_2D_MULTISAMPLE_ARRAY);
}

/// The attachments of the draw buffers of a framebuffer object; of GL_NONE none.
std::vector<std::optional<Attachment>> draw_buffers(const Machine &machine)
{
    std::vector<std::optional<Attachment>> attachments;
    for (int i = 0; i < 8; ++i) {
        const GLenum buffer = GLenum(get_integer(GL_DRAW_BUFFER0 + GLenum(i)));
        if (buffer == GL_NONE)
            attachments.emplace_back();
        else
            attachments.emplace_back(attachment_of(machine, buffer));
    }
    return attachments;
}

bool has_order(GLenum depth_func)
{
    return depth_func == GL_LESS || depth_func == GL_LEQUAL || depth_func == GL_GREATER ||
           depth_func == GL_GEQUAL;
}

bool can_continue(GLenum depth_func)
{
    return depth_func == GL_LESS || depth_func == GL_GREATER;
}

/// What peeling would remember if it went on now.
PeelState peel_state(const Attachment &depth, GLenum depth_func)
{
    const TextureForm &form = depth.form;
    return {0, depth_func, form.format, form.width, form.height, form.layers, form.samples};
}

bool same_order(PeelState a, PeelState b)
{
    // The numbers of samples are what was asked for: 1 is another form than none.
    return a.depth_func == b.depth_func && a.format == b.format && a.width == b.width &&
           a.height == b.height && a.layers == b.layers && a.samples == b.samples;
}

/// Peeling belongs to the context that began it: in others nothing is expected.
bool used_in_one_context(const Framebuffer &framebuffer)
{
    return (framebuffer.contexts & (framebuffer.contexts - 1)) == 0;
}

/// nullopt: not known; else whether peeling into the bound framebuffer, which is complete, is an
/// error.
std::optional<bool> peeling_is_error(Machine &machine)
{
    const Framebuffer *framebuffer = machine.bound_framebuffer();
    const GLenum depth_func = GLenum(get_integer(GL_DEPTH_FUNC));
    if (!framebuffer || glIsEnabled(GL_STENCIL_TEST) || glIsEnabled(GL_KBUFFER_PROGRAM_MESA) ||
        !has_order(depth_func))
        return true;
    const Attachment depth = attachment_of(machine, GL_DEPTH_ATTACHMENT);
    if (!depth.certain())
        return std::nullopt;
    if (!is_array(depth) || depth.form.layers > most_peel_layers)
        return true;
    for (const auto &color : draw_buffers(machine)) {
        if (!color || !color->exists())
            continue;
        if (!color->certain())
            return std::nullopt;
        if (!is_array(*color) || color->form.layers != depth.form.layers)
            return true;
    }
    if (framebuffer->peel.first_layer != 0 &&
        (!can_continue(depth_func) ||
         !same_order(framebuffer->peel, peel_state(depth, depth_func))))
        return true;
    if (!used_in_one_context(*framebuffer))
        return std::nullopt;
    return false;
}

const KbufferText *current_program(const Machine &machine, bool &known)
{
    GLint name = 0;
    glGetProgramivARB(GL_KBUFFER_PROGRAM_MESA, GL_PROGRAM_BINDING_ARB, &name);
    known = true;
    for (const KbufferProgram &program : machine.kbuffer_programs)
        if (name != 0 && program.name == GLuint(name))
            return program.text < 0 ? nullptr : &kbuffer_texts()[std::size_t(program.text)];
    known = name == 0; // The default program is never loaded here; others have been deleted.
    return nullptr;
}

std::optional<bool> kbuffer_is_error(Machine &machine)
{
    bool known = false;
    const KbufferText *program = current_program(machine, known);
    if (!known)
        return std::nullopt;
    if (!program || glIsEnabled(GL_DEPTH_PEELING_MESA))
        return true;
    if (!machine.bound_framebuffer())
        return std::nullopt; // The window: its draw buffers have many names.

    const auto buffers = draw_buffers(machine);
    int count = 0, layers = 0;
    for (int i = 0; i < int(buffers.size()); ++i) {
        const auto &buffer = buffers[std::size_t(i)];
        if (!buffer)
            continue;
        count = i + 1;
        if (!buffer->exists())
            continue;
        // Renderbuffers' formats are not recorded.
        if (buffer->renderbuffer || !buffer->certain())
            return std::nullopt;
        if (format_kind(buffer->form.format) == FormatKind::integer)
            return true;
        const int own = buffer->layered ? buffer->form.layers : 1;
        layers = layers ? std::min(layers, own) : own;
    }
    if (layers == 0)
        return true; // No color draw buffer.
    const int entries = std::min(count * layers, 64);
    return std::any_of(program->entries.begin(), program->entries.end(), [&](int entry) {
        if (entry >= entries)
            return true;
        const auto &buffer = buffers[std::size_t(entry % count)];
        return !buffer || !buffer->exists();
    });
}

} // namespace

Attachment attachment_of(const Machine &machine, GLenum point)
{
    Attachment attachment;
    attachment.point = point;
    if (get_integer(GL_DRAW_FRAMEBUFFER_BINDING) == 0)
        return attachment;
    const GLint type = parameter(point, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE);
    attachment.renderbuffer = type == GL_RENDERBUFFER;
    if (type != GL_TEXTURE)
        return attachment;
    attachment.texture = GLuint(parameter(point, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME));
    attachment.layered = parameter(point, GL_FRAMEBUFFER_ATTACHMENT_LAYERED) != 0;
    attachment.level = parameter(point, GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_LEVEL);
    const auto form = machine.forms.find(attachment.texture);
    if (form != machine.forms.end() && attachment.level == 0)
        attachment.form = form->second;
    else
        attachment.form.certain = false;
    return attachment;
}

Expected expected_of_draw(Machine &machine)
{
    const bool peels = glIsEnabled(GL_DEPTH_PEELING_MESA);
    const bool runs_program = glIsEnabled(GL_KBUFFER_PROGRAM_MESA);
    if (glCheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return invalid_framebuffer | invalid_operation;
    if (!machine.knows_framebuffer())
        return std::nullopt;
    bool known = true;
    for (const auto &error : {peels ? peeling_is_error(machine) : false,
                              runs_program ? kbuffer_is_error(machine) : false}) {
        if (error.value_or(false))
            return invalid_operation;
        known = known && error.has_value();
    }
    return known ? Expected(no_error) : std::nullopt;
}

Expected expected_of_first_layer(Machine &machine, const Framebuffer &framebuffer, GLint value)
{
    if (value < 0)
        return invalid_value;
    if (value == 0)
        return no_error;
    if (glCheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return invalid_operation;
    const Attachment depth = attachment_of(machine, GL_DEPTH_ATTACHMENT);
    if (!depth.certain())
        return std::nullopt;
    if (!is_array(depth) || depth.form.layers > most_peel_layers)
        return invalid_operation;
    if (framebuffer.peel.first_layer != 0 &&
        !same_order(framebuffer.peel, peel_state(depth, GLenum(get_integer(GL_DEPTH_FUNC)))))
        return invalid_operation;
    if (value != framebuffer.peel.first_layer + depth.form.layers)
        return invalid_value;
    if (!used_in_one_context(framebuffer))
        return std::nullopt;
    return no_error;
}

void note_first_layer(Machine &machine, Framebuffer &framebuffer, GLint value)
{
    framebuffer.peel =
        peel_state(attachment_of(machine, GL_DEPTH_ATTACHMENT), GLenum(get_integer(GL_DEPTH_FUNC)));
    framebuffer.peel.first_layer = value;
}

DrawPromise::DrawPromise(Machine &machine) : expected_(expected_of_draw(machine))
{
    peels_ = glIsEnabled(GL_DEPTH_PEELING_MESA);
    if (!machine.bound_framebuffer())
        return;
    glGetIntegerv(GL_DEPTH_FUNC, &depth_func_);
    glGetFramebufferParameteriv(GL_DRAW_FRAMEBUFFER, GL_DEPTH_PEELING_OVERFLOW_MESA, &overflow_);
    before_ = read(machine);
}

/// The texels of all attachments that can be read as they are stored.
std::vector<DrawPromise::Contents> DrawPromise::read(Machine &machine) const
{
    std::vector<Contents> all;
    const GLint pack_alignment = 1;
    GLint active = 0;
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
    glActiveTexture(GL_TEXTURE7);
    glPixelStorei(GL_PACK_ALIGNMENT, pack_alignment);
    std::vector<GLenum> points = {GL_DEPTH_ATTACHMENT};
    for (GLenum i = 0; i < 8; ++i)
        points.push_back(GL_COLOR_ATTACHMENT0 + i);
    for (const GLenum point : points) {
        const Attachment attachment = attachment_of(machine, point);
        const TextureForm &form = attachment.form;
        if (attachment.texture == 0 || !form.certain || form.samples != 0 ||
            form.target == GL_TEXTURE_CUBE_MAP)
            continue;
        const Transfer transfer = transfer_of(format_kind(form.format));
        Contents contents{attachment, {}};
        contents.texels.resize(std::size_t(form.width) * std::size_t(form.height) *
                               std::size_t(form.layers) * std::size_t(transfer.bytes));
        GLint bound = 0;
        glBindTexture(form.target, attachment.texture);
        glGetTexImage(form.target, 0, transfer.format.value, transfer.type.value,
                      contents.texels.data());
        glBindTexture(form.target, GLuint(bound));
        all.push_back(std::move(contents));
    }
    glActiveTexture(GLenum(active));
    machine.check_error("reading the attachments", no_error);
    return all;
}

void DrawPromise::check(Machine &machine, GLenum error, bool may_be_refused) const
{
    if (expected_ && *expected_ != no_error && error == GL_NO_ERROR)
        finding("a draw that the specification forbids gives no error");
    if (expected_ && *expected_ == no_error && error != GL_NO_ERROR && !may_be_refused)
        finding("a valid draw gives {}", error_name(error));
    if (!machine.bound_framebuffer())
        return;

    const std::vector<Contents> after = read(machine);
    GLint overflow = 0;
    glGetFramebufferParameteriv(GL_DRAW_FRAMEBUFFER, GL_DEPTH_PEELING_OVERFLOW_MESA, &overflow);
    if (error != GL_NO_ERROR) {
        check_unchanged(after);
        if (overflow != overflow_)
            finding("a draw that is an error has changed OVERFLOW");
    } else if (peels_) {
        check_peeled(after, overflow);
    }
}

void DrawPromise::check_unchanged(const std::vector<Contents> &after) const
{
    for (std::size_t i = 0; i < before_.size(); ++i)
        if (i < after.size() && before_[i].texels != after[i].texels)
            finding("a draw that is an error has changed attachment {:#x}",
                    after[i].attachment.point);
}

/// Layers that were in the order of DepthFunc still are, none has moved back, and what has fallen
/// out of the last one is counted as an overflow.
void DrawPromise::check_peeled(const std::vector<Contents> &after, GLint overflow) const
{
    if (before_.empty() || after.empty() ||
        before_.front().attachment.point != GL_DEPTH_ATTACHMENT ||
        format_kind(before_.front().attachment.form.format) != FormatKind::depth)
        return;
    const TextureForm &form = before_.front().attachment.form;
    const std::size_t pixels = std::size_t(form.width) * std::size_t(form.height);
    const std::size_t layers = std::size_t(form.layers);
    const auto depth = [&](const Contents &contents, std::size_t layer, std::size_t pixel) {
        float value = 0.0F;
        std::memcpy(&value, &contents.texels[4 * (layer * pixels + pixel)], sizeof value);
        return value;
    };
    const bool nearest_first = depth_func_ == GL_LESS || depth_func_ == GL_LEQUAL;
    const auto nearer = [&](float a, float b) { return nearest_first ? a < b : a > b; };
    GLdouble empty = 0.0;
    glGetDoublev(GL_DEPTH_CLEAR_VALUE, &empty);

    for (std::size_t p = 0; p < pixels; ++p) {
        bool sorted = true;
        for (std::size_t i = 0; i + 1 < layers; ++i) {
            const float a = depth(before_.front(), i, p), b = depth(before_.front(), i + 1, p);
            sorted = sorted && a == a && b == b && !nearer(b, a);
        }
        const float last = depth(before_.front(), layers - 1, p);
        if (!sorted || last != last)
            continue;
        for (std::size_t i = 0; i < layers; ++i) {
            const float now = depth(after.front(), i, p);
            if (nearer(depth(before_.front(), i, p), now) || now != now)
                finding("layer {} of pixel {} has moved back", i, p);
            if (i > 0 && nearer(now, depth(after.front(), i - 1, p)))
                finding("layer {} of pixel {} is before the one in front of it", i, p);
        }
        // A margin for the conversion of the empty depth to the format.
        const float margin = 1.0F / 32768.0F;
        const bool was_kept =
            nearest_first ? last < float(empty) - margin : last > float(empty) + margin;
        if (was_kept && nearer(depth(after.front(), layers - 1, p), last) && overflow == 0)
            finding("a fragment has fallen out of pixel {} without OVERFLOW", p);
    }
}

} // namespace kb::fuzz
