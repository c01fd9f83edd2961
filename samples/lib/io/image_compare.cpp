// SPDX-License-Identifier: MIT

#include "lib/io/image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kb
{

ImageRgba8 to_rgba8(const ImageRgbaF &image)
{
    ImageRgba8 result(image.width, image.height);
    const auto to_byte = [](float value) {
        const float clamped = value > 0.0F ? std::min(value, 1.0F) : 0.0F;
        return static_cast<std::uint8_t>(std::lround(clamped * 255.0F));
    };
    std::transform(image.pixels.begin(), image.pixels.end(), result.pixels.begin(),
                   [&to_byte](const glm::vec4 &p) {
                       return glm::u8vec4(to_byte(p.x), to_byte(p.y), to_byte(p.z), to_byte(p.w));
                   });
    return result;
}

static double channel_difference(double a, double b)
{
    if (a == b || (std::isnan(a) && std::isnan(b)))
        return 0.0; // Equal infinities would give a NaN below.
    const double difference = std::abs(a - b);
    return std::isnan(difference) ? std::numeric_limits<double>::infinity() : difference;
}

template <class Pixel>
static Result<Difference> compare_images(const Image<Pixel> &a, const Image<Pixel> &b, double unit,
                                         double tolerance)
{
    if (a.width != b.width || a.height != b.height)
        return Error{fmt::format("the images differ in size: {}x{} and {}x{}", a.width, a.height,
                                 b.width, b.height)};
    Difference result;
    double squares = 0.0;
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        double largest = 0.0;
        for (int channel = 0; channel < 4; ++channel) {
            const double d =
                channel_difference(double(a.pixels[i][channel]), double(b.pixels[i][channel])) /
                unit;
            squares += d * d;
            largest = std::max(largest, d);
        }
        result.max = std::max(result.max, largest);
        different += largest > tolerance;
    }
    if (!a.pixels.empty()) {
        const auto count = static_cast<double>(a.pixels.size());
        result.rmse = std::sqrt(squares / (4.0 * count));
        result.share = static_cast<double>(different) / count;
    }
    return result;
}

Result<Difference> compare(const ImageRgbaF &a, const ImageRgbaF &b, double tolerance)
{
    return compare_images(a, b, 1.0, tolerance);
}

Result<Difference> compare(const ImageRgba8 &a, const ImageRgba8 &b, double tolerance)
{
    return compare_images(a, b, 255.0, tolerance);
}

} // namespace kb
