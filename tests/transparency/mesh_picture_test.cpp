// SPDX-License-Identifier: MIT
//
// What users see of their mesh files, and what the samples say about them.

#include "lib/io/image.hpp"
#include "tests/lib/io/gltf_file.hpp"
#include "tests/support/process.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temp_directory.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstring>
#include <fstream>

namespace
{

using namespace kb::test;
using nlohmann::json;

constexpr int side = 64;
const std::string faces = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
const std::string tetrahedron = "v 0 0 0\nv 1.2 0 0\nv 0 1.2 0\nv 0 0 1.2\n" + faces;

class MeshFiles : public testing::Test
{
protected:
    ProcessResult draw(const std::string &program, const std::vector<std::string> &arguments) const
    {
        std::vector<std::string> command{program, "--size", fmt::format("{0}x{0}", side), "--out",
                                         directory_ / "picture.png"};
        command.insert(command.end(), arguments.begin(), arguments.end());
        return run(command, mesa_environment(patched_prefix()));
    }

    /// The picture of a file of that name and content.
    kb::ImageRgba8 picture(const std::string &name, const std::string &content,
                           const std::vector<std::string> &more = {}) const
    {
        std::vector<std::string> arguments{"--mesh", directory_.write(name, content)};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const auto result = draw(KBUFFER_TRANSPARENCY, arguments);
        EXPECT_EQ(result.status, 0) << result.err;
        auto image = kb::read_png(directory_ / "picture.png");
        EXPECT_TRUE(image);
        return image ? *image : kb::ImageRgba8(1, 1);
    }

    json report(const std::string &program, const std::vector<std::string> &arguments) const
    {
        const std::filesystem::path file = directory_ / "report.json";
        std::vector<std::string> all{"--json", file};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const auto result = draw(program, all);
        EXPECT_EQ(result.status, 0) << result.err;
        std::ifstream stream(file);
        return json::parse(stream, nullptr, false);
    }

    TempDirectory directory_;
};

/// Another set of floats may move an edge; nothing else differs.
void expect_same(const kb::ImageRgba8 &a, const kb::ImageRgba8 &b)
{
    ASSERT_EQ(a.pixels.size(), b.pixels.size());
    int seen = 0;
    int others = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        int difference = 0;
        for (int c = 0; c < 4; ++c)
            difference = std::max(difference, std::abs(int(a.pixels[i][c]) - int(b.pixels[i][c])));
        others += difference > 2;
        seen += a.pixels[i] != glm::u8vec4(255);
    }
    EXPECT_LE(others, side * side / 100);
    EXPECT_GT(seen, side * side / 20) << "there is something to be seen";
}

std::string ply(const std::string &face_properties, const std::string &face_values)
{
    std::string text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
                       "property float y\nproperty float z\nelement face 4\n" +
                       face_properties +
                       "property list uchar int vertex_indices\nend_header\n"
                       "0 0 0\n1.2 0 0\n0 1.2 0\n0 0 1.2\n";
    for (const char *corners : {"0 2 1", "0 1 3", "1 2 3", "0 3 2"})
        text += face_values + "3 " + corners + "\n";
    return text;
}

std::string stl(bool zero_normals)
{
    const glm::vec3 points[] = {{0, 0, 0}, {1.2F, 0, 0}, {0, 1.2F, 0}, {0, 0, 1.2F}};
    const float s = std::sqrt(1.0F / 3.0F);
    const struct {
        glm::vec3 normal;
        std::array<int, 3> corners;
    } facets[] = {{{0, 0, -1}, {0, 2, 1}},
                  {{0, -1, 0}, {0, 1, 3}},
                  {{s, s, s}, {1, 2, 3}},
                  {{-1, 0, 0}, {0, 3, 2}}};
    std::string bytes(80, ' ');
    bytes.append("\4\0\0\0", 4);
    for (const auto &facet : facets) {
        const glm::vec3 normal = zero_normals ? glm::vec3(0.0F) : facet.normal;
        bytes.append(reinterpret_cast<const char *>(&normal), 12);
        for (const int corner : facet.corners)
            bytes.append(reinterpret_cast<const char *>(&points[corner]), 12);
        bytes.append(2, '\0');
    }
    return bytes;
}

TEST_F(MeshFiles, FarFromTheOriginTheyLookAsNearIt)
{
    const std::string far = "v 615850.0 5846925.0 758.0\nv 615851.2 5846925.0 758.0\n"
                            "v 615850.0 5846926.2 758.0\nv 615850.0 5846925.0 759.2\n";
    expect_same(picture("near.obj", tetrahedron), picture("far.obj", far + faces));
}

