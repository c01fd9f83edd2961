// SPDX-License-Identifier: MIT

#include "lib/io/gltf_document.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <string>

namespace kb
{

namespace
{

using nlohmann::json;

struct Type {
    const char *name;
    bool (*has)(const json &value);
};

bool is_list_of(const json &value, bool (*has)(const json &element))
{
    return value.is_array() && std::all_of(value.begin(), value.end(), has);
}

bool is_index(const json &value)
{
    return value.is_number_unsigned();
}

constexpr Type index{"no integer from 0 on", is_index};
constexpr Type truth{"neither true nor false", [](const json &v) { return v.is_boolean(); }};
constexpr Type word{"no string", [](const json &v) { return v.is_string(); }};
constexpr Type object{"no object", [](const json &v) { return v.is_object(); }};
constexpr Type indices{"no list of integers from 0 on",
                       [](const json &v) { return is_list_of(v, is_index); }};
constexpr Type numbers{"no list of numbers", [](const json &v) {
                           return is_list_of(v, [](const json &n) { return n.is_number(); });
                       }};
constexpr Type objects{"no list of objects", [](const json &v) {
                           return is_list_of(v, [](const json &o) { return o.is_object(); });
                       }};

/// A property of each object that `path` leads to from the document; lists on the way are gone
/// through.
struct Property {
    const char *path;
    const char *name;
    Type type;
};

// Objects come before what is in them.
constexpr std::array properties{
    Property{"", "scene", index},
    Property{"", "scenes", objects},
    Property{"scenes", "nodes", indices},
    Property{"", "nodes", objects},
    Property{"nodes", "children", indices},
    Property{"nodes", "mesh", index},
    Property{"nodes", "skin", index},
    Property{"nodes", "matrix", numbers},
    Property{"nodes", "translation", numbers},
    Property{"nodes", "rotation", numbers},
    Property{"nodes", "scale", numbers},
    Property{"", "meshes", objects},
    Property{"meshes", "primitives", objects},
    Property{"meshes/primitives", "attributes", object},
    Property{"meshes/primitives", "indices", index},
    Property{"meshes/primitives", "material", index},
    Property{"meshes/primitives", "mode", index},
    Property{"meshes/primitives", "targets", objects},
    Property{"", "materials", objects},
    Property{"materials", "alphaMode", word},
    Property{"materials", "pbrMetallicRoughness", object},
    Property{"materials/pbrMetallicRoughness", "baseColorFactor", numbers},
    Property{"materials/pbrMetallicRoughness", "baseColorTexture", object},
    Property{"", "accessors", objects},
    Property{"accessors", "bufferView", index},
    Property{"accessors", "byteOffset", index},
    Property{"accessors", "normalized", truth},
    Property{"accessors", "sparse", object},
    Property{"accessors/sparse", "count", index},
    Property{"accessors/sparse", "indices", object},
    Property{"accessors/sparse/indices", "bufferView", index},
    Property{"accessors/sparse/indices", "byteOffset", index},
    Property{"accessors/sparse", "values", object},
    Property{"accessors/sparse/values", "bufferView", index},
    Property{"accessors/sparse/values", "byteOffset", index},
    Property{"", "bufferViews", objects},
    Property{"bufferViews", "byteOffset", index},
    Property{"bufferViews", "byteStride", index},
    Property{"", "extensionsRequired",
             Type{"no list of strings",
                  [](const json &v) {
                      return is_list_of(v, [](const json &s) { return s.is_string(); });
                  }}},
};

/// `where` names the object in messages.
Status check(const json &value, std::string_view path, const Property &property,
             const std::string &where)
{
    if (value.is_array()) {
        for (std::size_t i = 0; i < value.size(); ++i) {
            if (auto checked = check(value[i], path, property, fmt::format("{}[{}]", where, i));
                !checked)
                return checked;
        }
        return ok;
    }
    const std::size_t end = path.find('/');
    const std::string name(path.empty() ? property.name : path.substr(0, end));
    const auto found = value.find(name);
    if (found == value.end())
        return ok;
    const std::string place = where.empty() ? name : where + '.' + name;
    if (!path.empty())
        return check(*found, end == path.npos ? std::string_view() : path.substr(end + 1), property,
                     place);
    if (!property.type.has(*found))
        return Error{fmt::format("{} is {}", place, property.type.name)};
    return ok;
}

/// Each node has its transform in one of the two forms. Its properties have the right types.
Status check_transforms(const json &document)
{
    const json nodes = document.value("nodes", json::array());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        for (const char *other : {"translation", "rotation", "scale"}) {
            if (nodes[i].contains("matrix") && nodes[i].contains(other))
                return Error{fmt::format("nodes[{}] has a matrix and a {}", i, other)};
        }
    }
    return ok;
}

} // namespace

Status check_gltf_document(std::string_view text)
{
    const json document = json::parse(text, nullptr, false);
    if (!document.is_object())
        return ok;
    for (const Property &property : properties) {
        if (auto checked = check(document, property.path, property, ""); !checked)
            return checked;
    }
    return check_transforms(document);
}

} // namespace kb
