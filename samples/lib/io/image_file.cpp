// SPDX-License-Identifier: MIT

#include "lib/io/image.hpp"
#include "lib/io/output_file.hpp"

#include <fmt/format.h>
#include <png.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <span>
#include <sstream>

namespace kb
{

static_assert(std::endian::native == std::endian::little, "PFM files are written as memory has it");

static Result<std::vector<std::byte>> read_file(const std::filesystem::path &path)
{
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    if (!file || !(text << file.rdbuf()))
        return Error{fmt::format("cannot read {}", path.string())};
    const std::string data = text.str();
    const auto bytes = std::as_bytes(std::span(data));
    return std::vector<std::byte>(bytes.begin(), bytes.end());
}

Status write_png(const std::filesystem::path &path, const ImageRgba8 &image)
{
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = static_cast<png_uint_32>(image.width);
    header.height = static_cast<png_uint_32>(image.height);
    header.format = PNG_FORMAT_RGBA;

    std::vector<std::byte> bytes(PNG_IMAGE_PNG_SIZE_MAX(header));
    png_alloc_size_t size = bytes.size();
    if (!png_image_write_to_memory(&header, bytes.data(), &size, 0, image.pixels.data(), 0,
                                   nullptr))
        return Error{fmt::format("cannot write {}: {}", path.string(), header.message)};
    return write_file(path, std::span(bytes).first(size));
}

Result<ImageRgba8> read_png(const std::filesystem::path &path)
{
    const auto bytes = read_file(path);
    if (!bytes)
        return bytes.error();
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&header, bytes->data(), bytes->size())) {
        header.format = PNG_FORMAT_RGBA;
        ImageRgba8 image(static_cast<int>(header.width), static_cast<int>(header.height));
        if (png_image_finish_read(&header, nullptr, image.pixels.data(), 0, nullptr))
            return image;
    }
    png_image_free(&header);
    return Error{fmt::format("cannot read {}: {}", path.string(), header.message)};
}

static Status write_pfm(const std::filesystem::path &path, int width, int height, int channels,
                        std::span<const float> values)
{
    // A negative scale says little-endian; the first row is the bottom one.
    const std::string header =
        fmt::format("{}\n{} {}\n-1.0\n", channels == 3 ? "PF" : "Pf", width, height);
    const std::size_t row_size = std::size_t(width) * std::size_t(channels);
    std::vector<std::byte> bytes(header.size() + values.size_bytes());
    std::memcpy(bytes.data(), header.data(), header.size());
    std::byte *out = bytes.data() + header.size();
    for (int y = height; y-- > 0; out += row_size * sizeof(float))
        std::memcpy(out, &values[std::size_t(y) * row_size], row_size * sizeof(float));
    return write_file(path, bytes);
}

Status write_pfm(const std::filesystem::path &path, const ImageRgbaF &image)
{
    std::vector<float> values;
    values.reserve(3 * image.pixels.size());
    for (const glm::vec4 &pixel : image.pixels)
        values.insert(values.end(), {pixel.x, pixel.y, pixel.z});
    return write_pfm(path, image.width, image.height, 3, values);
}

Status write_pfm(const std::filesystem::path &path, const ImageF &image)
{
    return write_pfm(path, image.width, image.height, 1, image.pixels);
}

Result<ImageRgbaF> read_pfm(const std::filesystem::path &path)
{
    const auto bytes = read_file(path);
    if (!bytes)
        return bytes.error();
    const Error bad{
        fmt::format("cannot read {}: it is not a little-endian PFM file", path.string())};
    std::istringstream file(
        std::string(reinterpret_cast<const char *>(bytes->data()), bytes->size()));
    std::string kind;
    int width = 0;
    int height = 0;
    float scale = 0.0F;
    if (!(file >> kind >> width >> height >> scale) || (kind != "PF" && kind != "Pf") ||
        width <= 0 || height <= 0 || !(scale < 0.0F))
        return bad;
    const std::size_t channels = kind == "PF" ? 3 : 1;
    const auto start = static_cast<std::size_t>(file.tellg()) + 1;
    const std::size_t count = std::size_t(width) * std::size_t(height);
    if (start > bytes->size() || (bytes->size() - start) / (channels * sizeof(float)) != count)
        return bad;

    ImageRgbaF image(width, height);
    const std::byte *in = bytes->data() + start;
    for (int y = height; y-- > 0;) {
        for (int x = 0; x < width; ++x, in += channels * sizeof(float)) {
            float values[3];
            std::memcpy(values, in, channels * sizeof(float));
            image.at(x, y) = channels == 3 ? glm::vec4(values[0], values[1], values[2], 1.0F)
                                           : glm::vec4(glm::vec3(values[0]), 1.0F);
        }
    }
    return image;
}

} // namespace kb
