// SPDX-License-Identifier: MIT
//
// Pictures in memory (the first row is the top one), PNG and PFM files, comparison.

#pragma once

#include "lib/result.hpp"

#include <glm/gtc/type_precision.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <filesystem>
#include <vector>

namespace kb
{

template <class Pixel>
struct Image {
    int width = 0;
    int height = 0;
    std::vector<Pixel> pixels;

    Image() = default;
    Image(int w, int h) : width(w), height(h), pixels(std::size_t(w) * std::size_t(h)) {}

    Pixel &at(int x, int y) { return pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)]; }
    const Pixel &at(int x, int y) const
    {
        return pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)];
    }
};

using ImageRgba8 = Image<glm::u8vec4>;
using ImageRgbaF = Image<glm::vec4>;
using ImageF = Image<float>;

/// Rounds to the nearest of 256 steps, as GL does; what is not a number becomes 0.
ImageRgba8 to_rgba8(const ImageRgbaF &image);

Status write_png(const std::filesystem::path &path, const ImageRgba8 &image);
Result<ImageRgba8> read_png(const std::filesystem::path &path);

/// Portable float map: the bits of the floats are kept. Color images lose their alpha and get 1.
Status write_pfm(const std::filesystem::path &path, const ImageRgbaF &image);
Status write_pfm(const std::filesystem::path &path, const ImageF &image);
Result<ImageRgbaF> read_pfm(const std::filesystem::path &path);

struct Difference {
    double max = 0.0;  ///< Largest difference of a channel.
    double rmse = 0.0; ///< Root of the mean square of all channels' differences.
    double share =
        0.0; ///< Part of the pixels in which a channel differs by more than the tolerance.
};

/// Images of different sizes are an error. A channel that is a NaN in one image only differs
/// infinitely. Eight-bit channels count as 0 to 1.
Result<Difference> compare(const ImageRgbaF &a, const ImageRgbaF &b, double tolerance = 0.0);
Result<Difference> compare(const ImageRgba8 &a, const ImageRgba8 &b, double tolerance = 0.0);

} // namespace kb
