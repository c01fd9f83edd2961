// SPDX-License-Identifier: MIT
//
// The smallest program with GL_MESA_depth_peeling: three translucent triangles, drawn in the wrong
// order, come out sorted, two layers a pass. Copy it, and build it with
//
//     c++ -std=c++20 hello-peeling.cpp $(pkg-config --cflags --libs osmesa)
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
constexpr int k = 2; // Layers that a pass fills. The three triangles take two passes.

using Pixel = std::array<float, 4>;

// A triangle about the middle of the window, turned by some degrees, at a depth of 0 to 1.
void draw_triangle(float red, float green, float blue, float degrees, float depth)
{
    glColor4f(red, green, blue, 0.5F);
    glBegin(GL_TRIANGLES);
    for (const float corner : {0.0F, 120.0F, 240.0F}) {
        const float angle = (degrees + corner) * 3.14159265F / 180.0F;
        glVertex3f(0.9F * std::cos(angle), 0.9F * std::sin(angle), 2.0F * depth - 1.0F);
    }
    glEnd();
}

// An array of k layers, attached to the framebuffer that is bound.
GLuint attach_layers(GLenum attachment, GLenum internal_format)
{
    GLuint texture;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture);
    glTexStorage3D(GL_TEXTURE_2D_ARRAY, 1, internal_format, size, size, k);
    glFramebufferTexture(GL_FRAMEBUFFER, attachment, texture, 0);
    return texture;
}

int main(int argc, char **argv)
{
    const char *file = argc > 1 ? argv[1] : "hello-peeling.ppm";
    if (argc > 2 || !std::string_view(file).ends_with(".ppm")) {
        const bool help = argc == 2 && (!std::strcmp(file, "--help") || !std::strcmp(file, "-h"));
        return std::fprintf(help ? stdout : stderr,
                            "hello-peeling: usage: hello-peeling [FILE.ppm]: draws three "
                            "translucent triangles\n"),
               help ? 0 : 2;
    }

    // A context in memory. Nothing is drawn into its own buffer.
    std::array<GLubyte, 4 * 16 * 16> unused{};
    OSMesaContext context = OSMesaCreateContext(OSMESA_RGBA, nullptr);
    if (!context || !OSMesaMakeCurrent(context, unused.data(), GL_UNSIGNED_BYTE, 16, 16))
        return std::fprintf(stderr, "hello-peeling: OSMesa makes no context\n"), 1;
    const char *extensions = reinterpret_cast<const char *>(glGetString(GL_EXTENSIONS));
    if (!std::strstr(extensions, "GL_MESA_depth_peeling"))
        return std::fprintf(stderr, "hello-peeling: this Mesa has no GL_MESA_depth_peeling: "
                                    "start the program by scripts/run\n"),
               1;

    // Layer i of depth and color is to hold the fragment of rank i, nearest first.
    GLuint framebuffer;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    const GLuint colors = attach_layers(GL_COLOR_ATTACHMENT0, GL_RGBA32F);
    attach_layers(GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT32F);
    glViewport(0, 0, size, size);

    std::vector<Pixel> picture(size * size);
    std::vector<float> transmittance(size * size, 1.0F);
    GLint overflow = GL_FALSE;
    GLenum error = GL_NO_ERROR;
    int passes = 0;
    do {
        // The next pass begins behind the k layers of the last one.
        if (passes > 0)
            glFramebufferParameteri(GL_FRAMEBUFFER, GL_DEPTH_PEELING_FIRST_LAYER_MESA, passes * k);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT); // All layers, to 0 and depth 1.
        glEnable(GL_DEPTH_PEELING_MESA);
        draw_triangle(0.0F, 1.0F, 0.0F, 30.0F, 0.5F);   // green, in the middle
        draw_triangle(1.0F, 0.0F, 0.0F, 90.0F, 0.25F);  // red, nearest
        draw_triangle(0.0F, 0.0F, 1.0F, -30.0F, 0.75F); // blue, farthest
        glDisable(GL_DEPTH_PEELING_MESA);

        // Compose front to back. An empty layer has alpha 0.
        std::vector<Pixel> layers(k * size * size);
        glBindTexture(GL_TEXTURE_2D_ARRAY, colors);
        glGetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA, GL_FLOAT, layers.data());
        for (int i = 0; i < k * size * size; ++i) {
            const int p = i % (size * size);
            for (int c = 0; c < 3; ++c)
                picture[p][c] += transmittance[p] * layers[i][3] * layers[i][c];
            transmittance[p] *= 1.0F - layers[i][3];
        }

        // Did any fragment find no place?
        glGetFramebufferParameteriv(GL_FRAMEBUFFER, GL_DEPTH_PEELING_OVERFLOW_MESA, &overflow);
        error = glGetError();
        ++passes;
    } while (overflow && error == GL_NO_ERROR);

    // White behind it all.
    for (int p = 0; p < size * size; ++p)
        for (int c = 0; c < 3; ++c)
            picture[p][c] += transmittance[p];
    std::FILE *out = std::fopen(file, "wb");
    if (!out)
        return std::fprintf(stderr, "hello-peeling: cannot write %s: %s\n", file,
                            std::strerror(errno)),
               2;
    std::fprintf(out, "P6\n%d %d\n255\n", size, size);
    for (int y = size; y-- > 0;)
        for (int x = 0; x < size; ++x)
            for (int c = 0; c < 3; ++c)
                std::fputc(static_cast<int>(255.0F * picture[y * size + x][c] + 0.5F), out);
    if (std::fclose(out) != 0)
        return std::fprintf(stderr, "hello-peeling: cannot write %s: %s\n", file,
                            std::strerror(errno)),
               2;

    // In the middle: red/2 + green/4 + blue/8 + white/8.
    const Pixel expected = {0.625F, 0.375F, 0.25F};
    const Pixel &middle = picture[size / 2 * size + size / 2];
    std::printf("expected %.3f %.3f %.3f, got %.3f %.3f %.3f in %d passes\n", expected[0],
                expected[1], expected[2], middle[0], middle[1], middle[2], passes);
    OSMesaDestroyContext(context);
    return middle == expected && error == GL_NO_ERROR ? 0 : 1;
}
