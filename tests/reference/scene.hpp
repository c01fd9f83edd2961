// SPDX-License-Identifier: MIT
//
// A scene of the reference test: a framebuffer, the state that holds for all of it, and the
// commands that draw to it. As a file it is JSON, which reproduces it bit for bit.

#pragma once

#include "lib/result.hpp"
#include "programs/kbuffer_program.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace kb::reference
{

enum class Extension { peeling, program };
enum class Func { less, lequal, greater, gequal };
enum class DepthFormat { d32f, d24, d16 };
enum class ColorFormat { rgba32f, rgba16f, rgba8, rgb10_a2, r8, r32ui };
enum class Cull { none, front, back };

struct Box {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;

    bool contains(int px, int py) const
    {
        return px >= x && px < x + width && py >= y && py < y + height;
    }
    bool operator==(const Box &) const = default;
};

struct Vertex {
    std::array<float, 4> position; ///< In clip coordinates.
    std::array<float, 4> color;
};

struct Triangle {
    std::uint32_t id; ///< What integer attachments get. Below 2^24.
    std::array<Vertex, 3> vertices;
};

/// One command: a clear, or a draw of some triangles.
struct Step {
    bool clear = false;
    std::optional<Box> scissor;
    bool depth_mask = true;
    Cull cull = Cull::none;
    std::vector<Triangle> triangles;
};

struct Scene {
    Extension extension = Extension::peeling;
    int width = 16;
    int height = 16;
    int samples = 0; ///< 0: not multisampled.
    int k = 4;

    // Of depth peeling. K-buffer programs keep the nearest fragments, those in front of 1.
    Func func = Func::less;
    DepthFormat depth_format = DepthFormat::d32f;
    std::vector<ColorFormat> color_formats{ColorFormat::rgba32f};
    bool all_passes = false; ///< Goes on behind the last layer until nothing is left.
    float clear_depth = 1.0F;

    // Of k-buffer programs.
    EntryLayout layout = EntryLayout::rgbz;

    bool flat = true; ///< Colors are those of the last vertex, else interpolated.
    std::array<bool, 4> color_mask{true, true, true, true};
    Box viewport{0, 0, 16, 16};
    std::array<double, 2> depth_range{0.0, 1.0};
    bool zero_to_one = false; ///< glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE)
    std::vector<Step> steps;  ///< A clear of everything comes before the first.

    int sample_count() const { return samples > 0 ? samples : 1; }
    bool farthest_first() const { return func == Func::greater || func == Func::gequal; }
    std::size_t triangle_count() const;
    bool has_clears() const;
};

/// The alpha of all fragments where the layout keeps none.
inline constexpr float constant_alpha = 0.375F;

/// An error that names what does not fit together. Scenes of any origin have to pass it.
Status check_scene(const Scene &scene);

std::string to_json(const Scene &scene);
Result<Scene> from_json(const std::string &text);
Result<Scene> load_scene(const std::filesystem::path &path);

} // namespace kb::reference
