// SPDX-License-Identifier: MIT
//
// Draws each triangle of a mesh alone, without blending or any k-buffer, and writes all fragments
// in the order of drawing: what a correct k-buffer must have been given. Meant for stock Mesa. Each
// fragment is six 32-bit values: pixel (from the bottom left, row by row), depth, RGBA.
//
//     fragment-dump MESH SIZE ALPHA FILE     (ALPHA below 0: that of the vertices)

#include "context.hpp"
#include "image.hpp"
#include "scene.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdlib>
#include <vector>

namespace
{

kb::Status dump(const kb::Gl &gl, const kb::Mesh &mesh, int side, float alpha, const char *path)
{
    const kb::Size size{side, side};
    const auto program = kb::Scene::make_program(gl);
    if (!program)
        return program.error();
    const kb::Scene scene(gl, mesh, alpha < 0.0F ? std::nullopt : std::optional(alpha));
    const auto color = kb::make_texture_2d(gl, GL_RGBA32F, side, side);
    const auto depth = kb::make_texture_2d(gl, GL_DEPTH_COMPONENT32F, side, side);
    const kb::Framebuffer framebuffer(gl);
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color.id(), 0);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth.id(), 0);
    if (auto complete = kb::check_framebuffer(gl); !complete)
        return complete;

    gl.Viewport(0, 0, side, side);
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_ALWAYS);
    const float nothing = -1.0F; // No fragment has a negative alpha.
    gl.ClearColor(0.0F, 0.0F, 0.0F, nothing);
    const auto pixel_count = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
    std::vector<std::array<float, 4>> colors(pixel_count);
    std::vector<float> depths(pixel_count);
    std::vector<std::uint32_t> words;
    for (std::size_t triangle = 0; triangle < scene.triangle_count(); ++triangle) {
        gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        scene.draw_triangle(*program, {}, size, triangle);
        gl.ReadPixels(0, 0, side, side, GL_RGBA, GL_FLOAT, colors.data());
        gl.ReadPixels(0, 0, side, side, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
        for (std::size_t p = 0; p < pixel_count; ++p) {
            if (colors[p][3] == nothing)
                continue;
            words.push_back(static_cast<std::uint32_t>(p));
            words.push_back(std::bit_cast<std::uint32_t>(depths[p]));
            for (const float channel : colors[p])
                words.push_back(std::bit_cast<std::uint32_t>(channel));
        }
    }
    if (auto drawn = kb::check_gl(gl, "drawing"); !drawn)
        return drawn;
    return kb::write_file(path, std::as_bytes(std::span(words)));
}

kb::Status run(char **argv)
{
    auto mesh = kb::load_mesh(argv[1]);
    if (!mesh)
        return mesh.error();
    kb::fit_to_unit_sphere(*mesh);
    auto context = kb::make_context("osmesa");
    if (!context)
        return context.error();
    return dump((*context)->gl(), *mesh, std::atoi(argv[2]), std::strtof(argv[3], nullptr),
                argv[4]);
}

} // namespace

int main(int argc, char **argv)
{
    if (argc != 5) {
        fmt::print(stderr, "usage: fragment-dump MESH SIZE ALPHA FILE\n");
        return 2;
    }
    if (const auto done = run(argv); !done) {
        fmt::print(stderr, "fragment-dump: {}\n", done.error().message);
        return 1;
    }
    return 0;
}
