// SPDX-License-Identifier: MIT

#include "tests/lib/io/gltf_file.hpp"

namespace kb::test
{

using nlohmann::json;

static std::string to_base64(const std::string &bytes)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto byte = [&](std::size_t j) {
            return j < bytes.size() ? unsigned(static_cast<unsigned char>(bytes[j])) : 0U;
        };
        const unsigned group = byte(i) << 16U | byte(i + 1) << 8U | byte(i + 2);
        for (std::size_t j = 0; j < 4; ++j)
            text += i + j <= bytes.size() ? digits[group >> (18U - 6U * j) & 63U] : '=';
    }
    return text;
}

static std::string little_endian(std::uint32_t value)
{
    std::string bytes;
    for (unsigned shift = 0; shift < 32; shift += 8)
        bytes += static_cast<char>(value >> shift & 255U);
    return bytes;
}

GltfFile::GltfFile()
    : document(json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                              "nodes": [{"mesh": 0}], "meshes": [{"primitives": []}],
                              "accessors": [], "bufferViews": []})"))
{
}

int GltfFile::add_view(const void *data, std::size_t count)
{
    bytes.resize((bytes.size() + 3) / 4 * 4);
    document["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", count}});
    bytes.append(static_cast<const char *>(data), count);
    return static_cast<int>(document["bufferViews"].size()) - 1;
}

void GltfFile::add_primitive(const json &primitive)
{
    document["meshes"][0]["primitives"].push_back(primitive);
}

GltfFile GltfFile::square()
{
    GltfFile file;
    const int positions = file.add<float>({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, "VEC3");
    const int indices = file.add<std::uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
    file.add_primitive({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    return file;
}

std::string GltfFile::embedded() const
{
    json whole = document;
    whole["buffers"] =
        json::array({{{"byteLength", bytes.size()},
                      {"uri", "data:application/octet-stream;base64," + to_base64(bytes)}}});
    return whole.dump();
}

std::string GltfFile::beside(const std::string &buffer) const
{
    json whole = document;
    whole["buffers"] = json::array({{{"byteLength", bytes.size()}, {"uri", buffer}}});
    return whole.dump();
}

std::string GltfFile::binary() const
{
    json whole = document;
    whole["buffers"] = json::array({{{"byteLength", bytes.size()}}});
    std::string text = whole.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string buffer = bytes;
    buffer.resize((buffer.size() + 3) / 4 * 4);
    const auto size = [](const std::string &part) {
        return little_endian(static_cast<std::uint32_t>(part.size()));
    };
    const std::string chunks =
        size(text) + "JSON" + text + size(buffer) + std::string("BIN\0", 4) + buffer;
    return "glTF" + little_endian(2) +
           little_endian(static_cast<std::uint32_t>(chunks.size()) + 12) + chunks;
}

} // namespace kb::test