TEST_F(MeshFiles, PropertiesBeforeTheListOfAFaceChangeNothing)
{
    expect_same(picture("m.obj", tetrahedron), picture("plain.ply", ply("", "")));
    expect_same(picture("plain.ply", ply("", "")),
                picture("first.ply", ply("property uchar intensity\n", "255 ")));
}

TEST_F(MeshFiles, StlFilesWithoutNormalsAreLitAndTailsChangeNothing)
{
    const auto plain = picture("plain.stl", stl(false), {"--alpha", "1"});
    expect_same(plain, picture("zero.stl", stl(true), {"--alpha", "1"}));
    expect_same(plain, picture("tail.stl", stl(false) + "\r\n", {"--alpha", "1"}));
}

TEST_F(MeshFiles, QuantizedGltfLooksAsPlainOne)
{
    GltfFile quantized = GltfFile::square();
    quantized.document["extensionsRequired"] = {"KHR_mesh_quantization"};
    const int positions = quantized.add<std::int16_t>(
        {-16384, -16384, 0, 0, 16384, -16384, 0, 0, 16384, 16384, 0, 0, -16384, 16384, 0, 0},
        "VEC4", {{"normalized", true}});
    quantized.document["accessors"][std::size_t(positions)]["type"] = "VEC3";
    quantized.document["bufferViews"].back()["byteStride"] = 8;
    quantized.document["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = positions;
    expect_same(picture("plain.gltf", GltfFile::square().embedded()),
                picture("quantized.gltf", quantized.embedded()));
}

TEST_F(MeshFiles, GltfColorsOfThreeComponentsAreOpaque)
{
    for (const bool alpha : {false, true}) {
        GltfFile file = GltfFile::square();
        std::vector<float> colors;
        for (int i = 0; i < 4; ++i) {
            colors.insert(colors.end(), {1, 0, 0});
            if (alpha)
                colors.push_back(0.5F);
        }
        file.document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
            file.add<float>(colors, alpha ? "VEC4" : "VEC3");
        // Seen from the front, where the light is, it has its color.
        const auto image =
            picture("m.gltf", file.embedded(), {"--azimuth", "0", "--elevation", "0"});
        const glm::u8vec4 middle = image.at(side / 2, side / 2);
        EXPECT_GE(middle.r, 253);
        EXPECT_NEAR(middle.g, alpha ? 128 : 0, 2);
        EXPECT_NEAR(middle.b, alpha ? 128 : 0, 2);
    }
}

TEST_F(MeshFiles, MaterialsGiveColorAndOpacityUnlessOptionsDo)
{
    directory_.write("lib.mtl", "newmtl glass\nKd 1 0 0\nd 0.25\n");
    const std::string glass =
        "mtllib lib.mtl\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nusemtl glass\nf 1 2 3\n";
    const struct {
        std::vector<std::string> options;
        glm::vec3 color; ///< Over white.
    } cases[] = {
        {{}, {1, 0.75F, 0.75F}},
        {{"--layout", "rgbz"}, {1, 0.75F, 0.75F}},
        {{"--alpha", "1"}, {1, 0, 0}},
        {{"--color", "blue"}, {0.75F, 0.75F, 1}},
        {{"--color", "#00ff00", "--alpha", "0.5"}, {0.5F, 1, 0.5F}},
        {{"--color", "0,1,0", "--alpha", "0.5"}, {0.5F, 1, 0.5F}},
    };
    for (const auto &c : cases) {
        SCOPED_TRACE(testing::PrintToString(c.options));
        std::vector<std::string> options{"--azimuth", "0", "--elevation", "0"};
        options.insert(options.end(), c.options.begin(), c.options.end());
        const glm::u8vec4 middle = picture("m.obj", glass, options).at(side / 2, side / 2);
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(middle[channel], 255.0F * c.color[channel], 3.0F);
    }
}

TEST_F(MeshFiles, WhatIsLeftOutIsSaidInALine)
{
    const auto file = directory_.write("m.obj", tetrahedron + "l 1 2\n");
    for (const char *program : {KBUFFER_TRANSPARENCY, KBUFFER_PEELING}) {
        const auto result = draw(program, {"--mesh", file});
        EXPECT_EQ(result.status, 0);
        EXPECT_EQ(result.err,
                  fmt::format("{}: {}: lines are left out\n",
                              std::filesystem::path(program).filename().string(), file.string()));
    }
}

TEST_F(MeshFiles, MalformedOnesAreRefusedAndNothingIsWritten)
{
    const std::string cut = ply("", "").substr(0, 180);
    for (const auto &[name, content] :
         {std::pair<std::string, std::string>{"cut.ply", cut},
          {"cut.stl", stl(false).substr(0, 200)},
          {"nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
          {"index.obj", tetrahedron + "f 1 2 9\n"},
          {"cut.gltf", GltfFile::square().embedded().substr(0, 150)}}) {
        SCOPED_TRACE(name);
        const auto file = directory_.write(name, content);
        for (const char *program : {KBUFFER_TRANSPARENCY, KBUFFER_PEELING})
            expect_refused(draw(program, {"--mesh", file}),
                           std::filesystem::path(program).filename(), file);
        EXPECT_FALSE(std::filesystem::exists(directory_ / "picture.png"));
    }
}

TEST_F(MeshFiles, JsonSaysWhatWasDrawn)
{
    const auto file = directory_.write("m.obj", tetrahedron);
    for (const char *program : {KBUFFER_TRANSPARENCY, KBUFFER_PEELING}) {
        SCOPED_TRACE(program);
        const json r =
            report(program, {"--mesh", file, "--k", "3", "--repeat", "2", "--alpha", "0.5"});
        ASSERT_TRUE(r.is_object());
        EXPECT_EQ(r["mesh"], file.string());
        EXPECT_EQ(r["format"], "OBJ");
        EXPECT_EQ(r["triangles"], 4);
        EXPECT_EQ(r["colors_of"], "default");
        EXPECT_EQ(r["alpha"], json::array({0.5, 0.5}));
        EXPECT_EQ(r["size"], json::array({side, side}));
        EXPECT_EQ(r["k"], 3);
        EXPECT_EQ(r["passes"], 1);
        EXPECT_EQ(r["ms"].size(), 2U);
        EXPECT_NEAR(r["radius"].get<double>(), std::sqrt(0.6 * 0.6 * 3), 1e-6);
    }
    const json peeled = report(KBUFFER_PEELING, {"--all", "--k", "2", "--func", "greater"});
    EXPECT_EQ(peeled["func"], "greater");
    EXPECT_TRUE(peeled["mesh"].is_null());
    EXPECT_GT(peeled["layers"].get<int>(), 2);
    EXPECT_GT(peeled["passes"].get<int>(), 1);
}

TEST_F(MeshFiles, WhatIsDrawnIsPrinted)
{
    const auto file = directory_.write("m.obj", tetrahedron);
    for (const char *program : {KBUFFER_TRANSPARENCY, KBUFFER_PEELING}) {
        const auto result = draw(program, {"--mesh", file});
        EXPECT_EQ(result.err, "");
        EXPECT_NE(result.out.find(
                      fmt::format("mesh {}: OBJ, 4 vertices, 4 triangles, radius ", file.string())),
                  std::string::npos)
            << result.out;
    }
}

TEST_F(MeshFiles, EmptyPicturesSayWhy)
{
    for (const char *program : {KBUFFER_TRANSPARENCY, KBUFFER_PEELING}) {
        const auto result = draw(program, {"--triangles", "100", "--alpha", "0"});
        EXPECT_EQ(result.status, 0);
        EXPECT_NE(result.err.find("the picture is empty: alpha is 0"), std::string::npos)
            << result.err;
    }
}

TEST_F(MeshFiles, ColorsThatAreNoneAreRefused)
{
    for (const char *program : {KBUFFER_TRANSPARENCY, KBUFFER_PEELING})
        for (const char *color : {"reddish", "#12", "1,2,3", ""})
            expect_refused(draw(program, {"--color", color}),
                           std::filesystem::path(program).filename(), "--color");
}

TEST_F(MeshFiles, ProgramsTellTheirVersion)
{
    for (const char *program :
         {KBUFFER_TRANSPARENCY, KBUFFER_PEELING, KBUFFER_ISOSURFACE, KBUFFER_PROGRAM_TOOL}) {
        const auto result = run({program, "--version"});
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_EQ(result.out,
                  fmt::format("{} (mesa-kbuffer) {}\n",
                              std::filesystem::path(program).filename().string(), KBUFFER_VERSION));
    }
}

TEST_F(MeshFiles, HelloProgramsHelpAndWriteWhereTheyAreTold)
{
    const auto environment = mesa_environment(patched_prefix());
    for (const char *program : {KBUFFER_HELLO, KBUFFER_HELLO_PEELING}) {
        const std::string name = std::filesystem::path(program).filename();
        const auto help = run({program, "--help"}, environment);
        EXPECT_EQ(help.status, 0);
        EXPECT_NE(help.out.find(name + " [FILE.ppm]"), std::string::npos) << help.out;
        const std::filesystem::path file = directory_ / (name + "-here.ppm");
        EXPECT_EQ(run({program, file}, environment).status, 0);
        EXPECT_GT(std::filesystem::file_size(file), 3U * 256 * 256);
        for (const char *other : {"--no-such-option", "picture.jpg", "picture", "-"})
            expect_refused(run({program, other}, environment), name, "[FILE.ppm]");
        expect_refused(run({program, directory_ / "no/such.ppm"}, environment), name,
                       "no/such.ppm");
    }
}

} // namespace
