// SPDX-License-Identifier: MIT

#include "file.hpp"
#include "mesh.hpp"

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <sstream>

namespace kb
{

/// What Assimp does not notice about PLY files. It would read the end of a header that is cut off
/// forever, and take what is missing of a last line for zeros.
static Status check_ply(std::ifstream &file)
{
    bool ascii = false;
    bool last_is_list = false;
    std::size_t expected = 0;
    std::string line;
    do {
        if (!std::getline(file, line))
            return Error{"its header has no end"};
        std::istringstream words(line);
        std::string keyword;
        std::string name;
        std::size_t count = 0;
        words >> keyword >> name >> count;
        if (keyword == "format")
            ascii = name == "ascii";
        else if (keyword == "element")
            expected += count;
        else if (keyword == "property")
            last_is_list = name == "list";
    } while (!line.starts_with("end_header"));
    if (!ascii)
        return ok;

    std::size_t found = 0;
    std::string last;
    while (std::getline(file, line)) {
        if (line.find_first_not_of(" \t\r") != std::string::npos) {
            ++found;
            last.swap(line);
        }
    }
    std::istringstream words(last);
    std::ptrdiff_t list_size = 0;
    if (last_is_list && words >> list_size)
        found -= std::distance(std::istream_iterator<std::string>(words), {}) < list_size;
    if (found < expected)
        return Error{"it ends early"};
    return ok;
}

static Status check_file(const std::filesystem::path &path)
{
    auto file = open_file(path);
    if (!file)
        return file.error();
    std::string line;
    if (!std::getline(*file, line))
        return Error{"it is empty"};
    return line.starts_with("ply") ? check_ply(*file) : Status(ok);
}

/// What Assimp's own processing would trip over: it trusts the faces of the file.
static Status check_raw_mesh(const aiMesh &mesh)
{
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
        const aiVector3D &p = mesh.mVertices[i];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            return Error{fmt::format("vertex {} is not finite", i)};
    }
    if (mesh.mNumFaces == 0)
        return Error{"it has no triangles"};
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
        const aiFace &face = mesh.mFaces[i];
        if (face.mNumIndices == 0)
            return Error{fmt::format("face {} has no vertices", i)};
        for (const unsigned index : std::span(face.mIndices, face.mNumIndices)) {
            if (index >= mesh.mNumVertices)
                return Error{fmt::format("face {} has index {}, but there are {} vertices", i,
                                         index, mesh.mNumVertices)};
        }
    }
    return ok;
}

static glm::vec3 to_vec3(const aiVector3D &v)
{
    return {v.x, v.y, v.z};
}

static void append(Mesh &mesh, const aiMesh &part)
{
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
        mesh.positions.push_back(to_vec3(part.mVertices[i]));
        // A vertex of degenerate triangles alone has no direction: any will do.
        const aiVector3D normal = part.HasNormals() ? part.mNormals[i] : aiVector3D(0, 0, 1);
        mesh.normals.push_back(std::isfinite(normal.SquareLength()) ? to_vec3(normal)
                                                                    : glm::vec3(0, 0, 1));
    }
    if (part.HasVertexColors(0)) {
        mesh.colors.resize(first, glm::vec4(1.0F));
        for (unsigned i = 0; i < part.mNumVertices; ++i) {
            const aiColor4D &c = part.mColors[0][i];
            mesh.colors.emplace_back(c.r, c.g, c.b, c.a);
        }
    } else if (!mesh.colors.empty()) {
        mesh.colors.resize(mesh.positions.size(), glm::vec4(1.0F));
    }
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
        const aiFace &face = part.mFaces[i];
        if (face.mNumIndices == 3)
            for (const unsigned index : std::span(face.mIndices, 3))
                mesh.indices.push_back(first + index);
    }
}

Result<Mesh> load_mesh(const std::filesystem::path &path)
{
    const auto fail = [&path](const std::string &reason) {
        std::string line = reason.substr(0, reason.find_first_of("\r\n"));
        return Error{fmt::format("cannot read the mesh {}: {}", path.string(), line)};
    };

    if (auto checked = check_file(path); !checked)
        return fail(checked.error().message);
    Assimp::Importer importer;
    const aiScene *scene = importer.ReadFile(path.string(), 0);
    if (!scene)
        return fail(importer.GetErrorString());
    for (const aiMesh *part : std::span(scene->mMeshes, scene->mNumMeshes)) {
        if (auto checked = check_raw_mesh(*part); !checked)
            return fail(checked.error().message);
    }

    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                                aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    scene =
        importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_SortByPType |
                                     aiProcess_PreTransformVertices | aiProcess_GenSmoothNormals);
    if (!scene)
        return fail("it has no triangles");

    Mesh mesh;
    for (const aiMesh *part : std::span(scene->mMeshes, scene->mNumMeshes))
        append(mesh, *part);
    if (auto checked = check_mesh(mesh); !checked)
        return fail(checked.error().message);
    join_identical_vertices(mesh); // Not by Assimp, which forgets to look at colors.
    return mesh;
}

} // namespace kb
