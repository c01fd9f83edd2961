// SPDX-License-Identifier: MIT
//
// Legacy VTK files: what every form of them gives, and what each thing that can be wrong is called.

#include "temp_directory.hpp"
#include "tet_grid.hpp"
#include "tet_grid_file.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace
{

using kb::test::TempDirectory;
using kb::test::two_cells;
using kb::test::vtk_file;
using kb::test::VtkForm;

constexpr std::array all_forms{VtkForm::ascii, VtkForm::binary, VtkForm::ascii_5,
                               VtkForm::binary_5};

/// Empty if there is none.
std::string error_of(const std::string &content)
{
    const auto grid = kb::parse_tet_grid(content);
    if (grid)
        return {};
    EXPECT_EQ(grid.error().message.find('\n'), std::string::npos) << grid.error().message;
    return grid.error().message;
}

std::string error_of(const kb::TetGrid &grid)
{
    const std::string error = error_of(vtk_file(grid, VtkForm::binary));
    EXPECT_EQ(error_of(vtk_file(grid, VtkForm::binary_5)), error);
    return error;
}

/// The ASCII file of two cells with one piece of text in the place of another.
std::string with(const std::string &old_text, const std::string &new_text,
                 VtkForm form = VtkForm::ascii)
{
    std::string content = vtk_file(two_cells(), form);
    const std::size_t at = content.find(old_text);
    EXPECT_NE(at, std::string::npos) << old_text;
    return content.replace(at, old_text.size(), new_text);
}

void expect_same(const kb::TetGrid &grid, const kb::TetGrid &expected)
{
    EXPECT_EQ(grid.points, expected.points);
    EXPECT_EQ(grid.cells, expected.cells);
    ASSERT_EQ(grid.fields.size(), expected.fields.size());
    for (std::size_t i = 0; i < grid.fields.size(); ++i) {
        EXPECT_EQ(grid.fields[i].name, expected.fields[i].name);
        EXPECT_EQ(grid.fields[i].values, expected.fields[i].values);
    }
}

TEST(LoadTetGrid, ReadsEveryFormOfTheFile)
{
    for (const VtkForm form : all_forms) {
        const auto grid = kb::parse_tet_grid(vtk_file(two_cells(), form));
        ASSERT_TRUE(grid) << grid.error().message;
        expect_same(*grid, two_cells());
    }
}

TEST(LoadTetGrid, ReadsWhatIsNotAGridOfFloats)
{
    const auto grid =
        kb::parse_tet_grid("# vtk DataFile Version 2.0\r\na test\r\nascii\r\n"
                           "dataset unstructured_grid\r\nPOINTS 4 double\r\n0 0 0  1 0 0  0 1 0\r\n"
                           "0 0 1e+0\r\nCELLS 1 5\r\n4 0 1 2 3\r\nCELL_TYPES 1\r\n10\r\n"
                           "CELL_DATA 1\r\nSCALARS material int\r\nLOOKUP_TABLE default\r\n7\r\n"
                           "POINT_DATA 4\r\nSCALARS small unsigned_char 1\r\n1 2 3 250\r\n");
    ASSERT_TRUE(grid) << grid.error().message;
    ASSERT_EQ(grid->fields.size(), 1U) << "values of cells are no field";
    EXPECT_EQ(grid->fields[0].name, "small");
    EXPECT_EQ(grid->fields[0].values, (std::vector<float>{1, 2, 3, 250}));
}

TEST(LoadTetGrid, ReadsArraysAmongOtherSections)
{
    const auto grid =
        kb::parse_tet_grid(vtk_file(two_cells(), VtkForm::ascii) +
                           "METADATA\nINFORMATION 0\n\n"
                           "VECTORS velocity double\n3 4 0  0 0 2  0 0 0  1 2 2  0 0 1e-60\n"
                           "TEXTURE_COORDINATES uv 2 float\n0 0 0 0 0 0 0 0 0 0\n"
                           "COLOR_SCALARS tint 3\n0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n"
                           "LOOKUP_TABLE colors 1\n0 0 0 1\n"
                           "FIELD FieldData 2\nage%20in%20s 1 5 int\n1 2 3 4 5\n"
                           "METADATA\nINFORMATION 0\n\npair 2 5 float\n3 4 0 0 0 0 0 0 0 0\n"
                           "NORMALS up float\n0 0 1 0 0 1 0 0 1 0 0 1 0 0 1\n");
    ASSERT_TRUE(grid) << grid.error().message;
    ASSERT_EQ(grid->fields.size(), 6U);
    EXPECT_EQ(grid->fields[2].name, "velocity");
    EXPECT_EQ(grid->fields[2].values, (std::vector<float>{5, 2, 0, 3, 0})) << "magnitudes";
    EXPECT_EQ(grid->fields[3].name, "age in s");
    EXPECT_EQ(grid->fields[4].values, (std::vector<float>{5, 0, 0, 0, 0}));
}

TEST(LoadTetGrid, FindsFieldsByName)
{
    const kb::TetGrid grid = two_cells();
    EXPECT_EQ(*kb::find_field(grid, ""), &grid.fields[0]);
    EXPECT_EQ(*kb::find_field(grid, "pressure"), &grid.fields[1]);
    EXPECT_EQ(kb::find_field(grid, "speed").error().message,
              "there is no scalar field 'speed', but temperature, pressure");
}

TEST(LoadTetGrid, NamesTheFile)
{
    const TempDirectory directory;
    const auto file = directory.write("grid.vtk", vtk_file(two_cells(), VtkForm::binary));
    const auto grid = kb::load_tet_grid(file);
    ASSERT_TRUE(grid) << grid.error().message;
    expect_same(*grid, two_cells());
    EXPECT_EQ(kb::load_tet_grid(directory.write("empty.vtk", "")).error().message,
              "cannot read the grid " + (directory / "empty.vtk").string() +
                  ": it is no legacy VTK file (scripts/convert-grid makes one of other formats)");
    EXPECT_TRUE(
        kb::load_tet_grid(directory / "none.vtk").error().message.ends_with(": no such file"));
    EXPECT_TRUE(
        kb::load_tet_grid(directory / ".").error().message.ends_with(": it is a directory"));
}

TEST(LoadTetGrid, SaysHowToConvertOtherFormats)
{
    EXPECT_EQ(error_of("<VTKFile type=\"UnstructuredGrid\">"),
              "it is no legacy VTK file (scripts/convert-grid makes one of other formats)");
    EXPECT_EQ(error_of(""), error_of("<VTKFile>"));
    EXPECT_EQ(
        error_of(with("UNSTRUCTURED_GRID", "STRUCTURED_GRID")),
        "its data set is 'STRUCTURED_GRID', not UNSTRUCTURED_GRID (scripts/convert-grid makes "
        "tetrahedra of it)");
    EXPECT_EQ(error_of("# vtk DataFile Version 3.0\na\nASCII\nDATASET POLYDATA\n"),
              "its data set is POLYDATA, not UNSTRUCTURED_GRID: a surface has no cells");
    EXPECT_EQ(error_of(with("CELL_TYPES 2\n10 10", "CELL_TYPES 2\n10 12")),
              "cell 1 is a hexahedron (type 12); scripts/convert-grid makes tetrahedra of it");
    EXPECT_EQ(error_of(with("CELL_TYPES 2\n10", "CELL_TYPES 2\n24")),
              "cell 0 is no tetrahedron (type 24); scripts/convert-grid makes tetrahedra of it");
}

TEST(LoadTetGrid, NamesWhatIsWrongWithTheHeader)
{
    EXPECT_EQ(error_of(with("ASCII", "ASCI")), "it is 'ASCI', not ASCII or BINARY");
    EXPECT_EQ(error_of(with("ASCII", "\x1B[2J\xFF")), "it is '?[2J?', not ASCII or BINARY")
        << "what a terminal would obey is not printed";
    EXPECT_EQ(error_of(with("DATASET", "DATA")), "its header names no DATASET");
    EXPECT_EQ(error_of("# vtk DataFile Version 3.0\n"), "it is '', not ASCII or BINARY");
}

TEST(LoadTetGrid, NamesWrongCounts)
{
    EXPECT_EQ(error_of(with("POINTS 5", "POINTS -5")), "the number of points is '-5'");
    EXPECT_EQ(error_of(with("POINTS 5", "POINTS many")), "the number of points is 'many'");
    EXPECT_EQ(error_of(with("POINTS 5", "POINTS 4")), "'0' stands where a section should begin");
    EXPECT_EQ(error_of(with("POINTS 5", "POINTS 6")), "'CELLS' is no number of its type");
    EXPECT_EQ(error_of(with("POINTS 5", "POINTS 9223372036854775807")), "it ends early");
    EXPECT_EQ(error_of(with("POINTS 5", "POINTS 9223372036854775808")),
              "the number of points is '9223372036854775808'");
    EXPECT_EQ(error_of(with("CELLS 2 10", "CELLS 3 10")), "it says 3 cells, but has 2");
    EXPECT_EQ(error_of(with("CELLS 2 10\n4", "CELLS 2 10\n9")), "it says 2 cells, but has 1");
    EXPECT_EQ(error_of(with("CELLS 2 10\n4", "CELLS 2 10\n-4")),
              "cell 0 has -4 points, but 9 numbers are left");
    EXPECT_EQ(error_of(with("CELLS 2 10\n4", "CELLS 2 10\n90")),
              "cell 0 has 90 points, but 9 numbers are left");
    EXPECT_EQ(error_of(with("CELLS 2 10\n4 0 1 2 3 4", "CELLS 2 11\n5 0 1 2 3 4 4")),
              "cell 0 is a tetrahedron of 5 points");
    EXPECT_EQ(error_of(with("CELL_TYPES 2\n10 10", "CELL_TYPES 1\n10")),
              "there are 2 cells, but 1 cell types");
    EXPECT_EQ(error_of(with("CELL_TYPES 2\n10 10", "")), "there are 2 cells, but 0 cell types");
    EXPECT_EQ(error_of(with("POINT_DATA 5", "POINT_DATA 4")),
              "'-4' stands where a section should begin");
    EXPECT_EQ(error_of(with("POINT_DATA 5", "POINT_DATA 6")), "'SCALARS' is no number of its type");
    EXPECT_EQ(error_of(vtk_file(two_cells(), VtkForm::ascii) + "FIELD f 1\na 1 3 float\n1 2 3\n"),
              "the field 'a' has 3 values, but there are 5 points");
    EXPECT_EQ(error_of(with("CELLS 2 10\n4 0", "CELLS 2 10\n4 0.5")),
              "'0.5' is no number of its type");
}

TEST(LoadTetGrid, NamesWrongOffsets)
{
    const std::string wrong =
        "the offsets of its cells do not ascend from 0 to the end of the list";
    const auto with_offsets = [](const std::string &offsets) {
        return error_of(with("0 4 8 ", offsets, VtkForm::ascii_5));
    };
    EXPECT_EQ(with_offsets("0 4 8 "), "");
    EXPECT_EQ(with_offsets("0 9 8 "), wrong);
    EXPECT_EQ(with_offsets("0 4 9 "), wrong);
    EXPECT_EQ(with_offsets("0 4 7 "), wrong);
    EXPECT_EQ(with_offsets("-4 4 8 "), wrong);
    EXPECT_EQ(with_offsets("0 3 8 "), "cell 0 is a tetrahedron of 3 points");
    EXPECT_EQ(error_of(with("OFFSETS", "OFFSET", VtkForm::ascii_5)),
              "'OFFSET' stands where OFFSETS should");
    EXPECT_EQ(error_of(with("OFFSETS vtktypeint64", "OFFSETS vtktypefloat", VtkForm::ascii_5)),
              "it has numbers of type 'vtktypefloat'");
}

TEST(LoadTetGrid, NamesIndicesOutOfRange)
{
    kb::TetGrid grid = two_cells();
    grid.cells[1][2] = 5;
    EXPECT_EQ(error_of(grid), "cell 1 has point 5, but there are 5 points");
    grid.cells[1][2] = 0xFFFFFFFF;
    EXPECT_EQ(error_of(vtk_file(grid, VtkForm::binary)),
              "cell 1 has point -1, but there are 5 points");
    EXPECT_EQ(error_of(vtk_file(grid, VtkForm::binary_5)),
              "cell 1 has point 4294967295, but there are 5 points");
    EXPECT_EQ(error_of(with("0 4 8 \nCONNECTIVITY vtktypeint64\n0",
                            "0 4 8\nCONNECTIVITY vtktypeint64\n4294967296", VtkForm::ascii_5)),
              "cell 0 has point 4294967296, but there are 5 points")
        << "not narrowed to point 0";
}

TEST(LoadTetGrid, NamesWhatIsNotFinite)
{
    kb::TetGrid grid = two_cells();
    grid.fields[1].values[3] = std::nanf("");
    EXPECT_EQ(error_of(grid), "the value of 'pressure' at point 3 is not a number");
    EXPECT_EQ(error_of(vtk_file(grid, VtkForm::ascii)), error_of(grid));
    grid.fields[1].values[3] = -INFINITY;
    EXPECT_EQ(error_of(grid), "the value of 'pressure' at point 3 is infinite");
    grid.points[4].y = std::nanf("");
    EXPECT_EQ(error_of(grid), "point 4 is not finite");
    EXPECT_EQ(error_of(with("-4 ", "-4e99 ")), "the value of 'temperature' at point 4 is infinite");
    EXPECT_EQ(error_of(with("-4 ", "-4e-99 ")), "") << "too small for a float is zero";
}

TEST(LoadTetGrid, NamesMissingScalarsAndCells)
{
    kb::TetGrid grid = two_cells();
    grid.fields.clear();
    EXPECT_EQ(error_of(grid), "it has no scalars at its points");
    EXPECT_EQ(error_of(vtk_file(grid, VtkForm::ascii) + "CELL_DATA 2\nSCALARS a int\n1 2\n"),
              "it has values for its cells alone; scripts/convert-grid makes values of points of "
              "them");
    grid.cells.clear();
    EXPECT_EQ(error_of(grid), "it has no cells");
    EXPECT_EQ(error_of("# vtk DataFile Version 3.0\na\nASCII\nDATASET UNSTRUCTURED_GRID\n"),
              "it has no cells");
}

TEST(LoadTetGrid, NamesUnknownTypesAndSections)
{
    EXPECT_EQ(error_of(with("POINTS 5 float", "POINTS 5 quaternion")),
              "it has numbers of type 'quaternion'");
    EXPECT_EQ(error_of(with("SCALARS temperature", "SCALRAS temperature")),
              "'SCALRAS' stands where a section should begin");
    EXPECT_EQ(error_of(vtk_file(two_cells(), VtkForm::ascii) + "FIELD f 1\nnote 1 1 string\nhello"),
              "it has numbers of type 'string'");
}

TEST(LoadTetGrid, EveryFileThatIsCutOffIsRefused)
{
    for (const VtkForm form : all_forms) {
        kb::TetGrid grid = two_cells();
        grid.fields.resize(1);
        const std::string content = vtk_file(grid, form);
        const bool is_binary = form == VtkForm::binary || form == VtkForm::binary_5;
        // The last line's end says nothing; in ASCII, neither does the blank before, and what is
        // left of a number that is cut off is a number, but for the sign.
        const std::size_t whole = content.size() - (is_binary ? 1 : 3);
        for (std::size_t size = 0; size < whole; ++size) {
            const std::string error = error_of(content.substr(0, size));
            ASSERT_FALSE(error.empty()) << "of " << content.size() << " bytes, the first " << size;
        }
    }
    std::string content = vtk_file(two_cells(), VtkForm::binary);
    EXPECT_EQ(error_of(content.substr(0, content.size() - 2)),
              "a block of 5 binary numbers is cut off");
}

TEST(LoadTetGrid, FilesWithAnyByteChangedAreReadOrRefused)
{
    for (const VtkForm form : all_forms) {
        const std::string content = vtk_file(two_cells(), form);
        std::size_t refused = 0;
        for (std::size_t at = 0; at < content.size(); ++at) {
            for (const char byte : {'\0', '9', ' ', '\n', '\x7F', '\xFF'}) {
                std::string changed = content;
                changed[at] = byte;
                const auto grid = kb::parse_tet_grid(changed);
                ASSERT_TRUE(!grid || kb::check_tet_grid(*grid));
                refused += grid ? 0 : 1;
            }
        }
        EXPECT_GT(refused, content.size()) << "of six changes of a byte, one is noticed";
    }
}

TEST(LoadTetGrid, NamesCellsThatRepairCanMend)
{
    kb::TetGrid grid = two_cells();
    std::swap(grid.cells[1][0], grid.cells[1][1]);
    EXPECT_EQ(error_of(grid), "cell 1 is inverted (--repair turns such cells)");
    grid.cells[0] = {0, 1, 2, 2};
    EXPECT_EQ(error_of(grid), "cell 0 has no volume (--repair leaves such cells out)");
}

TEST(LoadTetGrid, RepairTurnsInvertedCellsAndLeavesFlatOnesOut)
{
    const kb::TetGrid good = two_cells();
    kb::TetGrid grid = good;
    std::swap(grid.cells[1][1], grid.cells[1][2]);
    grid.cells.insert(grid.cells.begin(), {0, 1, 2, 2});
    grid.cells.push_back({1, 1, 1, 1});
    const TempDirectory directory;
    kb::GridRepairs repairs;
    const auto repaired = kb::load_and_repair_tet_grid(
        directory.write("grid.vtk", vtk_file(grid, VtkForm::binary)), repairs);
    ASSERT_TRUE(repaired) << repaired.error().message;
    expect_same(*repaired, good);
    EXPECT_EQ(repairs.left_out, 2U);
    EXPECT_EQ(repairs.turned, 1U);

    grid.cells = {{0, 1, 2, 2}};
    const auto nothing = kb::load_and_repair_tet_grid(
        directory.write("flat.vtk", vtk_file(grid, VtkForm::binary)), repairs);
    ASSERT_FALSE(nothing);
    EXPECT_TRUE(nothing.error().message.ends_with("flat.vtk: it has no cells"));

    grid.cells = {{0, 1, 2, 5}};
    EXPECT_FALSE(kb::load_and_repair_tet_grid(
        directory.write("range.vtk", vtk_file(grid, VtkForm::binary)), repairs))
        << "what cannot be repaired is refused";
}

TEST(LoadPointSet, ReadsPolygonalDataAndGridsOfAnyCells)
{
    const TempDirectory directory;
    const auto particles = kb::load_point_set(
        directory.write("particles.vtk", "# vtk DataFile Version 3.0\nparticles\nASCII\n"
                                         "DATASET POLYDATA\nPOINTS 2 float\n0 0 0 1 2 3\n"
                                         "VERTICES 1 3\n2 0 1\nPOINT_DATA 2\n"
                                         "SCALARS mass float\nLOOKUP_TABLE default\n4 5\n"));
    ASSERT_TRUE(particles) << particles.error().message;
    EXPECT_EQ(particles->points, (std::vector<glm::vec3>{{0, 0, 0}, {1, 2, 3}}));
    EXPECT_EQ((*kb::find_field(particles->fields, "mass"))->values, (std::vector<float>{4, 5}));

    const auto corners = kb::load_point_set(
        directory.write("grid.vtk", with("CELL_TYPES 2\n10 10", "CELL_TYPES 2\n10 12")));
    ASSERT_TRUE(corners) << corners.error().message;
    EXPECT_EQ(corners->points, two_cells().points);
}

TEST(LoadPointSet, NamesWhatIsWrong)
{
    const TempDirectory directory;
    const auto error = [&](const std::string &body) {
        const auto set = kb::load_point_set(directory.write(
            "p.vtk", "# vtk DataFile Version 3.0\np\nASCII\nDATASET POLYDATA\n" + body));
        return set ? "" : set.error().message.substr(set.error().message.rfind(": ") + 2);
    };
    EXPECT_EQ(error(""), "it has no points");
    EXPECT_EQ(error("POINTS 1 float\n0 0 0\n"), "it has no scalars at its points");
    EXPECT_EQ(error("POINTS 1 float\n0 0 0\nPOINT_DATA 1\nSCALARS a float\nnan\n"),
              "the value of 'a' at point 0 is not a number");
    EXPECT_EQ(error("POINTS 1 float\n0 0 0\nPOINT_DATA 2\nSCALARS a float\n1 2\n"),
              "the field 'a' has 2 values, but there are 1 points");
}

} // namespace
