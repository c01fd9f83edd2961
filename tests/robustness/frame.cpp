// SPDX-License-Identifier: MIT

#include "tests/robustness/frame.hpp"

#include "lib/gl/depth_peeling.hpp"
#include "lib/gl/gl_objects.hpp"
#include "lib/gl/kbuffer.hpp"

#include <array>

namespace kb::test
{

namespace
{

constexpr int entries = 4;
constexpr int layers = 2;

// A triangle for each three vertices, without any array.
constexpr char vertex_source[] = R"(#version 130
uniform float seed;
out float shade;
void main()
{
    float triangle = float(gl_VertexID / 3);
    float angle = 2.0944 * float(gl_VertexID % 3) + 0.37 * triangle + seed;
    shade = fract(0.618 * (triangle + 7.0 * seed));
    gl_Position = vec4(0.95 * cos(angle), 0.95 * sin(angle), 1.8 * shade - 0.9, 1.0);
}
)";

constexpr char fragment_source[] = R"(#version 130
in float shade;
uniform float seed;
void main()
{
    gl_FragColor = vec4(shade, seed, 1.0 - shade, 0.5);
}
)";

// Each fragment moves all entries on by one place: a lost one, or two in the other order, show.
constexpr char program_source[] = R"(!!ARBfp1.0
OPTION MESA_kbuffer_program;
TEMP place, texel;
MUL place, fragment.position, program.local[1];
TEX texel, place, texture[0], 2D;
MAD result.kbuffer[0], fragment.color, program.local[0], texel;
MOV result.kbuffer[1], kbuffer[0];
MOV result.kbuffer[2], kbuffer[1];
MOV result.kbuffer[3], kbuffer[2];
END
)";

void append(std::vector<float> &all, const ImageRgbaF &image)
{
    for (const auto &pixel : image.pixels)
        for (int c = 0; c < 4; ++c)
            all.push_back(pixel[c]);
}

class Frame
{
public:
    Frame(const Gl &gl, const FrameOptions &options) : gl_(gl), options_(options) {}

    Result<std::vector<float>> draw()
    {
        auto program = Program::make(gl_, vertex_source, fragment_source);
        if (!program)
            return program.error();
        program->use();
        seed_ = program->uniform("seed");

        for (const auto part : {&Frame::draw_kbuffer, &Frame::draw_layers})
            if (auto drawn = (this->*part)(); !drawn)
                return drawn.error();
        gl_.UseProgram(0);
        if (auto checked = check_gl(gl_, "the frame"); !checked)
            return checked.error();
        return std::move(all_);
    }

private:
    void draw_triangles(int i)
    {
        gl_.Uniform1f(seed_, 0.1F * static_cast<float>(i));
        gl_.DrawArrays(GL_TRIANGLES, 0, 3 * (1 + i % 5));
        if (options_.split && i % 3 == 2)
            gl_.Flush();
    }

    Status draw_kbuffer()
    {
        auto buffer = KBuffer::make(gl_, GL_RGBA32F, options_.size, entries);
        if (!buffer)
            return buffer.error();
        const Texture texture = make_texture_2d(gl_, GL_RGBA8, 4, 4);
        std::array<GLubyte, 4 * 4 * 4> texels{};
        for (std::size_t i = 0; i < texels.size(); ++i)
            texels[i] = static_cast<GLubyte>(3 * i);
        gl_.BindTexture(GL_TEXTURE_2D, texture.id());
        gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 4, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                       texels.data());

        auto program = ArbProgram::make(gl_, GL_KBUFFER_PROGRAM_MESA, program_source);
        if (!program)
            return program.error();
        gl_.ProgramLocalParameter4fARB(GL_KBUFFER_PROGRAM_MESA, 1,
                                       1.0F / static_cast<float>(options_.size.width),
                                       1.0F / static_cast<float>(options_.size.height), 1.0F, 1.0F);

        buffer->clear({0.0F, 0.0F, 0.0F, 1.0F});
        gl_.Enable(GL_KBUFFER_PROGRAM_MESA);
        for (int i = 0; i < options_.draws; ++i) {
            gl_.ProgramLocalParameter4fARB(GL_KBUFFER_PROGRAM_MESA, 0, 0.5F,
                                           0.01F * static_cast<float>(i), 1.0F, 0.25F);
            draw_triangles(i);
        }
        gl_.Disable(GL_KBUFFER_PROGRAM_MESA);
        for (int e = 0; e < entries; ++e)
            append(all_, buffer->read_entry(e));
        return ok;
    }

    Status draw_layers()
    {
        auto peeling = DepthPeeling::make(
            gl_, {.size = options_.size, .count = layers, .color_formats = {GL_RGBA8}});
        if (!peeling)
            return peeling.error();
        for (int pass = 0; pass < 3; ++pass) {
            if (pass > 0)
                if (auto advanced = peeling->advance(); !advanced)
                    return advanced;
            peeling->clear();
            gl_.Enable(GL_DEPTH_PEELING_MESA);
            for (int i = 0; i < options_.draws; ++i)
                draw_triangles(i);
            gl_.Disable(GL_DEPTH_PEELING_MESA);
            for (int layer = 0; layer < layers; ++layer)
                append(all_, peeling->read_color(layer));
            all_.push_back(peeling->overflow() ? 1.0F : 0.0F);
        }
        return ok;
    }

    const Gl &gl_;
    FrameOptions options_;
    GLint seed_ = -1;
    std::vector<float> all_;
};

} // namespace

Result<std::vector<float>> draw_frame(const Gl &gl, const FrameOptions &options)
{
    return Frame(gl, options).draw();
}

} // namespace kb::test
