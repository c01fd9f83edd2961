// SPDX-License-Identifier: MIT
//
//     clear   a pass over all pixels: all entries are 0, but the length of the pixel's ray
//     draw    the faces, once: the program composites what has left those that wait
//     flush   a pass over all pixels: the k that still wait, in order

#include "lib/gl/kbuffer.hpp"
#include "lib/gl/mesh_buffers.hpp"
#include "volume/face_program.hpp"
#include "volume/segment_texture.hpp"
#include "volume/two_nearest.hpp"
#include "volume/volume_program.hpp"
#include "volume/volume_renderer.hpp"

#include <fmt/format.h>

#include <variant>

namespace kb
{

namespace
{

constexpr int table_unit = 8; ///< Of the flush: behind the attachments of the k-buffer.

constexpr const char *face_shader = R"(
layout(location = 0) out vec4 fragment;

void main()
{
    fragment = vec4(eye_depth(), coded_scalar(), 0.0, 0.0);
}
)";

constexpr const char *ray_shader = R"(
layout(location = 0) out vec4 fragment;

void main()
{
    fragment = vec4(ray_length());
}
)";

/// Takes the nearest of those that are left, k times. Loops over arrays are slow: few fragments do
/// without, and not at all where nothing has been drawn. (A branch about loops that index arrays is
/// more than softpipe can do.)
std::string composite_waiting(int k)
{
    constexpr int few = 16;
    std::string text = "    if (front.x > 0.0";
    for (int i = 0; i < k; ++i)
        text += fmt::format(" || waiting[{}].x > 0.0", i);
    text += ") {\n        add_last();\n";
    for (int i = 0; i < k && k <= few; ++i) {
        for (int j = i + 1; j < k; ++j)
            text += fmt::format("        order(waiting[{}], waiting[{}]);\n", i, j);
        text += fmt::format("        add(waiting[{}]);\n", i);
    }
    if (k <= few)
        return text + "    }\n";
    return fmt::format("    add_last();\n"
                       "    for (int i = 0; i < {0}; ++i) {{\n"
                       "        for (int j = i + 1; j < {0}; ++j)\n"
                       "            order(waiting[i], waiting[j]);\n"
                       "        add(waiting[i]);\n"
                       "    }}\n",
                       k);
}

constexpr const char *order_function = R"(
void order(inout vec2 a, inout vec2 b)
{
    bool swap = b.x <= a.x; // Of equal ones those at the end have come first.
    vec2 nearer = swap ? b : a;
    b = swap ? a : b;
    a = nearer;
}

)";

/// Composites what still waits.
std::string make_flush_shader(const KBuffer &kbuffer, int k, SegmentLookup lookup)
{
    const auto fetch = [&kbuffer](int entry) {
        return fmt::format("texelFetch(attachment{}, ivec3(pixel, {}), 0)",
                           entry % kbuffer.attachments(), entry / kbuffer.attachments());
    };
    std::string text = "#version 330\n";
    for (int a = 0; a < kbuffer.attachments(); ++a)
        text += fmt::format("uniform sampler2DArray attachment{};\n", a);
    text += "uniform vec3 background;\n"
            "layout(location = 0) out vec4 result;\n";
    const TableSize size = table_size(lookup);
    text +=
        lookup.interpolates() ? SegmentTextures::shader(size) : PackedSegmentTexture::shader(size);
    text += make_volume_shader(lookup.parts);
    text += order_function;
    text += fmt::format("ivec2 pixel = ivec2(gl_FragCoord.xy);\n"
                        "void add_last()\n"
                        "{{\n"
                        "    vec4 last = {};\n",
                        fetch(2));
    text += lookup.interpolates()
                ? fmt::format("    add_cut(last.x, last.y, {:.1f} * last.z);\n", 2.0 * lookup.parts)
                : "    vec3 change;\n"
                  "    vec4 optics = unpack(last.xy, last.w, change);\n"
                  "    add_optics(optics, change, last.z);\n";
    text += fmt::format("}}\n"
                        "void main()\n"
                        "{{\n"
                        "    start({}, {});\n"
                        "    vec2 waiting[{}];\n",
                        fetch(0), fetch(1), 2 * waiting_entries(k));
    text += "    vec4 pair;\n";
    for (int i = 0; i < waiting_entries(k); ++i)
        text += fmt::format("    pair = {}; waiting[{}] = pair.xy; waiting[{}] = pair.zw;\n",
                            fetch(volume_entries(0) + i), 2 * i, 2 * i + 1);
    text += composite_waiting(k);
    text += "    result = vec4(color.rgb + (1.0 - color.a) * background, color.a);\n"
            "}\n";
    return text;
}

/// The textures that a lookup wants.
using Textures = std::variant<PackedSegmentTexture, SegmentTextures>;

