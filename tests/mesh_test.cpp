// SPDX-License-Identifier: MIT

#include "mesh.hpp"
#include "temp_directory.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace
{

using kb::test::TempDirectory;

const std::string ply_header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                               "property float y\nproperty float z\nelement face 1\n"
                               "property list uchar int vertex_indices\nend_header\n";

const std::string good_ply = ply_header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

kb::Mesh triangle()
{
    kb::Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.normals.assign(3, {0, 0, 1});
    mesh.indices = {0, 1, 2};
    return mesh;
}

TEST(CheckMesh, AcceptsATriangle)
{
    EXPECT_TRUE(kb::check_mesh(triangle()));
}

TEST(CheckMesh, NamesWhatIsWrong)
{
    kb::Mesh mesh = triangle();
    mesh.indices.clear();
    EXPECT_EQ(kb::check_mesh(mesh).error().message, "the mesh has no triangles");

    mesh = triangle();
    mesh.indices[1] = 3;
    EXPECT_EQ(kb::check_mesh(mesh).error().message,
              "index 1 of the mesh is 3, but it has 3 vertices");

    mesh = triangle();
    mesh.positions[2].y = std::nanf("");
    EXPECT_EQ(kb::check_mesh(mesh).error().message, "vertex 2 of the mesh is not finite");

    mesh = triangle();
    mesh.normals[0].x = INFINITY;
    EXPECT_FALSE(kb::check_mesh(mesh));

    mesh = triangle();
    mesh.normals.pop_back();
    EXPECT_FALSE(kb::check_mesh(mesh));

    mesh = triangle();
    mesh.colors.resize(2);
    EXPECT_FALSE(kb::check_mesh(mesh));

    mesh = triangle();
    mesh.indices.push_back(0);
    EXPECT_FALSE(kb::check_mesh(mesh));
}

TEST(LoadMesh, ReadsPlyWithColors)
{
    const TempDirectory directory;
    const auto file = directory.write(
        "colors.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float "
                      "y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty "
                      "uchar blue\nproperty uchar alpha\nelement face 1\nproperty list uchar int "
                      "vertex_indices\nend_header\n0 0 0 255 0 0 51\n1 0 0 0 255 0 102\n1 1 0 0 0 "
                      "255 153\n0 1 0 255 255 255 255\n4 0 1 2 3\n");
    const auto mesh = kb::load_mesh(file);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->triangle_count(), 2U) << "a quad is two triangles";
    ASSERT_EQ(mesh->colors.size(), mesh->positions.size());
    for (std::size_t i = 0; i < mesh->positions.size(); ++i) {
        EXPECT_NEAR(std::abs(mesh->normals[i].z), 1.0F, 1e-6F);
        if (mesh->positions[i] == glm::vec3(1, 1, 0)) {
            EXPECT_NEAR(glm::distance(mesh->colors[i], glm::vec4(0, 0, 1, 0.6F)), 0.0F, 1e-6F);
        }
    }
}

TEST(LoadMesh, KeepsVerticesApartThatDifferInColorOnly)
{
    const TempDirectory directory;
    const auto mesh = kb::load_mesh(directory.write(
        "twice.ply", "ply\nformat ascii 1.0\nelement vertex 9\nproperty float x\nproperty float "
                     "y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty "
                     "uchar blue\nproperty uchar alpha\nelement face 3\nproperty list uchar int "
                     "vertex_indices\nend_header\n"
                     "0 0 0 255 0 0 51\n1 0 0 255 0 0 51\n0 1 0 255 0 0 51\n"
                     "0 0 0 0 255 0 51\n1 0 0 0 255 0 51\n0 1 0 0 255 0 51\n"
                     "0 0 0 255 0 0 51\n1 0 0 255 0 0 51\n0 1 0 255 0 0 51\n"
                     "3 0 1 2\n3 3 4 5\n3 6 7 8\n"));
    ASSERT_TRUE(mesh) << mesh.error().message;
    ASSERT_EQ(mesh->triangle_count(), 3U);
    EXPECT_EQ(mesh->positions.size(), 6U) << "the third triangle is the first one again";
    EXPECT_EQ(mesh->colors[mesh->indices[0]], glm::vec4(1, 0, 0, 0.2F));
    EXPECT_EQ(mesh->colors[mesh->indices[3]], glm::vec4(0, 1, 0, 0.2F));
    EXPECT_EQ(mesh->colors[mesh->indices[6]], glm::vec4(1, 0, 0, 0.2F));
}

TEST(LoadMesh, ReadsObjAndStl)
{
    const TempDirectory directory;
    const auto obj =
        kb::load_mesh(directory.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
    ASSERT_TRUE(obj) << obj.error().message;
    EXPECT_EQ(obj->triangle_count(), 1U);
    const auto stl = kb::load_mesh(directory.write(
        "m.stl", "solid m\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
                 "0\nendloop\nendfacet\nendsolid m\n"));
    ASSERT_TRUE(stl) << stl.error().message;
    EXPECT_EQ(stl->triangle_count(), 1U);
}

/// A glTF file whose buffer holds three positions and three 16-bit indices.
std::string gltf(std::uint16_t last_index, std::size_t buffer_bytes = 42)
{
    const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::uint16_t indices[] = {0, 1, last_index};
    std::string bytes(42, '\0');
    std::memcpy(bytes.data(), positions, 36);
    std::memcpy(bytes.data() + 36, indices, 6);
    bytes.resize(buffer_bytes);

    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string base64;
    for (std::size_t i = 0; i + 2 < bytes.size(); i += 3) {
        const auto byte = [&](std::size_t j) {
            return unsigned(static_cast<unsigned char>(bytes[i + j]));
        };
        const unsigned group = byte(0) << 16U | byte(1) << 8U | byte(2);
        for (const unsigned shift : {18U, 12U, 6U, 0U})
            base64 += digits[group >> shift & 63U];
    }
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
"buffers":[{"byteLength":)" +
           std::to_string(buffer_bytes) + R"(,"uri":"data:application/octet-stream;base64,)" +
           base64 + R"("}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}]})";
}

