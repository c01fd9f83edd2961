// SPDX-License-Identifier: MIT

#include "tests/lib/io/gltf_file.hpp"
#include "tests/lib/io/loaded_mesh.hpp"
#include "tests/support/temp_directory.hpp"

#include <cmath>
#include <limits>

namespace
{

using namespace kb::test;
using nlohmann::json;

constexpr glm::dvec3 a(-1, -1, 0);
constexpr glm::dvec3 b(1, -1, 0);
constexpr glm::dvec3 c(1, 1, 0);
constexpr glm::dvec3 d(-1, 1, 0);
const std::vector<Corners> square{{a, b, c}, {a, c, d}};

kb::Result<kb::LoadedMesh> load(const GltfFile &file)
{
    const TempDirectory directory;
    return kb::load_mesh(directory.write("m.gltf", file.embedded()));
}

json &primitive(GltfFile &file)
{
    return file.document["meshes"][0]["primitives"][0];
}

TEST(LoadGltf, ReadsBuffersInItBesideItAndInABinaryFile)
{
    const TempDirectory directory;
    const GltfFile file = GltfFile::square();
    expect_triangles(kb::load_mesh(directory.write("m.gltf", file.embedded())), square);
    directory.write("a buffer.bin", file.bytes);
    expect_triangles(kb::load_mesh(directory.write("m.gltf", file.beside("a%20buffer.bin"))),
                     square);
    expect_triangles(kb::load_mesh(directory.write("m.GLB", file.binary())), square);
}

TEST(LoadGltf, ReadsEveryTypeOfIndexAndNone)
{
    for (const int type : {0, 1, 2, 3}) {
        GltfFile file = GltfFile::square();
        if (type == 0)
            primitive(file)["indices"] = file.add<std::uint8_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
        else if (type == 1)
            primitive(file)["indices"] = file.add<std::uint32_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
        else if (type == 2)
            primitive(file)["indices"] = file.add<std::uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
        else {
            primitive(file).erase("indices");
            primitive(file)["attributes"]["POSITION"] = file.add<float>(
                {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, -1, 0, 1, 1, 0, -1, 1, 0}, "VEC3");
        }
        expect_triangles(load(file), square);
    }
}

TEST(LoadGltf, ReadsStripsAndFans)
{
    GltfFile strip = GltfFile::square();
    primitive(strip)["mode"] = 5;
    primitive(strip)["indices"] = strip.add<std::uint16_t>({0, 1, 3, 2}, "SCALAR");
    expect_triangles(load(strip), {{a, b, d}, {d, b, c}});
    GltfFile fan = GltfFile::square();
    primitive(fan)["mode"] = 6;
    primitive(fan).erase("indices");
    expect_triangles(load(fan), square);
}

TEST(LoadGltf, LeavesOutPointsAndLinesAndSaysSo)
{
    GltfFile file = GltfFile::square();
    json points = primitive(file);
    points["mode"] = 0;
    file.add_primitive(points);
    points["mode"] = 3;
    file.add_primitive(points);
    const auto loaded = load(file);
    expect_triangles(loaded, square);
    expect_note(loaded, "points are left out");
    expect_note(loaded, "lines are left out");

    primitive(file)["mode"] = 1;
    const auto none = load(file);
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find("it has no triangles"), std::string::npos);
}

TEST(LoadGltf, FollowsTheTransformsOfNodes)
{
    GltfFile file = GltfFile::square();
    const double half = std::sqrt(0.5);
    file.document["nodes"] = {
        {{"children", {1, 2}}, {"translation", {615850, 5846925, 758}}},
        // A quarter turn about z takes x to y.
        {{"mesh", 0}, {"scale", {2, 1, 1}}, {"rotation", {0, 0, half, half}}},
        {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1}}},
        {{"mesh", 0}}, // Not in the scene.
    };
    const glm::dvec3 far(615850, 5846925, 758);
    const glm::dvec3 up(0, 0, 5);
    const auto turned = [&](const glm::dvec3 &p) { return far + glm::dvec3(-p.y, 2 * p.x, p.z); };
    expect_triangles(load(file), {{turned(a), turned(b), turned(c)},
                                  {turned(a), turned(c), turned(d)},
                                  {far + up + a, far + up + b, far + up + c},
                                  {far + up + a, far + up + c, far + up + d}});
}

TEST(LoadGltf, WithoutASceneAllNodesAreDrawn)
{
    GltfFile file = GltfFile::square();
    file.document.erase("scene");
    file.document.erase("scenes");
    expect_triangles(load(file), square);
}

