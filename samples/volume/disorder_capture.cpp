// SPDX-License-Identifier: MIT

#include "volume/disorder_capture.hpp"

#include "lib/gl/depth_peeling.hpp"
#include "volume/face_program.hpp"

#include <fmt/format.h>

#include <array>
#include <limits>

namespace kb
{

namespace
{

constexpr int layers_a_pass = 32;
constexpr std::uint32_t no_fragment = std::numeric_limits<std::uint32_t>::max();

/// What the fragments of each pixel say, by their depth.
using Arrivals = std::vector<std::vector<std::uint32_t>>;

/// Puts the layers of a pass behind those of the passes before.
void append_layers(const Gl &gl, const DepthPeeling &peeling, Arrivals &pixels)
{
    std::vector<std::uint32_t> layers(pixels.size() * layers_a_pass);
    gl.BindTexture(GL_TEXTURE_2D_ARRAY, peeling.color().id());
    gl.GetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, layers.data());
    for (std::size_t i = 0; i < layers.size(); ++i) {
        if (layers[i] != no_fragment)
            pixels[i % pixels.size()].push_back(layers[i]);
    }
}

Result<Arrivals> capture_arrivals(const Gl &gl, Size size, std::size_t most_layers, GLenum nearer,
                                  const std::function<void()> &draw, const GoOn &go_on)
{
    PeelingLayers layers;
    layers.size = size;
    layers.count = layers_a_pass;
    layers.func = nearer;
    layers.color_formats = {GL_R32UI};
    auto peeling = DepthPeeling::make(gl, layers);
    if (!peeling)
        return peeling.error();

    Arrivals pixels(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
    const std::array<GLuint, 4> empty{no_fragment};
    Status status = peeling->restart();
    for (bool more = true; status && more;) {
        peeling->clear();
        gl.ClearBufferuiv(GL_COLOR, 0, empty.data());
        gl.Enable(GL_DEPTH_PEELING_MESA);
        draw();
        gl.Disable(GL_DEPTH_PEELING_MESA);
        append_layers(gl, *peeling, pixels);
        if (go_on && !go_on())
            return Error{"stopped"};
        more = peeling->overflow();
        if (more && static_cast<std::size_t>(peeling->first_layer()) > most_layers)
            return Error{fmt::format("{} layers have not come to the end of {} primitives: this is "
                                     "an error of the driver",
                                     peeling->first_layer() + layers_a_pass, most_layers)};
        if (more)
            status = peeling->advance();
    }
    if (!status)
        return status.error();
    if (auto drawn = check_gl(gl, "capturing the order of fragments"); !drawn)
        return drawn.error();
    return pixels;
}

} // namespace

Result<Disorder> capture_disorder(const Gl &gl, Size size, std::size_t most_layers, GLenum nearer,
                                  const std::function<void()> &draw, const GoOn &go_on)
{
    const auto pixels = capture_arrivals(gl, size, most_layers, nearer, draw, go_on);
    if (!pixels)
        return pixels.error();
    Disorder disorder;
    for (const std::vector<std::uint32_t> &arrivals : *pixels)
        disorder.add_pixel(arrivals);
    return disorder;
}

Result<Disorder> capture_disorder(const Gl &gl, const SortedFaces &faces, Size size,
                                  const GoOn &go_on)
{
    const auto program = make_face_program(gl, arrival_shader);
    if (!program)
        return program.error();
    // A face makes one fragment of a pixel at most.
    return capture_disorder(
        gl, size, faces.order().size(), GL_GREATER, [&] { draw_faces(gl, *program, faces, size); },
        go_on);
}

} // namespace kb
