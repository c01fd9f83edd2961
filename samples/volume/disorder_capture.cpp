// SPDX-License-Identifier: MIT

#include "disorder_capture.hpp"

#include "depth_peeling.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <limits>

namespace kb
{

static constexpr int layers_a_pass = 32;
static constexpr std::uint32_t no_fragment = std::numeric_limits<std::uint32_t>::max();

/// Puts the arrivals of a pass behind those of earlier ones, pixel by pixel.
static void append_layers(const Gl &gl, const DepthPeeling &peeling,
                          std::vector<std::uint32_t> &layers,
                          std::vector<std::vector<std::uint32_t>> &pixels)
{
    gl.BindTexture(GL_TEXTURE_2D_ARRAY, peeling.color().id());
    gl.GetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, layers.data());
    for (std::size_t i = 0; i < layers.size(); ++i)
        if (layers[i] != no_fragment)
            pixels[i % pixels.size()].push_back(layers[i]);
}

Result<Disorder> capture_disorder(const Gl &gl, Size size, std::size_t triangles,
                                  const std::function<void()> &draw)
{
    auto peeling =
        DepthPeeling::make(gl, {.size = size, .count = layers_a_pass, .color_formats = {GL_R32UI}});
    if (!peeling)
        return peeling.error();

    std::vector<std::vector<std::uint32_t>> pixels(static_cast<std::size_t>(size.width) *
                                                   static_cast<std::size_t>(size.height));
    std::vector<std::uint32_t> layers(pixels.size() * layers_a_pass);
    const std::array<GLuint, 4> clear{no_fragment};
    auto started = peeling->restart();
    while (started) {
        peeling->clear();
        gl.ClearBufferuiv(GL_COLOR, 0, clear.data());
        gl.Enable(GL_DEPTH_PEELING_MESA);
        draw();
        gl.Disable(GL_DEPTH_PEELING_MESA);
        append_layers(gl, *peeling, layers, pixels);
        if (!peeling->overflow())
            break;
        // Each triangle has one fragment of a pixel at most; the last pass may find nothing.
        const auto taken = static_cast<std::size_t>(peeling->first_layer()) + layers_a_pass;
        if (taken > triangles + layers_a_pass)
            return Error{fmt::format("{} layers have not come to the end of {} triangles: this is "
                                     "an error of the driver",
                                     taken, triangles)};
        started = peeling->advance();
    }
    if (!started)
        return started.error();
    if (auto drawn = check_gl(gl, "capturing the order of fragments"); !drawn)
        return drawn.error();

    Disorder disorder;
    for (const std::vector<std::uint32_t> &arrivals : pixels)
        disorder.add_pixel(arrivals);
    return disorder;
}

} // namespace kb
