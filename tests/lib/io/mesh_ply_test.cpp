// SPDX-License-Identifier: MIT

#include "tests/lib/io/loaded_mesh.hpp"
#include "tests/support/temp_directory.hpp"

#include <algorithm>
#include <cstring>

namespace
{

using namespace kb::test;

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string corners_list = "property list uchar int vertex_indices\n";

std::string header(const std::string &elements, const std::string &format = "ascii")
{
    return "ply\nformat " + format + " 1.0\ncomment made for a test\n" + elements + "end_header\n";
}

const std::string triangle_header =
    header("element vertex 3\n" + xyz + "element face 1\n" + corners_list);
const std::string triangle_points = "0 0 0\n1 0 0\n0 1 0\n";

constexpr glm::dvec3 origin(0, 0, 0);
constexpr glm::dvec3 x(1, 0, 0);
constexpr glm::dvec3 y(0, 1, 0);
constexpr glm::dvec3 z(0, 0, 1);

/// Bytes of numbers in the order that a binary file has.
class Bytes
{
public:
    explicit Bytes(bool big_endian) : big_endian_(big_endian) {}

    template <class T>
    Bytes &add(std::initializer_list<T> values)
    {
        for (const T value : values) {
            std::string bytes(sizeof(T), '\0');
            std::memcpy(bytes.data(), &value, sizeof(T));
            if (big_endian_) // This machine is not.
                std::reverse(bytes.begin(), bytes.end());
            bytes_ += bytes;
        }
        return *this;
    }