TEST(LoadMesh, ReadsGltf)
{
    const TempDirectory directory;
    const auto mesh = kb::load_mesh(directory.write("m.gltf", gltf(2)));
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->triangle_count(), 1U);
}

TEST(LoadMesh, RefusesWhatIsMalformed)
{
    const TempDirectory directory;
    const std::string binary_stl = std::string(80, ' ') + std::string("\xff\xff\0\0", 4) + "abc";
    const struct {
        const char *name;
        std::string content;
    } files[] = {
        {"empty.ply", ""},
        {"empty.obj", ""},
        {"empty.stl", ""},
        {"empty.gltf", ""},
        {"cut-header.ply", ply_header.substr(0, 60)},
        {"no-vertices.ply", ply_header},
        {"cut-vertices.ply", ply_header + "0 0 0\n1 0 0\n"},
        {"cut-faces.ply", ply_header + "0 0 0\n1 0 0\n0 1 0\n"},
        {"cut-face.ply", ply_header + "0 0 0\n1 0 0\n0 1 0\n3 0"},
        {"nan.ply", ply_header + "0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n"},
        {"infinite.ply", ply_header + "0 0 0\ninf 0 0\n0 1 0\n3 0 1 2\n"},
        {"index.ply", ply_header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"},
        {"huge-index.ply", ply_header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2000000000\n"},
        {"negative-index.ply", ply_header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"},
        {"index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"},
        {"nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"},
        {"points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"},
        {"lines.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3\n"},
        {"cut.stl", binary_stl},
        {"cut.gltf", gltf(2).substr(0, 300)},
        {"cut-buffer.gltf", gltf(2, 30)},
        {"index.gltf", gltf(3)},
        {"noise.glb", "glTF\x02\0\0\0garbage"},
        {"unknown.xyzzy", "nothing that a reader knows"},
    };
    for (const auto &file : files) {
        SCOPED_TRACE(file.name);
        const auto path = directory.write(file.name, file.content);
        const auto mesh = kb::load_mesh(path);
        EXPECT_FALSE(mesh);
        if (mesh)
            continue;
        EXPECT_EQ(mesh.error().message.find("cannot read the mesh " + path.string() + ": "), 0U)
            << mesh.error().message;
        EXPECT_EQ(mesh.error().message.find('\n'), std::string::npos);
        EXPECT_GT(mesh.error().message.size(), path.string().size() + 25) << "there is a reason";
    }
    EXPECT_FALSE(kb::load_mesh(directory / "no-such-file.ply"));
    EXPECT_FALSE(kb::load_mesh(directory / "."));
    // The test above must not fail for the directory's or the header's sake.
    EXPECT_TRUE(kb::load_mesh(directory.write("good.ply", good_ply)));
}

TEST(FitToUnitSphere, CentersAndScales)
{
    kb::Mesh mesh = triangle();
    for (auto &p : mesh.positions)
        p = 300.0F * p + glm::vec3(7, -100, 5);
    kb::fit_to_unit_sphere(mesh);
    float radius = 0.0F;
    for (const auto &p : mesh.positions)
        radius = std::max(radius, glm::length(p));
    EXPECT_NEAR(radius, 1.0F, 1e-6F);

    kb::Mesh point = triangle();
    point.positions.assign(3, {4, 4, 4});
    kb::fit_to_unit_sphere(point);
    EXPECT_EQ(point.positions[0], glm::vec3(0.0F));
}

TEST(GeneratedMesh, KnotIsSoundAndOfTheWantedSize)
{
    for (const std::size_t triangles : {100U, 1000U, 100000U}) {
        const kb::Mesh mesh = kb::make_knot(triangles);
        EXPECT_TRUE(kb::check_mesh(mesh));
        EXPECT_NEAR(double(mesh.triangle_count()), double(triangles), 0.25 * double(triangles));
    }
}

TEST(GeneratedMesh, NormalsPointAwayFromFaces)
{
    kb::Mesh mesh = kb::make_knot(1000);
    kb::append_sphere(mesh, {1, 2, 3}, 0.5F, glm::vec4(1.0F), 16, 8);
    kb::append_quad(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, glm::vec4(1.0F));
    ASSERT_TRUE(kb::check_mesh(mesh));
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const glm::vec3 a = mesh.positions[mesh.indices[i]];
        const glm::vec3 b = mesh.positions[mesh.indices[i + 1]];
        const glm::vec3 c = mesh.positions[mesh.indices[i + 2]];
        const glm::vec3 face = glm::cross(b - a, c - a);
        if (glm::length(face) > 1e-6F) { // The poles have triangles without area.
            EXPECT_GT(glm::dot(face, mesh.normals[mesh.indices[i + 1]]), 0.0F) << i / 3;
        }
    }
}

} // namespace