TEST(LoadGltf, TurnsNormalsAsPlanes)
{
    GltfFile file = GltfFile::square();
    const float n = std::sqrt(0.5F);
    primitive(file)["attributes"]["NORMAL"] =
        file.add<float>({n, 0, n, n, 0, n, n, 0, n, n, 0, n}, "VEC3");
    file.document["nodes"][0]["scale"] = {2, 1, -1};
    const auto loaded = load(file);
    ASSERT_TRUE(loaded) << loaded.error().message;
    for (const glm::vec3 &normal : loaded->mesh.normals) {
        // The plane x + z = 0 becomes x / 2 - z = 0.
        const glm::vec3 expected = glm::normalize(glm::vec3(0.5F, 0.0F, -1.0F));
        EXPECT_NEAR(std::abs(glm::dot(normal, expected)), 1.0F, 1e-6F);
    }
}

TEST(LoadGltf, WithoutNormalsTrianglesAreFlat)
{
    GltfFile file;
    file.add_primitive(
        {{"attributes",
          {{"POSITION", file.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3")}}},
         {"indices", file.add<std::uint16_t>({0, 2, 1, 0, 1, 3}, "SCALAR")}});
    const auto loaded = load(file);
    ASSERT_TRUE(loaded) << loaded.error().message;
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_EQ(loaded->mesh.normals[loaded->mesh.indices[i]],
                  i < 3 ? glm::vec3(0, 0, -1) : glm::vec3(0, -1, 0));
}

TEST(LoadGltf, ReadsColorsOfThreeAndFourComponentsAndAllTypes)
{
    const auto colored = [](auto one, auto half, bool alpha) {
        using T = decltype(one);
        GltfFile file = GltfFile::square();
        std::vector<T> values;
        for (int i = 0; i < 4; ++i) {
            values.insert(values.end(), {one, T(0), half});
            if (alpha)
                values.push_back(half);
        }
        // Each element is a multiple of four bytes.
        const std::size_t used = (alpha ? 4 : 3) * sizeof(T);
        const std::size_t stride = (used + 3) / 4 * 4;
        std::vector<unsigned char> padded(4 * stride);
        for (std::size_t i = 0; i < 4; ++i)
            std::memcpy(&padded[i * stride], &values[i * used / sizeof(T)], used);
        const int accessor = file.add<T>(values, alpha ? "VEC4" : "VEC3",
                                         {{"normalized", std::numeric_limits<T>::is_integer}});
        const int view = file.add_view(padded.data(), padded.size());
        file.document["bufferViews"][std::size_t(view)]["byteStride"] = stride;
        file.document["accessors"][std::size_t(accessor)]["bufferView"] = view;
        primitive(file)["attributes"]["COLOR_0"] = accessor;
        return load(file);
    };
    for (const bool alpha : {false, true}) {
        const glm::vec4 exact(1, 0, 0.4F, alpha ? 0.4F : 1.0F);
        expect_one_color(colored(1.0F, 0.4F, alpha), exact);
        expect_one_color(colored(std::uint8_t(255), std::uint8_t(102), alpha), exact);
        expect_one_color(colored(std::uint16_t(65535), std::uint16_t(26214), alpha), exact);
    }
}

TEST(LoadGltf, MaterialsGiveColorAndOpacity)
{
    GltfFile file = GltfFile::square();
    primitive(file)["material"] = 0;
    json &material = file.document["materials"][0];
    material = {{"alphaMode", "BLEND"},
                {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 0, 0.25}}}}};
    expect_one_color(load(file), {1, 0, 0, 0.25F});

    primitive(file)["attributes"]["COLOR_0"] =
        file.add<float>({.5F, 1, 1, .5F, .5F, 1, 1, .5F, .5F, 1, 1, .5F, .5F, 1, 1, .5F}, "VEC4");
    expect_one_color(load(file), {0.5F, 0, 0, 0.125F});
    material.erase("alphaMode"); // Opaque, says the format.
    expect_one_color(load(file), {0.5F, 0, 0, 1});
    material.erase("pbrMetallicRoughness");
    expect_one_color(load(file), {0.5F, 1, 1, 1});
    material["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
    expect_note(load(file), "textures are left out");
}

TEST(LoadGltf, ReadsQuantizedVertices)
{
    GltfFile file = GltfFile::square();
    file.document["extensionsUsed"] = {"KHR_mesh_quantization"};
    file.document["extensionsRequired"] = {"KHR_mesh_quantization"};
    const int normalized = file.add<std::int16_t>(
        {-32767, -32767, 0, 0, 32767, -32767, 0, 0, 32767, 32767, 0, 0, -32767, 32767, 0, 0},
        "VEC4", {{"normalized", true}});
    file.document["accessors"][std::size_t(normalized)]["type"] = "VEC3";
    file.document["bufferViews"].back()["byteStride"] = 8;
    primitive(file)["attributes"]["POSITION"] = normalized;
    expect_triangles(load(file), square);

    const int bytes =
        file.add<std::uint8_t>({0, 0, 1, 0, 2, 0, 1, 0, 2, 2, 1, 0, 0, 2, 1, 0}, "VEC4");
    file.document["accessors"][std::size_t(bytes)]["type"] = "VEC3";
    file.document["bufferViews"].back()["byteStride"] = 4;
    primitive(file)["attributes"]["POSITION"] = bytes;
    file.document["nodes"][0]["translation"] = {-1, -1, -1};
    expect_triangles(load(file), square);
}

TEST(LoadGltf, ReadsSparseAccessors)
{
    GltfFile file = GltfFile::square();
    // Zeros but for three; and a base of which one vertex is replaced.
    const std::uint8_t places[] = {1, 2, 3};
    const float points[] = {1, -1, 0, 1, 1, 0, -1, 1, 0};
    const json sparse{
        {"count", 3},
        {"indices", {{"bufferView", file.add_view(places, 3)}, {"componentType", 5121}}},
        {"values", {{"bufferView", file.add_view(points, 36)}}}};
    json &accessor = file.document["accessors"][0];
    accessor["sparse"] = sparse;
    expect_triangles(load(file), square);
    accessor.erase("bufferView");
    expect_triangles(load(file), {{glm::dvec3(0), b, c}, {glm::dvec3(0), c, d}});
    accessor["sparse"]["indices"]["byteOffset"] = 1;
    EXPECT_FALSE(load(file)) << "indices outside of their buffer view";
    accessor["sparse"] = sparse;
    accessor["count"] = 3;
    EXPECT_FALSE(load(file)) << "an index outside of the accessor";
}

TEST(LoadGltf, RefusesOtherRequiredExtensionsByName)
{
    GltfFile file = GltfFile::square();
    file.document["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    expect_triangles(load(file), square); // The format has what is for those who do not know it.
    expect_note(load(file), "KHR_draco_mesh_compression");
    file.document["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    const auto refused = load(file);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("it requires the extension KHR_draco_mesh_compression"),
              std::string::npos);
    // Also where it is why there is no buffer to be read.
    const TempDirectory directory;
    file.document["extensionsRequired"] = {"EXT_meshopt_compression"};
    expect_refused(directory.write("m.gltf", file.beside("no-such.bin")),
                   "EXT_meshopt_compression");
}

TEST(LoadGltf, SaysWhatItLeavesOut)
{
    GltfFile file = GltfFile::square();
    file.document["skins"] = {{{"joints", {0}}}};
    file.document["nodes"][0]["skin"] = 0;
    primitive(file)["targets"] = {{{"POSITION", 0}}};
    file.document["scenes"].push_back({{"nodes", json::array()}});
    const auto loaded = load(file);
    for (const char *what : {"skins", "morph targets", "other scenes"})
        expect_note(loaded, what);
}

TEST(LoadGltf, RefusesWhatIsMalformed)
{
    const TempDirectory directory;
    const GltfFile good = GltfFile::square();
    const std::string text = good.embedded();
    for (std::size_t length = 1; length < text.size(); length += 7)
        expect_refused(directory.write("cut.gltf", text.substr(0, length)), "");
    const std::string binary = good.binary();
    for (std::size_t length = 1; length < binary.size(); ++length)
        expect_refused(directory.write("cut.glb", binary.substr(0, length)), "");
    std::string chunk = binary;
    chunk[12] = static_cast<char>(chunk[12] + 8); // The first chunk swallows the next one's head.
    expect_refused(directory.write("chunk.glb", chunk), "");
    std::string old = binary;
    old[4] = 1;
    expect_refused(directory.write("old.glb", old), "it is glTF version 1, not 2");
    expect_refused(directory.write("noise.glb", std::string("glTF\x02\0\0\0garbage", 15)), "early");
    expect_refused(directory.write("beside.gltf", good.beside("no-such.bin")), "no-such.bin");

    using Change = void (*)(GltfFile &);
    const struct {
        Change change;
        std::string mention;
    } cases[] = {
        {[](GltfFile &f) { f.document["asset"]["version"] = "1.0"; }, "version 1.0"},
        {[](GltfFile &f) { f.document["scene"] = 1; }, "there is no scene 1"},
        {[](GltfFile &f) { f.document["scenes"][0]["nodes"] = {1}; }, "node 1: there is none"},
        {[](GltfFile &f) { f.document["scenes"][0]["nodes"] = json::array(); }, "no triangles"},
        {[](GltfFile &f) { f.document["nodes"][0]["children"] = {0}; }, "node 0: it is the child"},
        {[](GltfFile &f) { f.document["nodes"][0]["children"] = {-4}; },
         "nodes[0].children is no list of integers from 0 on"},
        {[](GltfFile &f) { f.document["nodes"][0]["mesh"] = 7; }, "there is no mesh 7"},
        {[](GltfFile &f) {
             f.document["nodes"][0]["scale"] = {1, 1};
         },
         "its transform"},
        {[](GltfFile &f) {
             f.document["nodes"][0]["matrix"] = {1, 1};
         },
         "its transform"},
        {[](GltfFile &f) { primitive(f)["mode"] = 7; }, "there is no mode 7"},
        {[](GltfFile &f) { primitive(f)["material"] = 0; }, "there is no material 0"},
        {[](GltfFile &f) { primitive(f)["attributes"].erase("POSITION"); }, "no positions"},
        {[](GltfFile &f) { primitive(f)["attributes"]["POSITION"] = 9; }, "no accessor 9"},
        {[](GltfFile &f) { primitive(f)["attributes"]["POSITION"] = 1; }, "1 components"},
        {[](GltfFile &f) {
             primitive(f)["attributes"]["NORMAL"] = f.add<float>({0, 0, 1}, "VEC3");
         },
         "NORMAL has 1 elements for 4 vertices"},
        {[](GltfFile &f) {
             primitive(f)["attributes"]["COLOR_0"] = f.add<float>({1, 1}, "VEC2");
         },
         "COLOR_0 has 2 components"},
        {[](GltfFile &f) { primitive(f)["indices"] = 0; }, "no unsigned integers"},
        {[](GltfFile &f) {
             primitive(f)["indices"] = f.add<std::uint16_t>({0, 1}, "SCALAR");
         },
         "2 indices make no triangles"},
        {[](GltfFile &f) {
             primitive(f)["indices"] = f.add<std::uint16_t>({0, 1, 4}, "SCALAR");
         },
         "index 4, but there are 4 vertices"},
        {[](GltfFile &f) {
             primitive(f)["indices"] = f.add<std::uint16_t>({0, 1, 65535}, "SCALAR");
         },
         "index 65535"},
        {[](GltfFile &f) { f.document["accessors"][0]["count"] = 5; }, "too short for 5 elements"},
        {[](GltfFile &f) { f.document["accessors"][0]["count"] = 4294967295U; }, "too short for"},
        {[](GltfFile &f) { f.document["accessors"][0]["byteOffset"] = 4; }, "too short for 4"},
        {[](GltfFile &f) { f.document["accessors"][0]["bufferView"] = 5; }, "no buffer view 5"},
        {[](GltfFile &f) { f.document["accessors"][0]["componentType"] = 5130; }, "a type that"},
        {[](GltfFile &f) { f.document["bufferViews"][0]["buffer"] = 3; }, "no buffer 3"},
        {[](GltfFile &f) { f.document["bufferViews"][0]["byteLength"] = 4096; },
         "longer than its buffer"},
        {[](GltfFile &f) { f.document["bufferViews"][1]["byteOffset"] = 4096; },
         "longer than its buffer"},
        {[](GltfFile &f) { f.document["asset"]["minVersion"] = "2.1"; },
         "needs a reader of glTF version 2.1"},
        {[](GltfFile &f) {
             f.document["nodes"][0]["rotation"] = {0, 0, 0, 0};
         },
         "no unit quaternion"},
        {[](GltfFile &f) {
             f.document["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
             f.document["nodes"][0]["scale"] = {2, 2, 2};
         },
         "nodes[0] has a matrix and a scale"},
        {[](GltfFile &f) { f.document["bufferViews"][0]["byteStride"] = 8; },
         "elements of 12 bytes are 8 bytes apart"},
        {[](GltfFile &f) { f.document["bufferViews"][0]["byteOffset"] = -4; },
         "bufferViews[0].byteOffset is no integer from 0 on"},
        {[](GltfFile &f) { f.document["accessors"][0]["byteOffset"] = 0.5; },
         "accessors[0].byteOffset is no integer from 0 on"},
        {[](GltfFile &f) { f.document["accessors"][0]["normalized"] = 1; },
         "accessors[0].normalized is neither true nor false"},
        {[](GltfFile &f) { f.document["nodes"][0]["translation"] = "up"; },
         "nodes[0].translation is no list of numbers"},
        {[](GltfFile &f) {
             f.document["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, "1"};
         },
         "materials[0].pbrMetallicRoughness.baseColorFactor is no list of numbers"},
        {[](GltfFile &f) { primitive(f)["mode"] = "triangles"; },
         "meshes[0].primitives[0].mode is no integer from 0 on"},
        {[](GltfFile &f) {
             const float nan = std::nanf("");
             std::memcpy(f.bytes.data() + 16, &nan, 4);
         },
         "is not finite"},
    };
    for (const auto &item : cases) {
        SCOPED_TRACE(item.mention);
        GltfFile file = good;
        item.change(file);
        expect_refused(directory.write("m.gltf", file.embedded()), item.mention);
    }
}

} // namespace