    const std::string &string() const { return bytes_; }

private:
    bool big_endian_;
    std::string bytes_;
};

TEST(LoadPly, ReadsTrianglesAndPolygonsOfAnyNumberOfCorners)
{
    const TempDirectory directory;
    expect_triangles(
        kb::load_mesh(directory.write("m.ply", triangle_header + triangle_points + "3 0 1 2\n")),
        {{origin, x, y}});
    expect_triangles(
        kb::load_mesh(directory.write(
            "q.ply", header("element vertex 4\n" + xyz + "element face 1\n" + corners_list) +
                         "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n")),
        {{origin, x, x + y}, {origin, x + y, y}});
}

TEST(LoadPly, ReadsPropertiesBeforeAndBehindTheListAndElementsInAnyOrder)
{
    const TempDirectory directory;
    const auto mesh = kb::load_mesh(directory.write(
        "m.ply",
        header("element face 1\nproperty uchar intensity\nproperty list int float weights\n"
               "property list ushort uint vertex_index\nproperty double quality\n"
               "element edge 2\nproperty int vertex1\nproperty int vertex2\n"
               "element vertex 3\nproperty double quality\nproperty float z\nproperty float y\n"
               "property double x\n") +
            "255 2 0.5 0.25 3 2 0 1 1e-3\n0 1\n1 2\n7 0 0 0\n7 0 0 1\n7 0 1 0\n"));
    expect_triangles(mesh, {{y, origin, x}});
    expect_note(mesh, "'edge'");
}

TEST(LoadPly, ReadsBothByteOrdersAndAllTypes)
{
    const TempDirectory directory;
    for (const bool big_endian : {false, true}) {
        SCOPED_TRACE(big_endian);
        const std::string start = header(
            "element vertex 4\nproperty int8 a\nproperty uint16 b\nproperty double x\n"
            "property short y\nproperty uint8 c\nproperty float z\nproperty int d\n"
            "element face 2\nproperty uint32 id\nproperty list uint16 uint16 vertex_indices\n"
            "property list uchar double texcoord\n",
            big_endian ? "binary_big_endian" : "binary_little_endian");
        Bytes body(big_endian);
        const glm::dvec3 points[] = {origin, x, y, z};
        for (const glm::dvec3 &p : points)
            body.add<std::int8_t>({-1})
                .add<std::uint16_t>({65535})
                .add<double>({p.x})
                .add<std::int16_t>({std::int16_t(p.y)})
                .add<std::uint8_t>({10})
                .add<float>({float(p.z)})
                .add<std::int32_t>({-7});
        body.add<std::uint32_t>({1}).add<std::uint16_t>({3, 0, 1, 2}).add<std::uint8_t>({0});
        body.add<std::uint32_t>({2})
            .add<std::uint16_t>({3, 1, 2, 3})
            .add<std::uint8_t>({2})
            .add<double>({0.5, 0.5});
        const std::string whole = start + body.string();
        const std::vector<Corners> expected{{origin, x, y}, {x, y, z}};
        expect_triangles(kb::load_mesh(directory.write("m.ply", whole)), expected);
        // What is cut off is told at every length.
        for (std::size_t length = start.size(); length < whole.size(); length += 3)
            expect_refused(directory.write("cut.ply", whole.substr(0, length)), "it ends early");
        const auto more = kb::load_mesh(directory.write("more.ply", whole + "more"));
        expect_triangles(more, expected);
        expect_note(more, "behind the elements");
    }
}

TEST(LoadPly, ReadsTriangleStrips)
{
    const TempDirectory directory;
    const std::vector<Corners> expected{
        {origin, x, y}, {y, x, z}, {y, z, origin}, {x, y, z}, {origin, y, x + z}};
    const std::string points = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 1\n";
    expect_triangles(
        kb::load_mesh(directory.write(
            "ascii.ply", header("element vertex 5\n" + xyz +
                                "element tristrips 2\nproperty list int int vertex_indices\n") +
                             points + "11 0 1 2 3 0 -1 1 2 3 3 -1\n3 0 2 4\n")),
        expected);

    for (const bool big_endian : {false, true}) {
        Bytes body(big_endian);
        body.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1});
        body.add<std::int32_t>({13, 0, 1, 2, 3, 0, -1, 1, 2, 3, -1, 0, 2, 4});
        expect_triangles(
            kb::load_mesh(directory.write(
                "binary.ply",
                header("element vertex 5\n" + xyz +
                           "element tristrips 1\nproperty list int int vertex_indices\n",
                       big_endian ? "binary_big_endian" : "binary_little_endian") +
                    body.string())),
            expected);
    }
    expect_refused(directory.write("index.ply", header("element vertex 5\n" + xyz +
                                                       "element tristrips 1\n"
                                                       "property list int int vertex_indices\n") +
                                                    points + "3 0 1 5\n"),
                   "a strip has index 5, but there are 5 vertices");
    expect_refused(
        directory.write("negative.ply", header("element vertex 5\n" + xyz +
                                               "element tristrips 1\n"
                                               "property list int int vertex_indices\n") +
                                            points + "3 0 1 -2\n"),
        "index -2");
}

TEST(LoadPly, ReadsColorsOfVertices)
{
    const TempDirectory directory;
    const auto colors = [&](const std::string &type, const std::string &values) {
        std::string properties;
        for (const char *channel : {"red", "green", "blue", "alpha"})
            properties += "property " + type + " " + channel + "\n";
        return kb::load_mesh(directory.write(
            "m.ply",
            header("element vertex 3\n" + xyz + properties + "element face 1\n" + corners_list) +
                "0 0 0 " + values + "\n1 0 0 " + values + "\n0 1 0 " + values + "\n3 0 1 2\n"));
    };
    expect_one_color(colors("uchar", "255 0 51 102"), {1, 0, 0.2F, 0.4F});
    expect_one_color(colors("ushort", "65535 0 13107 26214"), {1, 0, 0.2F, 0.4F});
    expect_one_color(colors("float", "1 0 0.2 0.4"), {1, 0, 0.2F, 0.4F});
    const auto wrong = colors("float", "255 0 51 102");
    ASSERT_FALSE(wrong);
    EXPECT_NE(wrong.error().message.find("from 0 to 1"), std::string::npos);
}

