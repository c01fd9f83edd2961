// SPDX-License-Identifier: MIT

#include "tests/lib/io/loaded_mesh.hpp"
#include "tests/support/temp_directory.hpp"

#include <cstring>

namespace
{

using namespace kb::test;

struct Facet {
    glm::vec3 normal;
    std::array<glm::vec3, 3> corners;
    std::uint16_t attribute = 0;
};

const std::vector<Corners> tetrahedron{{{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}},
                                       {{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}},
                                       {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                                       {{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}}}};

glm::vec3 normal_of(const Corners &c)
{
    return glm::vec3(glm::normalize(glm::cross(c[1] - c[0], c[2] - c[0])));
}

/// The facets of the tetrahedron, with a normal that is zero if that is wanted.
std::vector<Facet> facets(bool zero_normals = false)
{
    std::vector<Facet> facets;
    for (const Corners &c : tetrahedron)
        facets.push_back({zero_normals ? glm::vec3(0.0F) : normal_of(c),
                          {glm::vec3(c[0]), glm::vec3(c[1]), glm::vec3(c[2])}});
    return facets;
}

std::string binary(const std::vector<Facet> &facets, std::string comment = "made for a test")
{
    comment.resize(80, ' ');
    const auto count = static_cast<std::uint32_t>(facets.size());
    comment.append(reinterpret_cast<const char *>(&count), 4);
    for (const Facet &facet : facets) {
        comment.append(reinterpret_cast<const char *>(&facet.normal), 12);
        comment.append(reinterpret_cast<const char *>(facet.corners.data()), 36);
        comment.append(reinterpret_cast<const char *>(&facet.attribute), 2);
    }
    return comment;
}

const std::string facet_text = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                               "vertex 0 1 0\nendloop\nendfacet\n";

void expect_flat_normals(const kb::LoadedMesh &loaded)
{
    for (std::size_t i = 0; i < tetrahedron.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_LE(glm::distance(loaded.mesh.normals[loaded.mesh.indices[3 * i + c]],
                                    normal_of(tetrahedron[i])),
                      1e-6F);
}

TEST(LoadStl, ReadsBinaryFilesWithAnyCommentAndTail)
{
    const TempDirectory directory;
    for (const std::string comment : {"", "solid in name only"}) {
        const std::string whole = binary(facets(), comment);
        expect_triangles(kb::load_mesh(directory.write("m.stl", whole)), tetrahedron);
        for (const std::string &tail : {std::string("\r\n"), std::string(7, '\0')}) {
            const auto loaded = kb::load_mesh(directory.write("tail.stl", whole + tail));
            expect_triangles(loaded, tetrahedron);
            EXPECT_TRUE(loaded->notes.empty());
        }
        expect_note(kb::load_mesh(directory.write("tail.stl", whole + whole.substr(84))),
                    "200 bytes behind its 4 facets");
    }
}

TEST(LoadStl, ReadsAsciiFilesOfSeveralSolids)
{
    const TempDirectory directory;
    const std::string solid = "solid with a name\n" + facet_text + "endsolid with a name\n";
    expect_triangles(kb::load_mesh(directory.write("m.stl", solid)),
                     {{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}});
    std::string loud = solid + "\n" + solid;
    for (char &c : loud)
        c = static_cast<char>(std::toupper(c));
    const auto twice = kb::load_mesh(directory.write("m.stl", loud));
    ASSERT_TRUE(twice) << twice.error().message;
    EXPECT_EQ(twice->mesh.triangle_count(), 2U);
}

TEST(LoadStl, ComputesNormalsThatAreZeroOrNaN)
{
    const TempDirectory directory;
    auto odd = facets(true);
    odd[1].normal.x = std::nanf("");
    odd[2].normal = -3.0F * facets()[2].normal; // A length that is not 1 is made 1.
    const auto given = kb::load_mesh(directory.write("m.stl", binary(odd)));
    ASSERT_TRUE(given) << given.error().message;
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_LE(glm::distance(given->mesh.normals[given->mesh.indices[6 + c]],
                                -normal_of(tetrahedron[2])),
                  1e-6F);
    odd[2].normal = glm::vec3(0.0F);
    const auto computed = kb::load_mesh(directory.write("m.stl", binary(odd)));
    ASSERT_TRUE(computed) << computed.error().message;
    expect_flat_normals(*computed);
}

TEST(LoadStl, ReadsColorsOfFacets)
{
    const TempDirectory directory;
    auto colored = facets();
    for (Facet &facet : colored)
        facet.attribute = 0x8000U | 31U << 10U; // VisCAM: red is on top.
    expect_one_color(kb::load_mesh(directory.write("viscam.stl", binary(colored))), {1, 0, 0, 1});
    for (Facet &facet : colored)
        facet.attribute = 31U; // Magics: red is below.
    const std::string comment("COLOR=\xff\xff\0\x33", 10);
    expect_one_color(kb::load_mesh(directory.write("magics.stl", binary(colored, comment))),
                     {1, 0, 0, 0.2F});
    for (Facet &facet : colored)
        facet.attribute = 0x8000U;
    expect_one_color(kb::load_mesh(directory.write("whole.stl", binary(colored, comment))),
                     {1, 1, 0, 0.2F});
    const auto none = kb::load_mesh(directory.write("none.stl", binary(facets())));
    ASSERT_TRUE(none) << none.error().message;
    EXPECT_TRUE(none->mesh.colors.empty());
}

TEST(LoadStl, RefusesWhatIsMalformed)
{
    const TempDirectory directory;
    const std::string whole = binary(facets());
    auto nan = facets();
    nan[2].corners[1].y = std::nanf("");
    const std::string solid = "solid m\n" + facet_text;
    const auto replaced = [&](const std::string &what, const std::string &by) {
        std::string text = solid + "endsolid m\n";
        return text.replace(text.find(what), what.size(), by);
    };
    const struct {
        std::string content;
        std::string mention;
    } files[] = {
        {"", "it is empty"},
        {whole.substr(0, 50), "it ends early"},
        {whole.substr(0, 84 + 149), "it has 2 of 4 facets"},
        {whole.substr(0, whole.size() - 1), "it has 3 of 4 facets"},
        {binary({}), "it has no triangles"},
        {binary(nan), "vertex 7 is not finite"},
        {solid, "'endsolid' is missing"},
        {solid.substr(0, solid.size() - 10), "it ends early"},
        {"solid m\nendsolid m\n", "it has no triangles"},
        {replaced("vertex 0 1 0\n", ""), "line 6: 'vertex' is missing"},
        {replaced("vertex 0 1 0\n", "vertex 0 1 0\nvertex 0 1 1\n"),
         "line 7: 'endloop' is missing"},
        {replaced("0 1 0", "0 1"), "line 6: a number is missing"},
        {replaced("0 1 0", "0 1 0 0"), "line 6: it has more than three numbers"},
        {replaced("0 1 0", "0 1 0,5"), "line 6: '0,5' is no number"},
        {replaced("0 1 0", "0 nan 0"), "vertex 2 is not finite"},
        {replaced("outer loop", "outer"), "line 3: 'outer loop' is missing"},
    };
    for (const auto &file : files) {
        SCOPED_TRACE(file.mention);
        expect_refused(directory.write("m.stl", file.content), file.mention);
    }
}

} // namespace
