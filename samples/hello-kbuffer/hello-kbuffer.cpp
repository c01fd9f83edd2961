// SPDX-License-Identifier: MIT
//
// The smallest program with GL_MESA_kbuffer_program: three translucent triangles, drawn in the
// wrong order, come out sorted. Copy it, and build it with
//
//     c++ -std=c++20 hello-kbuffer.cpp $(pkg-config --cflags --libs osmesa)
//
// It draws, composes on the CPU, writes a picture and checks one pixel.

#define GL_GLEXT_PROTOTYPES 1
#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/mesa_kbuffer.h>
#include <GL/osmesa.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <vector>

constexpr int size = 256;
constexpr int k = 4;          // Fragments kept of each pixel: one color attachment each.
constexpr float alpha = 0.5F; // Of all triangles.

// An entry is (red, green, blue, depth). The program inserts the incoming fragment where it
// belongs: p = depth < kbuffer[i].depth says that place i is the fragment's or behind it.
// `kbuffer-program --layout rgbz --k 4` prints it.
constexpr char insertion[] = R"(!!ARBfp1.0
OPTION MESA_kbuffer_program;
TEMP t, new, p;
SLT t.x, fragment.position.z, kbuffer[3].w;
SUB t.x, t.x, 0.5;
KIL t.x;
MOV new.xyz, fragment.color;
MOV new.w, fragment.position.z;
SLT p.x, fragment.position.z, kbuffer[0].w;
CMP result.kbuffer[0], -p.x, new, kbuffer[0];
SLT p.y, fragment.position.z, kbuffer[1].w;
CMP t, -p.y, new, kbuffer[1];
CMP result.kbuffer[1], -p.x, kbuffer[0], t;
SLT p.x, fragment.position.z, kbuffer[2].w;
CMP t, -p.x, new, kbuffer[2];
CMP result.kbuffer[2], -p.y, kbuffer[1], t;
SLT p.y, fragment.position.z, kbuffer[3].w;
CMP t, -p.y, new, kbuffer[3];
CMP result.kbuffer[3], -p.x, kbuffer[2], t;
END
)";

using Pixel = std::array<float, 4>;

// A triangle about the middle of the window, turned by some degrees, at a depth of 0 to 1.
void draw_triangle(float red, float green, float blue, float degrees, float depth)
{
    glColor4f(red, green, blue, alpha);
    glBegin(GL_TRIANGLES);
    for (const float corner : {0.0F, 120.0F, 240.0F}) {
        const float angle = (degrees + corner) * 3.14159265F / 180.0F;
        glVertex3f(0.9F * std::cos(angle), 0.9F * std::sin(angle), 2.0F * depth - 1.0F);
    }
    glEnd();
}