TEST(LoadPly, OpaqueWithoutAlpha)
{
    const TempDirectory directory;
    expect_one_color(
        kb::load_mesh(directory.write(
            "m.ply", header("element vertex 3\n" + xyz +
                            "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                            "element face 1\n" +
                            corners_list) +
                         "0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 0\n3 0 1 2\n")),
        {1, 0, 0, 1});
}

TEST(LoadPly, ReadsColorsOfFaces)
{
    const TempDirectory directory;
    const auto mesh = kb::load_mesh(directory.write(
        "m.ply", header("element vertex 4\n" + xyz + "element face 2\n" + corners_list +
                        "property uchar red\nproperty uchar green\nproperty uchar blue\n") +
                     "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2 255 0 0\n3 1 2 3 0 0 255\n"));
    expect_triangles(mesh, {{origin, x, y}, {x, y, z}});
    EXPECT_EQ(mesh->colors_of, "faces");
    const auto colors = corner_colors(*mesh);
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_EQ(colors[i], i < 3 ? glm::vec4(1, 0, 0, 1) : glm::vec4(0, 0, 1, 1));
}

TEST(LoadPly, KeepsVerticesApartThatDifferInColorOnly)
{
    const TempDirectory directory;
    const auto loaded = kb::load_mesh(directory.write(
        "twice.ply", header("element vertex 9\n" + xyz +
                            "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                            "property uchar alpha\nelement face 3\n" +
                            corners_list) +
                         "0 0 0 255 0 0 51\n1 0 0 255 0 0 51\n0 1 0 255 0 0 51\n"
                         "0 0 0 0 255 0 51\n1 0 0 0 255 0 51\n0 1 0 0 255 0 51\n"
                         "0 0 0 255 0 0 51\n1 0 0 255 0 0 51\n0 1 0 255 0 0 51\n"
                         "3 0 1 2\n3 3 4 5\n3 6 7 8\n"));
    ASSERT_TRUE(loaded) << loaded.error().message;
    const kb::Mesh &mesh = loaded->mesh;
    ASSERT_EQ(mesh.triangle_count(), 3U);
    EXPECT_EQ(mesh.positions.size(), 6U) << "the third triangle is the first one again";
    EXPECT_EQ(mesh.colors[mesh.indices[0]], glm::vec4(1, 0, 0, 0.2F));
    EXPECT_EQ(mesh.colors[mesh.indices[3]], glm::vec4(0, 1, 0, 0.2F));
    EXPECT_EQ(mesh.colors[mesh.indices[6]], glm::vec4(1, 0, 0, 0.2F));
}

TEST(LoadPly, KeepsNormalsAndComputesThoseThatAreZeroOrNaN)
{
    const TempDirectory directory;
    const auto load = [&](const std::string &normal) {
        return kb::load_mesh(directory.write(
            "m.ply", header("element vertex 3\n" + xyz +
                            "property float nx\nproperty float ny\nproperty float nz\n"
                            "element face 1\n" +
                            corners_list) +
                         "0 0 0 " + normal + "\n1 0 0 " + normal + "\n0 1 0 " + normal +
                         "\n3 0 1 2\n"));
    };
    for (const auto &[given, expected] : {std::pair{"1 0 0", glm::vec3(1, 0, 0)},
                                          {"0 0 0", glm::vec3(0, 0, 1)},
                                          {"nan 0 0", glm::vec3(0, 0, 1)}}) {
        const auto loaded = load(given);
        ASSERT_TRUE(loaded) << loaded.error().message;
        for (const glm::vec3 &normal : loaded->mesh.normals)
            EXPECT_EQ(normal, expected) << given;
    }
}

TEST(LoadPly, LeavesOutSmallFacesAndSaysSo)
{
    const TempDirectory directory;
    const auto mesh = kb::load_mesh(directory.write(
        "m.ply", header("element vertex 3\n" + xyz + "element face 4\n" + corners_list) +
                     triangle_points + "0\n2 0 1\n3 0 1 2\n1 2\n"));
    expect_triangles(mesh, {{origin, x, y}});
    expect_note(mesh, "3 faces of less than three corners");
}

