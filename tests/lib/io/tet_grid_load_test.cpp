// SPDX-License-Identifier: MIT
//
// Legacy VTK files: what every form of them gives, and what each thing that can be wrong is called.

#include "lib/io/tet_grid.hpp"
#include "tests/lib/io/tet_grid_file.hpp"
#include "tests/support/temp_directory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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

/// Of drawing a field.
std::string fault_of(const std::string &content, const std::string &field)
{
    const auto grid = kb::parse_tet_grid(content);
    if (!grid)
        return grid.error().message;
    const auto found = kb::find_field(*grid, field);
    return found ? "" : found.error().message;
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

TEST(LoadTetGrid, ReadsBitsAndPassesTextOver)
{
    const std::string content = vtk_file(two_cells(), VtkForm::ascii);
    const auto grid = kb::parse_tet_grid(
        content + "FIELD FieldData 4\n"
                  "label 1 5 string\nhello%20world\n\nPOINTS\n3 4\n\n"
                  "kind 1 5 variant\n6 1\n11 2.5\n13 a%20b\n13 \n6 1\n"
                  "mask 1 5 bit\n1 0 0 1 1\nid 1 5 int\n1 2 3 4 5\n"
                  "SCALARS note utf8_string\nLOOKUP_TABLE default\na\nb\nc\nd\ne\n"
                  "CELL_DATA 2\nPEDIGREE_IDS name string\nleft\nright\n");
    ASSERT_TRUE(grid) << grid.error().message;
    ASSERT_EQ(grid->fields.size(), 4U);
    EXPECT_EQ(grid->fields[2].name, "mask");
    EXPECT_EQ(grid->fields[2].values, (std::vector<float>{1, 0, 0, 1, 1}));
    EXPECT_EQ(grid->fields[3].values, (std::vector<float>{1, 2, 3, 4, 5}));

    // Text has its size before it, in one byte or in two; of a variant nothing is binary. Bits are
    // eight in a byte.
    const std::string long_text(100, 'x');
    const auto binary = kb::parse_tet_grid(
        vtk_file(two_cells(), VtkForm::binary) +
        "FIELD FieldData 4\nlabel 1 5 string\n\xC1"
        "a\xC0\xCBhello world\x80\x64" +
        long_text +
        "\xC1\n\nkind 1 5 variant\n6 1\n11 2.5\n13 a%20b\n13 \n6 1\n\nmask 2 5 bit\n\x80\x40\n"
        "id 1 5 unsigned_char\n\x01\x02\x03\x04\x05\n");
    ASSERT_TRUE(binary) << binary.error().message;
    ASSERT_EQ(binary->fields.size(), 4U);
    EXPECT_EQ(binary->fields[2].name, "mask");
    EXPECT_EQ(binary->fields[2].components, 2U);
    EXPECT_EQ(binary->fields[2].values, (std::vector<float>{1, 0, 0, 0, 1}));
    EXPECT_EQ(binary->fields[3].values, (std::vector<float>{1, 2, 3, 4, 5}));
}

TEST(LoadTetGrid, PassesEmptyLinesAndAByteOrderMarkOver)
{
    for (const VtkForm form : all_forms) {
        const std::string word =
            form == VtkForm::ascii || form == VtkForm::ascii_5 ? "ASCII" : "BINARY";
        const auto grid =
            kb::parse_tet_grid("\xEF\xBB\xBF" + with(word, "\n\n" + word + "\n", form));
        ASSERT_TRUE(grid) << grid.error().message;
        expect_same(*grid, two_cells());
    }
}

/// The bytes of each binary number of the file the other way round.
std::string little_endian(std::string content)
{
    const auto turn = [&content](const std::string &before, std::size_t size, std::size_t count) {
        const std::size_t first = content.find(before) + before.size();
        for (std::size_t i = 0; i < count; ++i)
            std::reverse(content.begin() + std::ptrdiff_t(first + i * size),
                         content.begin() + std::ptrdiff_t(first + (i + 1) * size));
    };
    turn("POINTS 5 float\n", 4, 15);
    if (content.find("OFFSETS") == std::string::npos) {
        turn("CELLS 2 10\n", 4, 10);
    } else {
        turn("OFFSETS vtktypeint64\n", 8, 3);
        turn("CONNECTIVITY vtktypeint64\n", 8, 8);
    }
    turn("CELL_TYPES 2\n", 4, 2);
    turn("temperature float\nLOOKUP_TABLE default\n", 4, 5);
    turn("pressure float\nLOOKUP_TABLE default\n", 4, 5);
    return content;
}

TEST(LoadTetGrid, NamesTheWrongByteOrder)
{
    const std::string error = "its binary numbers are little-endian, which the format forbids "
                              "(scripts/convert-grid reads them)";
    for (const VtkForm form : {VtkForm::binary, VtkForm::binary_5})
        EXPECT_EQ(error_of(little_endian(vtk_file(two_cells(), form))), error);
    // Of points alone: 1 is 4.6e-41 then.
    const TempDirectory directory;
    const auto points = kb::load_point_set(directory.write(
        "points.vtk", std::string("# vtk DataFile Version 3.0\np\nBINARY\nDATASET POLYDATA\n"
                                  "POINTS 1 float\n") +
                          std::string("\0\0\x80\x3F\0\0\0\0\0\0\0\0", 12) +
                          "\nPOINT_DATA 1\nSCALARS a unsigned_char\nLOOKUP_TABLE default\n\x01\n"));
    ASSERT_FALSE(points);
    EXPECT_TRUE(points.error().message.ends_with(error)) << points.error().message;
}

TEST(LoadTetGrid, PointsThatNoCellHasAreLeftOut)
{
    kb::TetGrid grid = two_cells();
    grid.points.insert(grid.points.begin() + 1, glm::vec3(1e9F, std::nanf(""), 0.0F));
    for (glm::uvec4 &cell : grid.cells) {
        for (int corner = 0; corner < 4; ++corner)
            cell[corner] += cell[corner] >= 1;
    }
    for (kb::ScalarField &field : grid.fields)
        field.values.insert(field.values.begin() + 1, INFINITY);
    for (const VtkForm form : all_forms) {
        const auto read = kb::parse_tet_grid(vtk_file(grid, form));
        ASSERT_TRUE(read) << read.error().message;
        EXPECT_EQ(read->unused_points, 1U);
        expect_same(*read, two_cells());
    }
    // What is wrong with others is named by their place in the file.
    grid.fields[1].values[4] = std::nanf("");
    const auto read = kb::parse_tet_grid(vtk_file(grid, VtkForm::binary));
    ASSERT_TRUE(read);
    EXPECT_EQ(kb::find_field(*read, "pressure").error().message,
              "the value of 'pressure' at point 4 is not a number (--field may be temperature)");
    grid.points[4].x = INFINITY;
    EXPECT_EQ(error_of(grid), "point 4 is not finite");
}

TEST(LoadTetGrid, LargeOffsetsAreTakenOffInDoublePrecision)
{
    // A box of a millimeter on a map, and pressures that differ by less than a float's last place.
    const auto at = [](const char *x, const char *y, const char *z) {
        return std::string(x) + ' ' + y + ' ' + z + '\n';
    };
    const std::string cells = "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\nPOINT_DATA 4\n";
    for (const std::string type : {"double", "float"}) {
        const auto grid = kb::parse_tet_grid(
            "# vtk DataFile Version 3.0\nfar\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 " + type +
            '\n' + at("615850.001", "5846925", "758") + at("615850.002", "5846925", "758") +
            at("615850.001", "5846925.001", "758") + at("615850.001", "5846925", "758.001") +
            cells + "SCALARS p " + type + "\n101325.001 101325.002 101325.003 101325.004\n");
        ASSERT_TRUE(grid) << grid.error().message;
        EXPECT_EQ(grid->origin, glm::dvec3(615850.001, 5846925, 758));
        // A double of 5846925 has steps of 9.3e-10, a float of 0.001 has steps of 1.2e-10.
        EXPECT_NEAR(grid->points[1].x, 1e-3, 1e-9);
        EXPECT_NEAR(grid->points[2].y, 1e-3, 1e-9);
        EXPECT_NEAR(grid->points[3].z, 1e-3, 1e-9);
        const kb::ScalarField &field = grid->fields.front();
        EXPECT_EQ(field.offset, 101325.001);
        for (std::size_t i = 0; i < 4; ++i)
            EXPECT_NEAR(field.values[i], 1e-3 * double(i), 1e-9);
    }
    // Where floats do there is no offset: numbers are what they are in the file.
    const auto near = kb::parse_tet_grid(
        "# vtk DataFile Version 3.0\nnear\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n" +
        at("0.1", "0", "0") + at("0.9", "0", "0") + at("0.1", "0.3", "0") + at("0.1", "0", "0.7") +
        cells + "SCALARS p double\n0.1 -0.2 0.3 1e-60\n");
    ASSERT_TRUE(near) << near.error().message;
    EXPECT_EQ(near->origin, glm::dvec3(0.0));
    EXPECT_EQ(near->points[3], glm::vec3(0.1F, 0.0F, 0.7F));
    EXPECT_EQ(near->fields.front().values, (std::vector<float>{0.1F, -0.2F, 0.3F, 0.0F}));
}

TEST(LoadTetGrid, AFaultOfAFieldIsNoneOfTheOthers)
{
    kb::TetGrid grid = two_cells();
    grid.fields[0].values[3] = std::nanf("");
    for (const VtkForm form : all_forms) {
        const bool is_binary = form == VtkForm::binary || form == VtkForm::binary_5;
        const auto read = kb::parse_tet_grid(vtk_file(grid, form) + "FIELD f 1\na 1 3 char\n" +
                                             (is_binary ? "\x01\x01\x01" : "1 1 1") + '\n');
        ASSERT_TRUE(read) << read.error().message;
        const auto pressure = kb::find_field(*read, "pressure");
        ASSERT_TRUE(pressure) << pressure.error().message;
        EXPECT_EQ((*pressure)->values, grid.fields[1].values);
        EXPECT_FALSE(kb::find_field(*read, "a"));
        EXPECT_EQ(kb::find_field(*read, "").error().message,
                  "the value of 'temperature' at point 3 is not a number (--field may be pressure)")
            << "no other field is taken in its place";
    }
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
    EXPECT_EQ(
        fault_of(vtk_file(two_cells(), VtkForm::ascii) + "FIELD f 1\na 1 3 float\n1 2 3\n", "a"),
        "the field 'a' has 3 values, but there are 5 points (--field may be temperature, "
        "pressure)");
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
    const std::string other = " (--field may be temperature)";
    EXPECT_EQ(fault_of(vtk_file(grid, VtkForm::binary), "pressure"),
              "the value of 'pressure' at point 3 is not a number" + other);
    EXPECT_EQ(fault_of(vtk_file(grid, VtkForm::ascii), "pressure"),
              fault_of(vtk_file(grid, VtkForm::binary), "pressure"));
    grid.fields[1].values[3] = -INFINITY;
    EXPECT_EQ(fault_of(vtk_file(grid, VtkForm::binary_5), "pressure"),
              "the value of 'pressure' at point 3 is infinite" + other);
    grid.points[4].y = std::nanf("");
    EXPECT_EQ(error_of(grid), "point 4 is not finite");
    const auto with_value = [](const std::string &value) {
        return fault_of(with("-4 ", value), "temperature");
    };
    const std::string infinite =
        "the value of 'temperature' at point 4 is infinite (--field may be pressure)";
    const std::string nothing =
        "the value of 'temperature' at point 4 is not a number (--field may be pressure)";
    // Floats have no differences of such numbers.
    for (const std::string large : {"-4e+99", "-4e+38", "3e+38"})
        EXPECT_EQ(with_value(large + ' '), "the value of 'temperature' at point 4 is " + large +
                                               ", more than 4.3e+37 (--field may be pressure)");
    EXPECT_EQ(with_value("-4e-99 "), "") << "too small for a float is zero";
    EXPECT_EQ(with_value("1.#INF "), infinite) << "as Windows used to print them";
    EXPECT_EQ(with_value("-1.#IND "), nothing);
    EXPECT_EQ(with_value("-nan "), nothing);
    EXPECT_EQ(with_value("-4,5 "),
              "'-4,5' is no number of its type: numbers have a point, no comma");
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
    EXPECT_EQ(error_of(vtk_file(two_cells(), VtkForm::ascii) + "FIELD f 1\nnote 1 2 string\nhello"),
              "it ends early");
    EXPECT_EQ(
        error_of(vtk_file(two_cells(), VtkForm::binary) + "FIELD f 1\nnote 1 1 string\n\xC9hello"),
        "it ends early");
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
                refused += grid && kb::find_field(*grid, "temperature") ? 0 : 1;
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
    const auto far = kb::load_point_set(directory.write(
        "far.vtk", "# vtk DataFile Version 3.0\nparticles\nASCII\nDATASET POLYDATA\n"
                   "POINTS 2 double\n615850.25 5846925.125 0 615850.5 5846925.25 1\n"
                   "POINT_DATA 2\nSCALARS mass float\n4 5\n"));
    ASSERT_TRUE(far) << far.error().message;
    EXPECT_EQ(glm::dvec3(far->points[1]) + far->origin, glm::dvec3(615850.5, 5846925.25, 1.0))
        << "coordinates on a map";

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
    const auto fault = [&](const std::string &body) {
        const auto set = kb::load_point_set(directory.write(
            "p.vtk", "# vtk DataFile Version 3.0\np\nASCII\nDATASET POLYDATA\n" + body));
        return set ? kb::find_field(set->fields, "a").error().message : set.error().message;
    };
    EXPECT_EQ(error("POINTS 1 float\n0 nan 0\n"), "point 0 is not finite");
    EXPECT_EQ(error("POINTS 1 double\n0 1e300 0\n"),
              "point 0 has the coordinate 1e+300, more than 4.3e+37");
    EXPECT_EQ(fault("POINTS 1 float\n0 0 0\nPOINT_DATA 1\nSCALARS a float\nnan\n"),
              "the value of 'a' at point 0 is not a number");
    EXPECT_EQ(fault("POINTS 1 float\n0 0 0\nPOINT_DATA 2\nSCALARS a float\n1 2\n"),
              "the field 'a' has 2 values, but there are 1 points");
}

} // namespace
