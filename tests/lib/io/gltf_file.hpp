// SPDX-License-Identifier: MIT
//
// Small glTF files for tests.

#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace kb::test
{

/// A document with one scene of one node of one mesh, to be filled and changed.
class GltfFile
{
public:
    GltfFile();

    /// Appends values to the buffer and makes an accessor of them; its number. `more` is added to
    /// the accessor.
    template <class T>
    int add(const std::vector<T> &values, const std::string &type,
            const nlohmann::json &more = nlohmann::json::object())
    {
        const int view = add_view(values.data(), values.size() * sizeof(T));
        const std::size_t components = type == "SCALAR" ? 1 : std::size_t(type[3] - '0');
        nlohmann::json accessor{{"bufferView", view},
                                {"componentType", component_type(T{})},
                                {"count", values.size() / components},
                                {"type", type}};
        accessor.update(more);
        document["accessors"].push_back(accessor);
        return static_cast<int>(document["accessors"].size()) - 1;
    }

    /// A part of the buffer; its number.
    int add_view(const void *bytes, std::size_t count);

    /// Adds a primitive to the mesh.
    void add_primitive(const nlohmann::json &primitive);

    /// A square from -1 to 1 in the plane z = 0: four vertices and two triangles.
    static GltfFile square();

    std::string embedded() const;                        ///< As JSON, with the buffer in it.
    std::string beside(const std::string &buffer) const; ///< As JSON, the buffer is in that file.
    std::string binary() const;                          ///< As .glb.

    nlohmann::json document;
    std::string bytes;

private:
    static int component_type(std::int8_t) { return 5120; }
    static int component_type(std::uint8_t) { return 5121; }
    static int component_type(std::int16_t) { return 5122; }
    static int component_type(std::uint16_t) { return 5123; }
    static int component_type(std::uint32_t) { return 5125; }
    static int component_type(float) { return 5126; }
};

} // namespace kb::test