Textures make_textures(const Gl &gl, const VolumeSettings &settings)
{
    const PreintegratedTable table(settings.transfer, table_size(settings.lookup));
    if (settings.lookup.interpolates())
        return SegmentTextures(gl, table);
    return PackedSegmentTexture(gl, table);
}

class KBufferRenderer final : public VolumeRenderer
{
public:
    KBufferRenderer(const Gl &gl, const VolumeSettings &settings, KBuffer kbuffer, Program rays,
                    ArbProgram clear, Program faces, ArbProgram program, Program flush)
        : gl_(gl), size_(settings.size), kbuffer_(std::move(kbuffer)), rays_(std::move(rays)),
          clear_(std::move(clear)), faces_(std::move(faces)), program_(std::move(program)),
          flush_(std::move(flush)), table_(make_textures(gl, settings)),
          picture_(make_texture_2d(gl, GL_RGBA32F, size_.width, size_.height)), framebuffer_(gl),
          empty_(gl)
    {
        flush_.use();
        for (int a = 0; a < kbuffer_.attachments(); ++a)
            gl.Uniform1i(flush_.uniform(fmt::format("attachment{}", a).c_str()), a);
        if (settings.lookup.interpolates()) {
            gl.Uniform1i(flush_.uniform("thin"), table_unit);
            gl.Uniform1i(flush_.uniform("fading"), table_unit + 1);
        } else {
            gl.Uniform1i(flush_.uniform("segments"), table_unit);
        }
        gl.Uniform3f(flush_.uniform("background"), settings.background.r, settings.background.g,
                     settings.background.b);
        gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
        gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, picture_.id(),
                                0);
    }

    Status draw(const SortedFaces &faces) override
    {
        kbuffer_.bind();
        gl_.Disable(GL_DEPTH_TEST);
        gl_.Enable(GL_KBUFFER_PROGRAM_MESA);
        clear_.bind();
        rays_.use();
        set_rays(gl_, rays_, faces.camera(), size_);
        draw_full_screen(gl_, empty_);
        bind_table(0);
        program_.bind();
        draw_faces(gl_, faces_, faces, size_);
        gl_.Disable(GL_KBUFFER_PROGRAM_MESA);
        flush();
        return check_gl(gl_, "drawing the volume");
    }

    GLuint framebuffer() const override { return framebuffer_.id(); }
    int passes() const override { return 1; }
    int bytes_per_pixel() const override { return 16 * kbuffer_.attachments() * kbuffer_.layers(); }

private:
    void bind_table(int unit) const
    {
        std::visit([unit](const auto &textures) { textures.bind(unit); }, table_);
    }

    void flush() const
    {
        gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
        gl_.Viewport(0, 0, size_.width, size_.height);
        kbuffer_.bind_textures();
        bind_table(table_unit);
        flush_.use();
        draw_full_screen(gl_, empty_);
    }

    const Gl &gl_;
    Size size_;
    KBuffer kbuffer_;
    Program rays_;
    ArbProgram clear_;
    Program faces_;
    ArbProgram program_;
    Program flush_;
    Textures table_;
    Texture picture_;
    Framebuffer framebuffer_;
    VertexArray empty_;
};

} // namespace

Result<std::unique_ptr<VolumeRenderer>> make_kbuffer_renderer(const Gl &gl,
                                                              const VolumeSettings &settings)
{
    auto kbuffer = KBuffer::make(gl, GL_RGBA32F, settings.size, volume_entries(settings.k));
    if (!kbuffer)
        return kbuffer.error();
    auto rays = Program::make(gl, full_screen_vertex_shader,
                              std::string("#version 330\n") + ray_length_shader + ray_shader);
    if (!rays)
        return rays.error();
    auto clear = ArbProgram::make(gl, GL_KBUFFER_PROGRAM_MESA, make_clear_program(settings.k));
    if (!clear)
        return clear.error();
    auto faces = make_face_program(gl, face_shader);
    if (!faces)
        return faces.error();
    auto program = ArbProgram::make(gl, GL_KBUFFER_PROGRAM_MESA,
                                    make_volume_program(settings.k, settings.lookup));
    if (!program)
        return program.error();
    auto flush = Program::make(gl, full_screen_vertex_shader,
                               make_flush_shader(*kbuffer, settings.k, settings.lookup));
    if (!flush)
        return flush.error();
    auto renderer = std::make_unique<KBufferRenderer>(
        gl, settings, std::move(*kbuffer), std::move(*rays), std::move(*clear), std::move(*faces),
        std::move(*program), std::move(*flush));
    if (auto complete = check_framebuffer(gl); !complete)
        return complete.error();
    return std::unique_ptr<VolumeRenderer>(std::move(renderer));
}

} // namespace kb