int main(int argc, char **argv)
{
    const char *file = argc > 1 ? argv[1] : "hello-kbuffer.ppm";
    if (argc > 2 || !std::string_view(file).ends_with(".ppm")) {
        const bool help = argc == 2 && (!std::strcmp(file, "--help") || !std::strcmp(file, "-h"));
        return std::fprintf(help ? stdout : stderr,
                            "hello-kbuffer: usage: hello-kbuffer [FILE.ppm]: draws three "
                            "translucent triangles\n"),
               help ? 0 : 2;
    }

    // A context in memory. Nothing is drawn into its own buffer.
    std::array<GLubyte, 4 * 16 * 16> unused{};
    OSMesaContext context = OSMesaCreateContext(OSMESA_RGBA, nullptr);
    if (!context || !OSMesaMakeCurrent(context, unused.data(), GL_UNSIGNED_BYTE, 16, 16))
        return std::fprintf(stderr, "hello-kbuffer: OSMesa makes no context\n"), 1;
    const char *extensions = reinterpret_cast<const char *>(glGetString(GL_EXTENSIONS));
    if (!std::strstr(extensions, "GL_MESA_kbuffer_program"))
        return std::fprintf(stderr, "hello-kbuffer: this Mesa has no GL_MESA_kbuffer_program: "
                                    "start the program by scripts/run\n"),
               1;

    // The k-buffer: one float color attachment for each of the k fragments.
    GLuint framebuffer, textures[k];
    GLenum draw_buffers[k];
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glGenTextures(k, textures);
    for (int i = 0; i < k; ++i) {
        draw_buffers[i] = GL_COLOR_ATTACHMENT0 + i;
        glBindTexture(GL_TEXTURE_2D, textures[i]);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, size, size, 0, GL_RGBA, GL_FLOAT, nullptr);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
        glFramebufferTexture2D(GL_FRAMEBUFFER, draw_buffers[i], GL_TEXTURE_2D, textures[i], 0);
    }
    glDrawBuffers(k, draw_buffers);
    glViewport(0, 0, size, size);
    glClearColor(0.0F, 0.0F, 0.0F, 1.0F); // Depth 1: no fragment yet.
    glClear(GL_COLOR_BUFFER_BIT);

    // The program runs for every fragment, in the place of blending.
    glBindProgramARB(GL_KBUFFER_PROGRAM_MESA, 1);
    glProgramStringARB(GL_KBUFFER_PROGRAM_MESA, GL_PROGRAM_FORMAT_ASCII_ARB, std::strlen(insertion),
                       insertion);
    if (glGetError() != GL_NO_ERROR)
        return std::fprintf(
                   stderr, "hello-kbuffer: %s\n",
                   reinterpret_cast<const char *>(glGetString(GL_PROGRAM_ERROR_STRING_ARB))),
               1;
    glEnable(GL_KBUFFER_PROGRAM_MESA);
    draw_triangle(0.0F, 1.0F, 0.0F, 30.0F, 0.5F);   // green, in the middle
    draw_triangle(1.0F, 0.0F, 0.0F, 90.0F, 0.25F);  // red, nearest
    draw_triangle(0.0F, 0.0F, 1.0F, -30.0F, 0.75F); // blue, farthest
    glDisable(GL_KBUFFER_PROGRAM_MESA);

    // Compose front to back over white.
    std::vector<Pixel> entries[k];
    for (int i = 0; i < k; ++i) {
        entries[i].resize(size * size);
        glReadBuffer(draw_buffers[i]);
        glReadPixels(0, 0, size, size, GL_RGBA, GL_FLOAT, entries[i].data());
    }
    std::vector<Pixel> picture(size * size);
    for (int p = 0; p < size * size; ++p) {
        float transmittance = 1.0F;
        for (int i = 0; i < k && entries[i][p][3] < 1.0F; ++i, transmittance *= 1.0F - alpha)
            for (int c = 0; c < 3; ++c)
                picture[p][c] += transmittance * alpha * entries[i][p][c];
        for (int c = 0; c < 3; ++c)
            picture[p][c] += transmittance;
    }
    std::FILE *out = std::fopen(file, "wb");
    if (!out)
        return std::fprintf(stderr, "hello-kbuffer: cannot write %s: %s\n", file,
                            std::strerror(errno)),
               2;
    std::fprintf(out, "P6\n%d %d\n255\n", size, size);
    for (int y = size; y-- > 0;)
        for (int x = 0; x < size; ++x)
            for (int c = 0; c < 3; ++c)
                std::fputc(static_cast<int>(255.0F * picture[y * size + x][c] + 0.5F), out);
    if (std::fclose(out) != 0)
        return std::fprintf(stderr, "hello-kbuffer: cannot write %s: %s\n", file,
                            std::strerror(errno)),
               2;

    // In the middle: red/2 + green/4 + blue/8 + white/8.
    const Pixel expected = {0.625F, 0.375F, 0.25F};
    const Pixel &middle = picture[size / 2 * size + size / 2];
    std::printf("expected %.3f %.3f %.3f, got %.3f %.3f %.3f\n", expected[0], expected[1],
                expected[2], middle[0], middle[1], middle[2]);
    OSMesaDestroyContext(context);
    return middle == expected && glGetError() == GL_NO_ERROR ? 0 : 1;
}
