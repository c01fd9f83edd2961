// SPDX-License-Identifier: MIT
//
// Fuzzes the parser of k-buffer programs and, by drawing a few pixels, what the driver makes of
// the programs. An input is a program string. Besides what the sanitizers and assertions find:
//
//   - a string that is refused gives INVALID_OPERATION, a position and a message, and leaves the
//     program that was there before;
//   - one that is accepted gives none of them, can be read back, is refused by the fragment
//     target, and draws without an error;
//   - a program that has no result leaves all entries as they are, bit for bit.

#include "fuzz/finding.hpp"
#include "fuzz/offscreen.hpp"

#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace kb::fuzz
{

namespace
{

constexpr int size = 2;
constexpr int buffers = 8;
constexpr int layers = 8;

constexpr std::string_view good_program = "!!ARBfp1.0\n"
                                          "OPTION MESA_kbuffer_program;\n"
                                          "ADD result.kbuffer[0], kbuffer[0], 1;\n"
                                          "END\n";

void expect_no_error(const char *what)
{
    if (const GLenum error = take_error(); error != GL_NO_ERROR)
        finding("{} gives {}", what, error_name(error));
}

GLenum load(GLenum target, std::string_view program)
{
    glProgramStringARB(target, GL_PROGRAM_FORMAT_ASCII_ARB, GLsizei(program.size()),
                       program.data());
    return take_error();
}

/// Color attachments of all entries that a program can name, with one pixel pattern.
class KbufferFramebuffer
{
public:
    KbufferFramebuffer(const std::array<GLenum, buffers> &formats, int samples)
        : samples_(samples),
          target_(samples ? GL_TEXTURE_2D_MULTISAMPLE_ARRAY : GL_TEXTURE_2D_ARRAY)
    {
        std::array<GLenum, buffers> draw_buffers{};
        glGenFramebuffers(1, &framebuffer_);
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
        glGenTextures(buffers, textures_.data());
        for (int i = 0; i < buffers; ++i) {
            glBindTexture(target_, textures_[i]);
            if (samples)
                glTexImage3DMultisample(target_, samples, formats[i], size, size, layers, GL_TRUE);
            else
                glTexStorage3D(target_, 1, formats[i], size, size, layers);
            draw_buffers[i] = GL_COLOR_ATTACHMENT0 + i;
            glFramebufferTexture(GL_FRAMEBUFFER, draw_buffers[i], textures_[i], 0);
        }
        glBindTexture(target_, 0);
        glDrawBuffers(buffers, draw_buffers.data());
        if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
            finding("a framebuffer of {} samples is not complete", samples);
        expect_no_error("making a framebuffer");
    }

    /// The same contents for each program, not the same in any two entries' pixels.
    void begin() const
    {
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
        for (int i = 0; i < buffers; ++i) {
            const std::array<GLfloat, 4> color = {0.125F * i, 1.0F - 0.125F * i, -0.5F * i, 0.25F};
            glClearBufferfv(GL_COLOR, i, color.data());
        }
    }

    void draw() const
    {
        begin();
        glBegin(GL_TRIANGLE_STRIP);
        for (int i = 0; i < 4; ++i) {
            glColor4f(0.25F * i, 0.5F, 1.0F - 0.25F * i, 0.75F);
            glVertex3f(i & 1 ? 1.0F : -1.0F, i & 2 ? 1.0F : -1.0F, 0.25F * i);
        }
        glEnd();
    }

    /// All texels, not of multisample textures.
    std::vector<float> read() const
    {
        constexpr std::size_t texture_floats = 4 * size * size * layers;
        std::vector<float> texels(buffers * texture_floats);
        for (int i = 0; i < buffers; ++i) {
            glBindTexture(target_, textures_[i]);
            glGetTexImage(target_, 0, GL_RGBA, GL_FLOAT, &texels[i * texture_floats]);
        }
        glBindTexture(target_, 0);
        return texels;
    }

    bool readable() const { return samples_ == 0; }

private:
    int samples_;
    GLenum target_;
    GLuint framebuffer_ = 0;
    std::array<GLuint, buffers> textures_{};
};

/// Something to look up in each target that a texture instruction can name, of unit 0 and 1.
void make_textures()
{
    const std::array<GLubyte, 4 * 4 * 4> texels = {10, 200, 30, 40, 50, 60, 70, 80};
    std::array<GLuint, 5> textures{};
    glGenTextures(GLsizei(textures.size()), textures.data());
    for (const GLenum unit : {GL_TEXTURE0, GL_TEXTURE1}) {
        glActiveTexture(unit);
        glBindTexture(GL_TEXTURE_1D, textures[0]);
        glBindTexture(GL_TEXTURE_2D, textures[1]);
        glBindTexture(GL_TEXTURE_3D, textures[2]);
        glBindTexture(GL_TEXTURE_CUBE_MAP, textures[3]);
        glBindTexture(GL_TEXTURE_RECTANGLE, textures[4]);
    }
    glTexImage1D(GL_TEXTURE_1D, 0, GL_RGBA8, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 2, 2, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA8, 2, 2, 2, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    for (int face = 0; face < 6; ++face)
        glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, GL_RGBA8, 2, 2, 0, GL_RGBA,
                     GL_UNSIGNED_BYTE, texels.data());
    glTexImage2D(GL_TEXTURE_RECTANGLE, 0, GL_RGBA8, 2, 2, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 texels.data());
    for (const GLenum target :
         {GL_TEXTURE_1D, GL_TEXTURE_2D, GL_TEXTURE_3D, GL_TEXTURE_CUBE_MAP, GL_TEXTURE_RECTANGLE})
        glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glActiveTexture(GL_TEXTURE0);
    expect_no_error("making textures");
}

class ProgramTarget
{
public:
    ProgramTarget()
    {
        context_.make_current();
        if (!has_extension("GL_MESA_kbuffer_program"))
            finding("this driver has no GL_MESA_kbuffer_program");
        std::array<GLenum, buffers> floats{};
        floats.fill(GL_RGBA32F);
        framebuffers_.emplace_back(floats, 0);
        framebuffers_.emplace_back(
            std::array<GLenum, buffers>{GL_RGBA8, GL_RGBA16F, GL_SRGB8_ALPHA8, GL_R32F, GL_RGB10_A2,
                                        GL_RG16, GL_R11F_G11F_B10F, GL_RGB565},
            0);
        if (get_integer(GL_MAX_SAMPLES) >= 4)
            framebuffers_.emplace_back(floats, 4);
        make_textures();
        glViewport(0, 0, size, size);
        glEnable(GL_KBUFFER_PROGRAM_MESA);
        std::array<GLuint, 2> programs{};
        glGenProgramsARB(2, programs.data());
        glBindProgramARB(GL_KBUFFER_PROGRAM_MESA, programs[0]);
        glBindProgramARB(GL_FRAGMENT_PROGRAM_ARB, programs[1]);
        expect_no_error("making programs");
    }

    void run(std::string_view text)
    {
        // The program stays what it is: reloading it costs nothing but its parsing.
        if (load(GL_KBUFFER_PROGRAM_MESA, good_program) != GL_NO_ERROR)
            finding("a valid program is refused");
        const bool accepted = check_loaded(text);
        check_string_is(accepted ? text : good_program);
        if (!accepted)
            return;
        check_parameters();
        if (load(GL_FRAGMENT_PROGRAM_ARB, text) == GL_NO_ERROR)
            finding("the fragment target accepts a k-buffer program");
        for (const KbufferFramebuffer &framebuffer : framebuffers_)
            check_draws(framebuffer, text);
    }

private:
    static bool check_loaded(std::string_view text)
    {
        const GLenum error = load(GL_KBUFFER_PROGRAM_MESA, text);
        const GLint position = get_integer(GL_PROGRAM_ERROR_POSITION_ARB);
        const char *message =
            reinterpret_cast<const char *>(glGetString(GL_PROGRAM_ERROR_STRING_ARB));
        if (!message)
            finding("there is no PROGRAM_ERROR_STRING");
        if (error == GL_NO_ERROR) {
            if (position != -1)
                finding("an accepted program has the error position {}", position);
            return true;
        }
        if (error != GL_INVALID_OPERATION)
            finding("a refused program gives {}", error_name(error));
        // The parser sees a line end after the string.
        if (position < 0 || position > GLint(text.size()) + 1)
            finding("error position {} in a string of {} bytes", position, text.size());
        if (!*message)
            finding("a refused program has no error message");
        return false;
    }

    static void check_string_is(std::string_view expected)
    {
        GLint length = -1;
        glGetProgramivARB(GL_KBUFFER_PROGRAM_MESA, GL_PROGRAM_LENGTH_ARB, &length);
        if (length != GLint(expected.size()))
            finding("the program has {} bytes, not {}", length, expected.size());
        // One more, for the zero byte that some GL implementations add.
        std::vector<char> string(expected.size() + 1);
        glGetProgramStringARB(GL_KBUFFER_PROGRAM_MESA, GL_PROGRAM_STRING_ARB, string.data());
        if (std::memcmp(string.data(), expected.data(), expected.size()) != 0)
            finding("the program's string is not what was loaded");
        expect_no_error("reading the program back");
    }

    /// The resources that a program needs are within what the driver says it can do.
    static void check_parameters()
    {
        struct Resource {
            const char *name;
            GLenum used, available;
        };
        for (const Resource &resource : {
                 Resource{"instructions", GL_PROGRAM_INSTRUCTIONS_ARB,
                          GL_MAX_PROGRAM_INSTRUCTIONS_ARB},
                 Resource{"temporaries", GL_PROGRAM_TEMPORARIES_ARB,
                          GL_MAX_PROGRAM_TEMPORARIES_ARB},
                 Resource{"parameters", GL_PROGRAM_PARAMETERS_ARB, GL_MAX_PROGRAM_PARAMETERS_ARB},
                 Resource{"ALU instructions", GL_PROGRAM_ALU_INSTRUCTIONS_ARB,
                          GL_MAX_PROGRAM_ALU_INSTRUCTIONS_ARB},
                 Resource{"texture instructions", GL_PROGRAM_TEX_INSTRUCTIONS_ARB,
                          GL_MAX_PROGRAM_TEX_INSTRUCTIONS_ARB},
             }) {
            GLint used = -1, available = -1;
            glGetProgramivARB(GL_KBUFFER_PROGRAM_MESA, resource.used, &used);
            glGetProgramivARB(GL_KBUFFER_PROGRAM_MESA, resource.available, &available);
            if (used < 0 || used > available)
                finding("an accepted program has {} {} of {}", used, resource.name, available);
        }
        GLint attributes = -1;
        glGetProgramivARB(GL_KBUFFER_PROGRAM_MESA, GL_PROGRAM_ATTRIBS_ARB, &attributes);
        expect_no_error("querying the program's resources");
    }

    static void check_draws(const KbufferFramebuffer &framebuffer, std::string_view text)
    {
        const bool writes = text.find("result") != std::string_view::npos;
        std::vector<float> before;
        if (!writes && framebuffer.readable()) {
            framebuffer.begin();
            before = framebuffer.read();
        }
        framebuffer.draw();
        expect_no_error("drawing with an accepted program");
        if (!before.empty()) {
            const std::vector<float> after = framebuffer.read();
            if (std::memcmp(before.data(), after.data(), before.size() * sizeof before[0]) != 0)
                finding("a program without results has changed an entry");
        }
        glFinish();
    }

    Offscreen context_;
    std::vector<KbufferFramebuffer> framebuffers_;
};

} // namespace

} // namespace kb::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
    // One context for all inputs: no state but the program's changes from one to the next.
    static kb::fuzz::ProgramTarget target;

    target.run({reinterpret_cast<const char *>(data), size});
    return 0;
}
