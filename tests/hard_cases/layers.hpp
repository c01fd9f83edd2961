// SPDX-License-Identifier: MIT
//
// Layers as they are in GL's memory, read back bit for bit.

#pragma once

#include "lib/gl/gl_objects.hpp"
#include "lib/scene/camera.hpp"

#include <glm/vec4.hpp>

#include <optional>
#include <span>
#include <vector>

namespace kb::hard
{

struct Fragment {
    double depth; ///< A float, or of an integer format of n bits the code over 2^n - 1.
    float value;
    float alpha;
    float id;

    bool operator==(const Fragment &) const = default;
};

/// The fragments of each sample by rank; the samples of a pixel are `pixels` apart.
using Layers = std::vector<std::vector<Fragment>>;

/// Front to back in fp32, or the other way: the color over black, and the coverage.
struct Composite {
    float color = 0.0F;
    float alpha = 0.0F;

    bool operator==(const Composite &) const = default;
};
Composite composite_front_to_back(std::span<const Fragment> fragments);
Composite composite_back_to_front(std::span<const Fragment> fragments);

/// Reads array textures, one layer and sample at a time.
class LayerReader
{
public:
    LayerReader(const Gl &gl, Size size, int samples);

    /// Of all pixels, from the bottom left one, row by row.
    std::vector<glm::vec4> read_color(const Texture &texture, int layer, int sample) const;
    std::vector<double> read_depth(const Texture &texture, GLenum format, int layer,
                                   int sample) const;

    std::size_t pixels() const;
    int samples() const { return samples_; } ///< At least 1.

private:
    std::vector<glm::vec4> read_floats(const Texture &texture, int layer, int sample) const;

    const Gl &gl_;
    Size size_;
    int samples_;
    Framebuffer framebuffer_;
    /// Copies a sample where it can be read.
    struct SampleCopy {
        Program program;
        Texture texture;
        VertexArray empty;
    };
    std::optional<SampleCopy> copy_;
};

/// 2^n - 1 of a format of n bits, 0 of a format of floats.
double greatest_code(GLenum depth_format);

} // namespace kb::hard