TEST(LoadPly, RefusesWhatIsMalformed)
{
    const TempDirectory directory;
    const std::string two_points = "0 0 0\n1 0 0\n";
    const struct {
        std::string content;
        std::string mention;
    } files[] = {
        {"", "it is empty"},
        {"plywood\n", "does not begin with a line 'ply'"},
        {triangle_header.substr(0, triangle_header.find("element")), "its header has no end"},
        {"ply\nend_header\n", "has no format"},
        {"ply\nformat ascii 2.0\nend_header\n", "not version 1.0"},
        {"ply\nformat binary 1.0\nend_header\n", "no such format: 'binary'"},
        {"ply\nformat ascii 1.0\nproperty float x\n", "property before the first element"},
        {header("element vertex many\n"), "element vertex has no count"},
        {header("element vertex -1\n"), "element vertex has no count"},
        {header("element vertex 3\nproperty int64 x\n"), "no such type: 'int64'"},
        {header("element vertex 3\nproperty list float int x\n"), "no integer type"},
        {header("elements vertex 3\n"), "unknown line: 'elements'"},
        {header("element vertex 1\nproperty float x\nproperty float y\n") + "0 0\n",
         "no x, y and z"},
        {header("element vertex 3\n" + xyz + "element face 1\nproperty int first\n") +
             triangle_points + "3\n",
         "no list vertex_indices"},
        {header("element vertex 3\n" + xyz), "vertex 0 of 3: it ends early"},
        {header("element vertex 3\n" + xyz) + triangle_points, "it has no triangles"},
        {triangle_header, "vertex 0 of 3: it ends early"},
        {triangle_header + two_points, "vertex 2 of 3: it ends early"},
        {triangle_header + triangle_points, "face 0 of 1: it ends early"},
        {triangle_header + triangle_points + "3 0", "face 0 of 1: a value is missing"},
        {triangle_header + triangle_points + "3 0 1\n2\n", "face 0 of 1: a value is missing"},
        {triangle_header + triangle_points + "3 0 1 2 3\n", "more values than properties"},
        {triangle_header + "0 0 0 0\n" + two_points + "3 0 1 2\n", "more values than properties"},
        {triangle_header + two_points + "0 1,5 0\n3 0 1 2\n", "'1,5' is no number"},
        {triangle_header + two_points + "0 1e999 0\n3 0 1 2\n", "'1e999' is no number"},
        {triangle_header + two_points + "nan 0 0\n3 0 1 2\n", "vertex 2 is not finite"},
        {triangle_header + two_points + "0 -inf 0\n3 0 1 2\n", "vertex 2 is not finite"},
        {triangle_header + two_points + "0 1 0\n3 0 1 3\n",
         "face 0 has index 3, but there are 3 vertices"},
        {triangle_header + two_points + "0 1 0\n3 0 1 2000000000\n", "index 2000000000"},
        {triangle_header + two_points + "0 1 0\n3 0 1 3000000000\n", "does not fit the type"},
        {triangle_header + two_points + "0 1 0\n3 0 1 -1\n", "index -1"},
        {triangle_header + two_points + "0 1 0\n3 0 1 0.5\n", "does not fit the type"},
        {triangle_header + two_points + "0 1 0\n-3 0 1 2\n", "does not fit the type"},
        {triangle_header + "1 1 1\n1 1 1\n1 1 1\n3 0 1 2\n", "all in one place"},
        {header("element vertex 4000000000000000000\n" + xyz) + triangle_points, "it ends early"},
        {header("element nothing 4000000000000000000\n"), "it has no triangles"},
    };
    for (const auto &file : files) {
        SCOPED_TRACE(file.content);
        expect_refused(directory.write("m.ply", file.content), file.mention);
    }
}

} // namespace
