// SPDX-License-Identifier: MIT
//
// glTF 2.0. tinygltf reads the document and its buffers; what a mesh looks like is made here: it
// neither follows accessors nor nodes, nor looks at required extensions.

#include "lib/io/gltf_accessor.hpp"
#include "lib/io/gltf_document.hpp"
#include "lib/io/little_endian.hpp"
#include "lib/io/mesh_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

namespace kb
{

namespace
{

bool is_binary(std::string_view content)
{
    return content.starts_with("glTF");
}

/// tinygltf looks for the end of the chunks some bytes too far on.
Status check_chunks(std::string_view content)
{
    const auto word = [content](std::size_t place) {
        return read_little_endian<std::uint32_t>(content.data() + place);
    };
    if (content.size() < 20)
        return Error{"it ends early"};
    if (word(4) != 2)
        return Error{fmt::format("it is glTF version {}, not 2", word(4))};
    const std::uint64_t length = word(8);
    if (length > content.size())
        return Error{fmt::format("it ends early: it has {} of {} bytes", content.size(), length)};
    for (std::uint64_t place = 12; place < length;) {
        if (length - place < 8 || length - place - 8 < word(place))
            return Error{"its chunks are longer than the file"};
        place += 8 + std::uint64_t(word(place));
    }
    return ok;
}

/// Any other that is required changes what the file means.
Status check_extensions(const tinygltf::Model &model)
{
    for (const std::string &name : model.extensionsRequired) {
        if (name != "KHR_mesh_quantization")
            return Error{fmt::format("it requires the extension {}, which is not read", name)};
    }
    return ok;
}

/// The document: of a binary file (whose chunks are checked) its first chunk.
std::string_view document_of(std::string_view content)
{
    if (!is_binary(content))
        return content;
    return content.substr(20, read_little_endian<std::uint32_t>(content.data() + 12));
}

Result<tinygltf::Model> parse(std::string_view content, const std::filesystem::path &directory)
{
    tinygltf::Model model;
    tinygltf::TinyGLTF loader;
    // Textures are left out: no picture is decoded.
    loader.SetImageLoader([](tinygltf::Image *, int, std::string *, std::string *, int, int,
                             const unsigned char *, int, void *) { return true; },
                          nullptr);
    std::string error;
    std::string warning;
    const auto size = static_cast<unsigned>(content.size());
    if (content.size() != size)
        return Error{"it is larger than 4 GiB"};
    bool read = false;
    try {
        read = is_binary(content)
                   ? loader.LoadBinaryFromMemory(
                         &model, &error, &warning,
                         reinterpret_cast<const unsigned char *>(content.data()), size,
                         directory.string())
                   : loader.LoadASCIIFromString(&model, &error, &warning, content.data(), size,
                                                directory.string());
    } catch (const std::exception &exception) {
        error = exception.what();
    }
    // First, as what an extension does may be why it cannot be read.
    if (auto known = check_extensions(model); !known)
        return known.error();
    if (!read)
        return Error{error.empty() ? "it is malformed" : error.substr(0, 200)};
    if (!model.asset.version.starts_with("2."))
        return Error{fmt::format("it is glTF version {}, not 2", model.asset.version)};
    if (!model.asset.minVersion.empty() && model.asset.minVersion != "2.0")
        return Error{fmt::format("it needs a reader of glTF version {}; this one is of 2.0",
                                 model.asset.minVersion)};
    return model;
}

Result<glm::dmat4> transform_of(const tinygltf::Node &node)
{
    const auto fits = [](const std::vector<double> &values, std::size_t count) {
        return (values.empty() || values.size() == count) &&
               std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    };
    if (!fits(node.matrix, 16) || !fits(node.translation, 3) || !fits(node.rotation, 4) ||
        !fits(node.scale, 3))
        return Error{"its transform is malformed"};
    if (!node.matrix.empty())
        return glm::dmat4(glm::make_mat4(node.matrix.data()));

    glm::dmat4 transform(1.0);
    if (!node.translation.empty())
        transform[3] = glm::dvec4(glm::make_vec3(node.translation.data()), 1.0);
    if (!node.rotation.empty()) {
        const auto &r = node.rotation;
        const glm::dquat rotation(r[3], r[0], r[1], r[2]);
        // Of unit length but for the rounding of whoever wrote it.
        if (!(std::abs(glm::length(rotation) - 1.0) < 0.01))
            return Error{"its rotation is no unit quaternion"};
        transform *= glm::mat4_cast(glm::normalize(rotation));
    }
    if (!node.scale.empty())
        for (int i = 0; i < 3; ++i)
            transform[i] *= node.scale[static_cast<std::size_t>(i)];
    return transform;
}

/// Turns normals as the transform turns planes, mirrored and flattened ones too.
glm::dmat3 normal_transform(const glm::dmat4 &transform)
{
    const glm::dmat3 m(transform);
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

/// The triangles of a primitive, as indices of its vertices.
std::vector<std::uint32_t> triangles_of(int mode, const std::vector<std::uint32_t> &indices)
{
    std::vector<std::uint32_t> triangles;
    if (mode == TINYGLTF_MODE_TRIANGLES)
        return indices;
    for (std::size_t i = 2; i < indices.size(); ++i) {
        std::uint32_t a = mode == TINYGLTF_MODE_TRIANGLE_FAN ? indices[0] : indices[i - 2];
        std::uint32_t b = indices[i - 1];
        const std::uint32_t c = indices[i];
        if (mode == TINYGLTF_MODE_TRIANGLE_STRIP && i % 2 == 1)
            std::swap(a, b);
        if (a != b && b != c && c != a)
            triangles.insert(triangles.end(), {a, b, c});
    }
    return triangles;
}

class Reader
{
public:
    explicit Reader(const tinygltf::Model &model) : model_(model), is_visited_(model.nodes.size())
    {
    }

    Status read()
    {
        std::vector<int> roots;
        if (auto found = find_roots(); found)
            roots = *found;
        else
            return found.error();
        for (const int root : roots)
            nodes_.push_back({root, glm::dmat4(1.0)});
        while (!nodes_.empty()) {
            const Placed placed = nodes_.back();
            nodes_.pop_back();
            if (auto read = read_node(placed); !read)
                return Error{fmt::format("node {}: {}", placed.node, read.error().message)};
        }
        return ok;
    }

    FileMesh finish(bool binary) &&
    {
        mesh_.format = binary ? "binary glTF" : "glTF";
        if (!has_colors_)
            mesh_.colors.clear();
        else
            mesh_.colors_of = has_vertex_colors_ ? "vertices" : "materials";
        if (!has_normals_)
            mesh_.normals.clear();
        note_extensions();
        for (const std::string &what : left_out_)
            mesh_.notes.push_back(what + " are left out");
        return std::move(mesh_);
    }

private:
    struct Placed {
        int node;
        glm::dmat4 parent; ///< The transform of its parent.
    };

    /// Of the scene; without scenes all nodes that no other has.
    Result<std::vector<int>> find_roots()
    {
        if (!model_.scenes.empty()) {
            const int scene = std::max(model_.defaultScene, 0);
            if (static_cast<std::size_t>(scene) >= model_.scenes.size())
                return Error{fmt::format("there is no scene {}", scene)};
            if (model_.scenes.size() > 1)
                left_out_.insert("other scenes");
            return model_.scenes[static_cast<std::size_t>(scene)].nodes;
        }
        std::set<int> children;
        for (const tinygltf::Node &node : model_.nodes)
            children.insert(node.children.begin(), node.children.end());
        std::vector<int> roots;
        for (int i = 0; i < static_cast<int>(model_.nodes.size()); ++i) {
            if (!children.contains(i))
                roots.push_back(i);
        }
        return roots;
    }

    Status read_node(const Placed &placed)
    {
        if (placed.node < 0 || static_cast<std::size_t>(placed.node) >= model_.nodes.size())
            return Error{"there is none"};
        const auto index = static_cast<std::size_t>(placed.node);
        if (is_visited_[index])
            return Error{"it is the child of two nodes, or of itself"};
        is_visited_[index] = true;

        const tinygltf::Node &node = model_.nodes[index];
        const auto own = transform_of(node);
        if (!own)
            return own.error();
        const glm::dmat4 transform = placed.parent * *own;
        // The stack gives them back in their order.
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
            nodes_.push_back({*child, transform});
        if (node.mesh < 0)
            return ok;
        if (static_cast<std::size_t>(node.mesh) >= model_.meshes.size())
            return Error{fmt::format("there is no mesh {}", node.mesh)};
        if (node.skin >= 0)
            left_out_.insert("skins (it is drawn as if it had none)");
        const auto &primitives = model_.meshes[static_cast<std::size_t>(node.mesh)].primitives;
        for (std::size_t i = 0; i < primitives.size(); ++i) {
            if (auto read = read_primitive(primitives[i], transform); !read)
                return Error{
                    fmt::format("mesh {}, primitive {}: {}", node.mesh, i, read.error().message)};
        }
        return ok;
    }

    Status read_primitive(const tinygltf::Primitive &primitive, const glm::dmat4 &transform)
    {
        const int mode = primitive.mode;
        if (mode < TINYGLTF_MODE_POINTS || mode > TINYGLTF_MODE_TRIANGLE_FAN)
            return Error{fmt::format("there is no mode {}", mode)};
        if (mode < TINYGLTF_MODE_TRIANGLES) {
            left_out_.insert(mode == TINYGLTF_MODE_POINTS ? "points" : "lines");
            return ok;
        }
        if (!primitive.targets.empty())
            left_out_.insert("morph targets");

        const auto positions = read_attribute(primitive, "POSITION", {3, 3});
        if (!positions)
            return positions.error();
        if (!*positions)
            return Error{"it has no positions"};
        const std::size_t count = (*positions)->count;
        const auto normals = read_attribute(primitive, "NORMAL", {3, 3}, count);
        if (!normals)
            return normals.error();
        const auto colors = read_colors(primitive, count);
        if (!colors)
            return colors.error();
        const auto indices = read_indices(primitive, count);
        if (!indices)
            return indices.error();
        if (mode == TINYGLTF_MODE_TRIANGLES && indices->size() % 3 != 0)
            return Error{fmt::format("its {} indices make no triangles", indices->size())};
        const std::vector<std::uint32_t> triangles = triangles_of(mode, *indices);
        const std::size_t added = *normals ? count : triangles.size();
        if (added > std::numeric_limits<std::uint32_t>::max() - mesh_.positions.size())
            return Error{"there are too many vertices"};

        const glm::dmat3 turned = normal_transform(transform);
        const auto add = [&](std::uint32_t vertex, const glm::vec3 &normal) {
            const double *p = &(*positions)->values[3 * std::size_t(vertex)];
            mesh_.positions.emplace_back(transform * glm::dvec4(p[0], p[1], p[2], 1.0));
            mesh_.normals.push_back(normal);
            mesh_.colors.push_back((*colors)[vertex]);
        };
        const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
        if (*normals) {
            has_normals_ = true;
            for (std::uint32_t i = 0; i < count; ++i) {
                const glm::dvec3 n =
                    turned * glm::make_vec3(&(*normals)->values[3 * std::size_t(i)]);
                const double length = glm::length(n);
                add(i, length > 0.0 ? glm::vec3(n / length) : glm::vec3(0.0F));
            }
            for (const std::uint32_t index : triangles)
                mesh_.indices.push_back(first + index);
        } else {
            add_flat(triangles, add);
        }
        return ok;
    }

    /// Each triangle gets vertices of its own, with the normal of its plane.
    template <class Add>
    void add_flat(const std::vector<std::uint32_t> &triangles, Add &&add)
    {
        has_normals_ = true;
        for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
            const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
            for (std::uint32_t corner = 0; corner < 3; ++corner) {
                add(triangles[i + corner], glm::vec3(0.0F));
                mesh_.indices.push_back(first + corner);
            }
            const glm::dvec3 *p = &mesh_.positions[first];
            const glm::dvec3 u = p[1] - p[0];
            const glm::dvec3 v = p[2] - p[0];
            const double size = std::max(glm::length(u), glm::length(v));
            const glm::dvec3 normal = glm::cross(u / size, v / size);
            const double length = glm::length(normal);
            if (std::isfinite(length) && length > 0.0)
                std::fill_n(mesh_.normals.end() - 3, 3, glm::vec3(normal / length));
        }
    }

    struct Components {
        std::size_t least;
        std::size_t most;
    };

    /// None if the primitive has no such attribute. A count of 0: any.
    Result<std::optional<AccessorValues>> read_attribute(const tinygltf::Primitive &primitive,
                                                         const std::string &name,
                                                         Components components,
                                                         std::size_t count = 0)
    {
        const auto attribute = primitive.attributes.find(name);
        if (attribute == primitive.attributes.end())
            return std::optional<AccessorValues>{};
        auto values = read_accessor(model_, attribute->second);
        if (!values)
            return Error{fmt::format("{}: {}", name, values.error().message)};
        if (values->components < components.least || values->components > components.most)
            return Error{fmt::format("{} has {} components", name, values->components)};
        if (count > 0 && values->count != count)
            return Error{
                fmt::format("{} has {} elements for {} vertices", name, values->count, count)};
        return std::optional(*std::move(values));
    }

    /// Of the vertices, each times that of the material.
    Result<std::vector<glm::vec4>> read_colors(const tinygltf::Primitive &primitive,
                                               std::size_t count)
    {
        const auto values = read_attribute(primitive, "COLOR_0", {3, 4}, count);
        if (!values)
            return values.error();
        const auto material = read_material(primitive.material);
        if (!material)
            return material.error();
        std::vector<glm::vec4> colors(count, material->factor);
        if (*values) {
            has_colors_ = true;
            has_vertex_colors_ = true;
            for (std::size_t i = 0; i < count; ++i)
                for (std::size_t c = 0; c < (*values)->components; ++c)
                    colors[i][static_cast<int>(c)] *=
                        static_cast<float>((*values)->values[i * (*values)->components + c]);
        }
        if (material->is_opaque)
            for (glm::vec4 &color : colors)
                color.a = 1.0F;
        return colors;
    }

    struct Material {
        glm::vec4 factor = glm::vec4(1.0F);
        bool is_opaque = false; ///< Its alphas have no meaning.
    };

    /// Without a material the alphas of vertices count.
    Result<Material> read_material(int index)
    {
        if (index < 0)
            return Material{};
        if (static_cast<std::size_t>(index) >= model_.materials.size())
            return Error{fmt::format("there is no material {}", index)};
        const tinygltf::Material &material = model_.materials[static_cast<std::size_t>(index)];
        has_colors_ = true;
        if (material.pbrMetallicRoughness.baseColorTexture.index >= 0)
            left_out_.insert("textures");
        if (material.alphaMode == "MASK")
            left_out_.insert("masks (what they cut out is drawn)");
        const auto &factor = material.pbrMetallicRoughness.baseColorFactor;
        if (factor.size() != 4)
            return Error{
                fmt::format("material {} has a color of {} numbers", index, factor.size())};
        return Material{glm::vec4(factor[0], factor[1], factor[2], factor[3]),
                        material.alphaMode != "BLEND"};
    }

    /// Without indices vertices come in their order.
    Result<std::vector<std::uint32_t>> read_indices(const tinygltf::Primitive &primitive,
                                                    std::size_t vertices)
    {
        std::vector<std::uint32_t> indices;
        if (primitive.indices < 0) {
            for (std::size_t i = 0; i < vertices; ++i)
                indices.push_back(static_cast<std::uint32_t>(i));
            return indices;
        }
        const auto values = read_accessor(model_, primitive.indices);
        if (!values)
            return Error{fmt::format("indices: {}", values.error().message)};
        const int type =
            model_.accessors[static_cast<std::size_t>(primitive.indices)].componentType;
        if (values->components != 1 || (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
                                        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
                                        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT))
            return Error{"its indices are no unsigned integers"};
        for (const double value : values->values) {
            if (!(value < static_cast<double>(vertices)))
                return Error{
                    fmt::format("it has index {}, but there are {} vertices", value, vertices)};
            indices.push_back(static_cast<std::uint32_t>(value));
        }
        return indices;
    }

    void note_extensions()
    {
        std::set<std::string> others(model_.extensionsUsed.begin(), model_.extensionsUsed.end());
        others.erase("KHR_mesh_quantization");
        if (!others.empty())
            mesh_.notes.push_back(
                fmt::format("its extensions {} are left out", fmt::join(others, ", ")));
    }

    const tinygltf::Model &model_;
    std::vector<bool> is_visited_;
    std::vector<Placed> nodes_;      ///< Still to be read.
    std::set<std::string> left_out_; ///< Plural nouns.
    bool has_colors_ = false;
    bool has_vertex_colors_ = false;
    bool has_normals_ = false;
    FileMesh mesh_;
};

} // namespace

Result<FileMesh> read_gltf(std::string_view content, const std::filesystem::path &directory)
{
    if (is_binary(content)) {
        if (auto checked = check_chunks(content); !checked)
            return checked.error();
    }
    if (auto checked = check_gltf_document(document_of(content)); !checked)
        return checked.error();
    const auto model = parse(content, directory);
    if (!model)
        return model.error();
    Reader reader(*model);
    if (auto read = reader.read(); !read)
        return read.error();
    return std::move(reader).finish(is_binary(content));
}

} // namespace kb
