// SPDX-License-Identifier: MIT

#include "tests/lib/io/loaded_mesh.hpp"
#include "tests/support/temp_directory.hpp"

#include <fmt/format.h>

namespace
{

using namespace kb::test;

constexpr glm::dvec3 origin(0, 0, 0);
constexpr glm::dvec3 x(1, 0, 0);
constexpr glm::dvec3 y(0, 1, 0);
constexpr glm::dvec3 z(0, 0, 1);

const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

TEST(LoadObj, ReadsFacesInAllForms)
{
    const TempDirectory directory;
    for (const std::string faces :
         {"f 1 2 3\nf 2 3 4\n", "f -4 -3 -2\nf -3 -2 -1\n",
          "vt 0 0\nf 1/1 2/1 3/1\nf 2/1 3/1 4/1\n",
          "vn 0 0 1\nf 1//1 2//1 3//1\nf 2//1 3//-1 4//1\n",
          "vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 2/1/1 3/1/1 4/1/1\n",
          "g a\no b\ns off\n# comment\nf 1 2 \\\n 3 # and one more\r\n\nf 2 3 4"}) {
        SCOPED_TRACE(faces);
        expect_triangles(kb::load_mesh(directory.write("m.obj", points + faces)),
                         {{origin, x, y}, {x, y, z}});
    }
}

TEST(LoadObj, SkipsAByteOrderMark)
{
    const TempDirectory directory;
    expect_triangles(kb::load_mesh(directory.write("m.obj", "\xEF\xBB\xBF" + points + "f 1 2 3\n")),
                     {{origin, x, y}});
}

TEST(LoadObj, CutsConcavePolygonsIntoTheirTriangles)
{
    const TempDirectory directory;
    // An arrow: the corner at (1, 1) points inwards.
    const auto loaded = kb::load_mesh(
        directory.write("m.obj", "v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nf 1 2 3 4\nf 3 4 1 2\n"));
    ASSERT_TRUE(loaded) << loaded.error().message;
    const auto triangles = triangles_of(*loaded);
    ASSERT_EQ(triangles.size(), 4U);
    for (const std::size_t first : {0U, 2U}) {
        double area = 0.0;
        for (std::size_t i = first; i < first + 2; ++i) {
            const double turned =
                glm::cross(triangles[i][1] - triangles[i][0], triangles[i][2] - triangles[i][0]).z;
            EXPECT_GT(turned, 0.0) << "triangle " << i << " is turned as the polygon is";
            area += 0.5 * turned;
        }
        EXPECT_NEAR(area, 4.0, 1e-5) << "no triangle lies outside of the polygon";
    }
}

TEST(LoadObj, FarFromTheOriginTheShapeIsTheSame)
{
    const TempDirectory directory;
    const std::string faces = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
    const auto at = [&](double x0, double y0, double z0, double size) {
        std::string text;
        for (const glm::dvec3 &p : {origin, x, y, z})
            text += fmt::format("v {:.9f} {:.9f} {:.9f}\n", x0 + size * p.x, y0 + size * p.y,
                                z0 + size * p.z);
        return kb::load_mesh(directory.write("m.obj", text + faces));
    };
    const auto near = at(0, 0, 0, 1.2);
    const auto far = at(615850, 5846925, 758, 1.2);
    ASSERT_TRUE(near && far);
    ASSERT_EQ(near->mesh.positions.size(), far->mesh.positions.size());
    for (std::size_t i = 0; i < near->mesh.positions.size(); ++i)
        // Nine decimals: half of 1e-9 and half an ulp of 5.8e6 in a size of 1.
        EXPECT_LE(glm::distance(near->mesh.positions[i], far->mesh.positions[i]), 1e-6F);
    EXPECT_NEAR(far->radius, near->radius, 1e-8);
    EXPECT_NEAR(far->center.y, 5846925.6, 1e-8);
}

TEST(LoadObj, SizesThatFloatsDoNotHaveAreNoMatter)
{
    const TempDirectory directory;
    for (const std::string exponent : {"e-300", "e-60", "e60", "e300"}) {
        const auto loaded = kb::load_mesh(directory.write(
            "m.obj", "v 0 0 0\nv 1" + exponent + " 0 0\nv 0 1" + exponent + " 0\nf 1 2 3\n"));
        ASSERT_TRUE(loaded) << loaded.error().message;
        EXPECT_NEAR(glm::distance(loaded->mesh.positions[0], loaded->mesh.positions[1]),
                    std::sqrt(2.0), 1e-6);
        EXPECT_EQ(std::abs(loaded->mesh.normals[0].z), 1.0F);
    }
}

TEST(LoadObj, MaterialsGiveColorAndOpacity)
{
    const TempDirectory directory;
    const std::string start = "mtllib lib.mtl\n" + points + "usemtl glass\nf 1 2 3\n";
    const struct {
        std::string materials;
        glm::vec4 color;
    } cases[] = {
        {"newmtl glass\nKd 1 0 0\nd 0.25\n", {1, 0, 0, 0.25F}},
        {"newmtl glass\r\n\tKd 1 0 0\r\n\tTr 0.75\r\n", {1, 0, 0, 0.25F}},
        {"newmtl glass\nd 0.25\nTr 0.25\nKd 1 0 0\n", {1, 0, 0, 0.25F}},
        {"newmtl other\nKd 0 0 1\nnewmtl glass\nKa 0 0 0\nKd 0.5\nillum 2\n",
         {0.5F, 0.5F, 0.5F, 1}},
        {"newmtl glass\n", {1, 1, 1, 1}},
    };
    for (const auto &c : cases) {
        SCOPED_TRACE(c.materials);
        directory.write("lib.mtl", c.materials);
        const auto loaded = kb::load_mesh(directory.write("m.obj", start));
        expect_one_color(loaded, c.color);
        EXPECT_EQ(loaded->colors_of, "materials");
        EXPECT_TRUE(loaded->notes.empty());
    }
}

TEST(LoadObj, EachFaceHasItsMaterial)
{
    const TempDirectory directory;
    directory.write("a.mtl", "newmtl red\nKd 1 0 0\n");
    directory.write("b.mtl", "newmtl blue\nKd 0 0 1\nd 0.5\n");
    const auto loaded = kb::load_mesh(directory.write(
        "m.obj", "mtllib a.mtl b.mtl\n" + points +
                     "f 1 2 3\nusemtl red\nf 1 2 3\nusemtl blue\nf 1 2 3\nusemtl red\nf 1 2 3\n"));
    ASSERT_TRUE(loaded) << loaded.error().message;
    const auto colors = corner_colors(*loaded);
    ASSERT_EQ(colors.size(), 12U);
    EXPECT_EQ(colors[0], glm::vec4(1, 1, 1, 1)) << "what has no material";
    EXPECT_EQ(colors[3], glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(colors[6], glm::vec4(0, 0, 1, 0.5F));
    EXPECT_EQ(colors[9], glm::vec4(1, 0, 0, 1));
}

TEST(LoadObj, ReadsColorsBehindCoordinates)
{
    const TempDirectory directory;
    expect_one_color(kb::load_mesh(directory.write("m.obj", "v 0 0 0 1 0.5 0\nv 1 0 0 1 0.5 0\n"
                                                            "v 0 1 0 1 0.5 0\nf 1 2 3\n")),
                     {1, 0.5F, 0, 1});
}

TEST(LoadObj, SaysWhatItLeavesOut)
{
    const TempDirectory directory;
    directory.write("lib.mtl", "newmtl red\nKd 1 0 0\nmap_Kd wood.png\n");
    const auto loaded = kb::load_mesh(directory.write(
        "m.obj", "mtllib lib.mtl no-such.mtl\n" + points +
                     "usemtl green\nf 1 2 3\nl 1 2\np 1\nsurf 0 1 0 1 1 2 3 4\nend\n"));
    for (const char *what : {"textures", "lines", "points", "free-form curves and surfaces",
                             "no-such.mtl is left out: no such file", "'green' is in no library"})
        expect_note(loaded, what);
}

TEST(LoadObj, RefusesWhatIsMalformed)
{
    const TempDirectory directory;
    directory.write("bad.mtl", "newmtl a\nKd 1 0\n");
    directory.write("range.mtl", "newmtl a\nd 25\n");
    directory.write("nan.mtl", "newmtl a\nd nan\n");
    directory.write("early.mtl", "Kd 1 0 0\n");
    const struct {
        std::string content;
        std::string mention;
    } files[] = {
        {"", "it is empty"},
        {points, "it has no triangles"},
        {points + "l 1 2 3\n", "it has no triangles"},
        {points + "f 1 2 5\n", "line 5: vertex 5 is used, but there are 4"},
        {points + "f 1 2 0\n", "line 5: vertex 0"},
        {points + "f 1 2 -5\n", "line 5: vertex -5"},
        {points + "f 1 2 99999999999\n", "line 5: vertex 99999999999"},
        {points + "f 1 2 x\n", "line 5: 'x' is no index"},
        {points + "f 1 2\n", "line 5: a face of 2 corners"},
        {points + "f 1//1 2//1 3//1\n", "line 5: normal 1 is used, but there are 0"},
        {points + "f 1/1/1/1 2 3\n", "line 5: '1/1/1/1' is no corner"},
        {"v 0 0\n" + points, "line 1: a vertex of 2 numbers"},
        {"v 0 0 1,5\n" + points, "line 1: '1,5' is no number"},
        {"v 0 0 x\n" + points, "line 1: 'x' is no number"},
        {points + "vn 0 1\n", "line 5: a normal of 2 numbers"},
        {"v nan 0 0\n" + points + "f 1 2 3\n", "vertex 0 is not finite"},
        {"v inf 0 0\n" + points + "f 1 2 3\n", "vertex 0 is not finite"},
        {"solid m\n", "line 1: no such statement: 'solid'"},
        {"mtllib bad.mtl\n", "line 1: bad.mtl: line 2: Kd has 2 numbers"},
        {"mtllib range.mtl\n", "line 1: range.mtl: line 2: d is not from 0 to 1"},
        {"mtllib nan.mtl\n", "line 1: nan.mtl: line 2: d is not from 0 to 1"},
        {"mtllib early.mtl\n", "line 1: early.mtl: line 1: Kd comes before"},
    };
    for (const auto &file : files) {
        SCOPED_TRACE(file.content);
        expect_refused(directory.write("m.obj", file.content), file.mention);
    }
}

} // namespace
