// SPDX-License-Identifier: MIT
//
// What `volume` and `isosurface` say of bad input, and that cells which `--repair` leaves out leave
// no trace in a picture.

#include "lib/io/image.hpp"
#include "lib/io/tet_grid.hpp"
#include "tests/lib/io/tet_grid_file.hpp"
#include "tests/support/process.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temp_directory.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace
{

using namespace kb::test;

void expect_command_refused(const std::vector<std::string> &command, const std::string &program,
                            const std::string &mention)
{
    SCOPED_TRACE(testing::PrintToString(command));
    expect_refused(run(command, mesa_environment(patched_prefix())), program, mention);
}

const std::array<std::array<const char *, 2>, 2> programs{
    {{KBUFFER_VOLUME, "volume"}, {KBUFFER_ISOSURFACE, "isosurface"}}};

std::vector<std::string> with(std::vector<std::string> command,
                              const std::vector<std::string> &arguments)
{
    command.insert(command.end(), arguments.begin(), arguments.end());
    return command;
}

TEST(VolumeCommand, RefusesBadOptions)
{
    const TempDirectory directory;
    const std::string empty = directory.write("empty.txt", "");
    const struct {
        std::vector<std::string> arguments;
        std::string mention;
    } cases[] = {
        {{"--k", "0"}, "--k"},
        {{"--k", "-1"}, "--k"},
        {{"--k", "4096"}, "--k"},
        {{"--k", "six"}, "--k"},
        {{"--exact", "--k", "4096"}, "--k"},
        {{"--field", "speed"}, "there is no scalar field 'speed', but wave, distance"},
        {{"--transfer", "/no/such/function.txt"}, "/no/such/function.txt"},
        {{"--transfer", empty}, "no points"},
        {{"--transfer", directory / "."}, "it is a directory"},
        {{"--transfer", "/proc/self/mem"}, "/proc/self/mem: it cannot be read"},
        {{"--transfer-points", "0 0 0 1 1; 2 0 0 1"}, "line 2"},
        {{"--transfer-points", "0 0 0 1 1; 1 0 0 1 1", "--transfer", "haze"}, "--transfer"},
        {{"--transfer-points", "1 0 0 1 1; 0 0 0 1 1"}, "ascend"},
        {{"--transfer-points", "0 0 0 1.5 1; 1 0 0 1 1"}, "1.5"},
        {{"--transfer-points", "0 0 0 1 -2; 1 0 0 1 1"}, "-2"},
        {{"--transfer-points", "nan 0 0 1 1; 1 0 0 1 1"}, "not finite"},
        {{"--transfer-points", "0 0 0 1 nan; 1 0 0 1 1"}, "extinction"},
        {{"--transfer-points", "0 0 0 1 1e; 1 0 0 1 1"}, "1e is not a number"},
        {{"--budget", "0.5"}, "--budget"},
        {{"--tolerance", "-0.1"}, "--tolerance"},
        {{"--tolerance", "nan"}, "--tolerance"},
        {{"--tolerance", "0.1", "--all-faces"}, "--all-faces"},
        {{"--cubes", "0"}, "--cubes"},
        {{"--distance", "-1"}, "--distance"},
        {{"--azimuth", "nan"}, "--azimuth"},
        {{"--background", "1,2,3"}, "--background"},
        {{"--float-out", "/no/such/place.pfm"}, "/no/such"},
        {{"--json", "/no/such/place.json"}, "/no/such"},
        {{"--grid", "/no/such/grid.vtk"}, "/no/such/grid.vtk: no such file"},
        {{"stray"}, "stray"},
    };
    for (const auto &c : cases) {
        expect_command_refused(
            with({KBUFFER_VOLUME, "--size", "16x16", "--out", directory / "out.png"}, c.arguments),
            "volume", c.mention);
        EXPECT_EQ(directory.file_count(), 1U) << "something was written";
    }
}

TEST(VolumeCommand, RefusesBadGrids)
{
    const TempDirectory directory;
    const std::string good = vtk_file(two_cells(), VtkForm::ascii);
    const auto changed = [&good](const std::string &old_text, const std::string &new_text) {
        std::string content = good;
        const std::size_t at = content.find(old_text);
        EXPECT_NE(at, std::string::npos) << old_text;
        return content.replace(at, old_text.size(), new_text);
    };
    const std::string binary = vtk_file(two_cells(), VtkForm::binary);
    const struct {
        std::string content;
        std::string mention;
    } cases[] = {
        {"", "no legacy VTK file"},
        {changed("4 0 1 2 3", "4 0 1 2 2"), "cell 0 has no volume (--repair"},
        {changed("4 0 1 2 3", "4 1 0 2 3"), "cell 0 is inverted (--repair"},
        {changed("4 0 1 2 3", "4 0 1 2 5"), "cell 0 has point 5, but there are 5 points"},
        {changed("POINT_DATA", "CELL_DATA"), "scripts/convert-grid"},
        {good.substr(0, good.find("POINT_DATA")), "no scalars"},
        {changed("CELLS 2", "CELLS 3"), "3 cells"},
        {changed("POINT_DATA 5", "POINT_DATA 4"), "section"},
        {changed("0.5 1 ", "nan 1 "), "not a number"},
        {changed("-4 ", "-4,5 "), "'-4,5' is no number of its type: numbers have a point"},
        {changed("\n10 10", "\n10 12"), "hexahedron (type 12); scripts/convert-grid"},
        {binary.substr(0, binary.size() - 9), "cut off"},
    };
    for (const auto &c : cases) {
        const std::string grid = directory.write("grid.vtk", c.content);
        for (const auto &[program, name] : programs) {
            expect_command_refused({program, "--grid", grid, "--out", directory / "out.png"}, name,
                                   c.mention);
            EXPECT_EQ(directory.file_count(), 1U) << "something was written";
        }
    }
    const std::string flat = directory.write(
        "grid.vtk", changed("CELLS 2 10\n4 0 1 2 3 4 0 2 1 4", "CELLS 2 10\n4 0 1 2 2 4 0 0 0 0"));
    expect_command_refused({KBUFFER_VOLUME, "--repair", "--grid", flat}, "volume",
                           "it has no cells");
}

/// A box of six tetrahedra a cube, in the form of an ASCII file: what comes before the numbers, and
/// the numbers with as many digits as doubles have.
struct BoxFile {
    std::string header = "# vtk DataFile Version 3.0\na box\nASCII\nDATASET UNSTRUCTURED_GRID\n";
    glm::dvec3 origin{0.0};
    bool own_points = false;      ///< Each cell has its own.
    std::string more_points = {}; ///< Coordinates, and a value, of one that no cell has.
    std::string more_value = {};
    double value_offset = 0.0;
    double value_scale = 1.0;
    std::string arrays_before = {}; ///< In a FIELD before the values, for {0} points.
    int array_count = 0;

    std::string content() const
    {
        kb::TetGrid grid = kb::make_tet_grid(
            {.cubes = 3, .split = kb::CubeSplit::six, .jitter = 0.0F, .sliver_share = 0.0F});
        if (own_points) {
            kb::TetGrid own;
            for (const glm::uvec4 &cell : grid.cells) {
                const auto first = static_cast<std::uint32_t>(own.points.size());
                own.cells.emplace_back(first, first + 1, first + 2, first + 3);
                for (int corner = 0; corner < 4; ++corner)
                    own.points.push_back(grid.points[cell[corner]]);
            }
            grid = own;
        }
        const std::size_t points = grid.points.size() + (more_points.empty() ? 0 : 1);
        std::string text = header + fmt::format("POINTS {} double\n", points);
        for (const glm::vec3 &p : grid.points) {
            const glm::dvec3 moved = glm::dvec3(p) + origin;
            text += fmt::format("{} {} {}\n", moved.x, moved.y, moved.z);
        }
        text +=
            more_points + fmt::format("\nCELLS {} {}\n", grid.cells.size(), 5 * grid.cells.size());
        for (const glm::uvec4 &c : grid.cells)
            text += fmt::format("4 {} {} {} {}\n", c[0], c[1], c[2], c[3]);
        text += fmt::format("CELL_TYPES {}\n", grid.cells.size());
        for (std::size_t i = 0; i < grid.cells.size(); ++i)
            text += "10\n";
        text += fmt::format("POINT_DATA {}\n", points);
        if (array_count > 0)
            text += fmt::format("FIELD FieldData {}\n", array_count) +
                    fmt::format(fmt::runtime(arrays_before), points);
        text += "SCALARS height double 1\nLOOKUP_TABLE default\n";
        for (const glm::vec3 &p : grid.points)
            text += fmt::format("{}\n", value_offset + value_scale * double(p.z + 0.3F * p.x));
        return text + more_value + '\n';
    }
};

/// So many lines or numbers, one for each of the 64 points.
std::string repeated(const std::string &line)
{
    std::string text;
    for (int i = 0; i < 64; ++i)
        text += line + '\n';
    return text;
}

TEST(VolumeCommand, WhatIsBesideTheGridInAFileChangesNoPicture)
{
    const TempDirectory directory;
    const std::string plain = directory.write("plain.vtk", BoxFile().content());
    const struct {
        const char *what;
        BoxFile file;
        bool is_exact;
    } cases[] = {
        {"coordinates on a map", {.origin = {615850.0, 5846925.0, 758.0}}, false},
        {"values with a large offset", {.value_offset = 101325.0, .value_scale = 0.02}, false},
        {"cells with points of their own", {.own_points = true}, false},
        {"a point that no cell has", {.more_points = "1e9 0 nan", .more_value = "-9999"}, true},
        {"arrays of text, bits, and of what is no number",
         {.arrays_before = "label 1 {0} string\n" + repeated("a text") + "mask 1 {0} bit\n" +
                           repeated("1") + "porosity 1 {0} float\n" + repeated("nan"),
          .array_count = 3},
         true},
        {"an empty line in the header",
         {.header = "# vtk DataFile Version 3.0\na box\n\nASCII\nDATASET UNSTRUCTURED_GRID\n"},
         true},
    };
    const auto environment = mesa_environment(patched_prefix());
    for (const auto &[program, name] : programs) {
        const auto draw = [&, program = program](const std::string &grid) {
            const std::string out = directory / "out.pfm";
            const ProcessResult result =
                run({program, "--grid", grid, "--field", "height", "--size", "96x64",
                     "--no-disorder", "--float-out", out, "--azimuth", "20", "--elevation", "15"},
                    environment);
            EXPECT_EQ(result.status, 0) << result.err;
            EXPECT_EQ(result.err, "");
            const auto image = kb::read_pfm(out);
            EXPECT_TRUE(image);
            return image ? *image : kb::ImageRgbaF();
        };
        const kb::ImageRgbaF expected = draw(plain);
        EXPECT_GT(
            std::ranges::count_if(expected.pixels, [](auto &p) { return p != glm::vec4(1.0F); }),
            1'000)
            << "there is something";
        for (const auto &c : cases) {
            SCOPED_TRACE(std::string(name) + ": " + c.what);
            const auto difference = kb::compare(draw(directory.write("grid.vtk", c.file.content())),
                                                expected, 2.0 / 255.0);
            ASSERT_TRUE(difference) << difference.error().message;
            if (c.is_exact)
                EXPECT_EQ(difference->max, 0.0);
            else // Vertices may move by a step of the driver's grid, and so the edges by a pixel.
                EXPECT_LE(difference->share, 0.01);
        }
    }
}

TEST(VolumeCommand, CellsWithPointsOfTheirOwnCostWhatOthersDo)
{
    const TempDirectory directory;
    const auto faces = [&](const BoxFile &file) {
        const std::string json = directory / "out.json";
        const auto result = run(
            {KBUFFER_VOLUME, "--grid", directory.write("grid.vtk", file.content()), "--size",
             "32x32", "--order", "cells", "--no-disorder", "--tolerance", "0.1", "--json", json},
            mesa_environment(patched_prefix()));
        EXPECT_EQ(result.status, 0) << result.err;
        std::ifstream stream(json);
        return nlohmann::json::parse(stream).at("triangles").get<int>();
    };
    EXPECT_EQ(faces({.own_points = true}), faces({}));
}

TEST(VolumeCommand, SaysWhatIsDrawnInTheUnitsOfTheField)
{
    const TempDirectory directory;
    const std::string grid = directory.write(
        "grid.vtk", BoxFile{.more_points = "0 0 0",
                            .more_value = "0",
                            .value_offset = 101325.0,
                            .value_scale = 0.1,
                            .arrays_before = "lost 1 {0} float\nnan\n" + repeated("1"),
                            .array_count = 1}
                        .content());
    const auto environment = mesa_environment(patched_prefix());
    for (const auto &[program, name] : programs) {
        const auto list = run({program, "--grid", grid, "--list-fields"}, environment);
        EXPECT_EQ(list.status, 0) << list.err;
        EXPECT_EQ(list.out,
                  "lost: cannot be drawn: the value of 'lost' at point 0 is not a number\n"
                  "height: from 101324.87 to 101325.13\n");
        expect_command_refused({program, "--grid", grid}, name,
                               "the value of 'lost' at point 0 is not a number (--field may be "
                               "height)");
    }
    const auto json_of = [&](std::vector<std::string> command) {
        const std::string json = directory / "out.json";
        const auto result =
            run(with(std::move(command), {"--grid", grid, "--field", "height", "--size", "32x32",
                                          "--no-disorder", "--json", json}),
                environment);
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_EQ(result.err, "");
        EXPECT_NE(result.out.find("grid: 64 points, 162 cells, 1 points that no cell has left out; "
                                  "field 'height' from 101324.87 to 101325.13; "),
                  std::string::npos)
            << result.out;
        std::ifstream stream(json);
        return nlohmann::json::parse(stream).at("range").get<std::vector<double>>();
    };
    for (const auto &[program, name] : programs) {
        const auto range = json_of({program});
        ASSERT_EQ(range.size(), 2U);
        EXPECT_NEAR(range[0], 101324.87, 1e-7);
        EXPECT_NEAR(range[1], 101325.13, 1e-7);
    }
    // An iso-value is as precise as the field.
    const auto iso = run({KBUFFER_ISOSURFACE, "--grid", grid, "--field", "height", "--size",
                          "32x32", "--no-disorder", "--iso", "101325.02,101325.021"},
                         environment);
    EXPECT_EQ(iso.err, "");
    EXPECT_NE(iso.out.find("iso-values: 101325.02, 101325.021\n"), std::string::npos) << iso.out;
}

TEST(VolumeCommand, EmptyPicturesSayWhy)
{
    const TempDirectory directory;
    const auto environment = mesa_environment(patched_prefix());
    const auto said = [&](std::vector<std::string> command) {
        const auto result =
            run(with(std::move(command), {"--size", "32x32", "--no-disorder"}), environment);
        EXPECT_EQ(result.status, 0) << result.err;
        return result.err;
    };
    const std::string flat =
        directory.write("flat.vtk", BoxFile{.value_offset = 5.0, .value_scale = 0.0}.content());
    EXPECT_EQ(said({KBUFFER_VOLUME, "--grid", flat}),
              "volume: the picture has one color: field 'height' is 5 everywhere\n");
    EXPECT_EQ(said({KBUFFER_ISOSURFACE, "--grid", flat}),
              "isosurface: the picture is empty: field 'height' is 5 everywhere\n");
    EXPECT_EQ(said({KBUFFER_VOLUME, "--transfer-points", "0 0 0 0 0"}),
              "volume: the picture is empty: the transfer function gives no value of the field an "
              "extinction\n");
    EXPECT_EQ(said({KBUFFER_VOLUME, "--cubes", "2"}), "");
    const std::string box = directory.write("box.vtk", BoxFile().content());
    EXPECT_EQ(said({KBUFFER_ISOSURFACE, "--grid", box, "--iso", "7,0.1"}),
              "isosurface: no surface has the iso-value 7: field 'height' from -1.3 to 1.3\n");
    EXPECT_EQ(
        said({KBUFFER_ISOSURFACE, "--grid", box, "--iso", "7"}),
        "isosurface: no surface has the iso-value 7: field 'height' from -1.3 to 1.3\n"
        "isosurface: the picture is empty: all iso-values are outside of the field's range\n");
    EXPECT_EQ(said({KBUFFER_ISOSURFACE, "--grid", box, "--iso", "0.1"}), "");
    // The eye is in the middle and looks away from the one corner that has a surface.
    EXPECT_EQ(said({KBUFFER_ISOSURFACE, "--grid", box, "--iso", "1.25", "--distance", "0",
                    "--field-of-view", "20"}),
              "isosurface: the picture is empty: no surface is in view\n");
}

TEST(VolumeCommand, IsosurfaceSaysWhatItRepairedAndMeasured)
{
    const TempDirectory directory;
    std::string content = vtk_file(two_cells(), VtkForm::ascii);
    content.replace(content.find("4 0 1 2 3"), 9, "4 1 0 2 3");
    const std::vector<std::string> command{
        KBUFFER_ISOSURFACE, "--size", "16x16", "--grid", directory.write("grid.vtk", content),
        "--repair"};
    const auto environment = mesa_environment(patched_prefix());
    const std::string repaired = "repaired: 0 cells without volume left out, 1 turned\n";
    const std::string all = run(command, environment).out;
    EXPECT_EQ(all.find(repaired), 0U) << all;
    EXPECT_NE(all.find("\ndisorder: up to "), std::string::npos) << all;
    const std::string some = run(with(command, {"--no-disorder"}), environment).out;
    EXPECT_EQ(some.find(repaired), 0U) << some;
    EXPECT_EQ(some.find("disorder"), std::string::npos) << some;
}

/// A command of bash, in which "$@" is the program with its arguments.
ProcessResult run_in_shell(const std::string &text, const std::vector<std::string> &command)
{
    return run(with({"/bin/bash", "-c", text, "bash"}, command),
               mesa_environment(patched_prefix()));
}

TEST(VolumeCommand, OutlivesTheReaderOfWhatItPrints)
{
    const TempDirectory directory;
    for (const char *program : {KBUFFER_VOLUME, KBUFFER_ISOSURFACE}) {
        SCOPED_TRACE(program);
        const std::string out = directory / "out.png";
        const ProcessResult result = run_in_shell(R"(set -m; "$@" | :; exit "${PIPESTATUS[0]}")",
                                                  {program, "--size", "16x16", "--out", out});
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_TRUE(std::filesystem::exists(out));
        std::filesystem::remove(out);
    }
}

TEST(VolumeCommand, TellsOfThePictureBeforeDisorderAndEndsThatWhenInterrupted)
{
    const TempDirectory directory;
    const struct {
        std::vector<std::string> command;
        std::string last_line;
    } cases[] = {
        {{KBUFFER_VOLUME, "--cubes", "24", "--json", directory / "out.json"}, "segments: "},
        {{KBUFFER_ISOSURFACE, "--particles"}, "isosurface k="},
    };
    const std::string printed = directory / "printed";
    const std::string out = directory / "out.png";
    for (const auto &c : cases) {
        SCOPED_TRACE(c.command[0]);
        // A job of its own, as at a prompt: others have Ctrl-C ignored.
        const ProcessResult result = run_in_shell(
            "set -m; \"$@\" > '" + printed + "' & until grep -q '^" + c.last_line + "' '" +
                printed + "'; do kill -0 $! 2>/dev/null || exit 99; sleep 0.02; done; test -s '" +
                out + "' || exit 98; kill -INT $!; wait $!; status=$?; cat '" + printed +
                "'; exit $status",
            with(c.command, {"--size", "500x500", "--out", out}));
        EXPECT_EQ(result.status, 130) << result.err;
        EXPECT_NE(result.out.find("\ndisorder: not measured: interrupted\n"), std::string::npos)
            << result.out;
        std::filesystem::remove(out);
    }
    std::ifstream json(directory / "out.json");
    const std::string text(std::istreambuf_iterator<char>(json), {});
    EXPECT_NE(text.find("\"segments\""), std::string::npos) << text;
    EXPECT_EQ(text.find("\"disorder\""), std::string::npos) << text;
}

/// A generated grid with cells of no volume among the others: with points that are the same, and
/// with four points of a plane.
kb::TetGrid with_flat_cells(kb::TetGrid grid)
{
    std::vector<glm::uvec4> cells;
    for (std::size_t i = 0; i < grid.cells.size(); ++i) {
        const glm::uvec4 &c = grid.cells[i];
        if (i % 3 == 0)
            cells.emplace_back(c[0], c[1], c[2], c[2]);
        if (i % 7 == 0)
            cells.emplace_back(c[3], c[3], c[3], c[3]);
        cells.push_back(c);
    }
    std::vector<std::uint32_t> side;
    for (std::uint32_t i = 0; i < grid.points.size(); ++i) {
        if (grid.points[i].z == 1.0F)
            side.push_back(i);
    }
    for (std::size_t i = 0; i + 3 < side.size(); ++i)
        cells.emplace_back(side[i], side[i + 1], side[i + 2], side[i + 3]);
    grid.cells = cells;
    return grid;
}

TEST(VolumeCommand, CellsWithoutVolumeChangeNoBit)
{
    const TempDirectory directory;
    kb::GeneratedGrid wanted;
    wanted.cubes = 4;
    wanted.sliver_share = 0.1F;
    const kb::TetGrid grid = kb::make_tet_grid(wanted);
    const std::string good = directory.write("good.vtk", vtk_file(grid, VtkForm::binary));
    const std::string flat =
        directory.write("flat.vtk", vtk_file(with_flat_cells(grid), VtkForm::binary));
    const std::string repaired =
        "repaired: " + std::to_string(with_flat_cells(grid).cells.size() - grid.cells.size()) +
        " cells without volume left out, 0 turned\n";
    const auto picture_of = [&](const std::vector<std::string> &arguments,
                                const std::string &driver) {
        auto environment = mesa_environment(patched_prefix());
        environment["GALLIUM_DRIVER"] = driver;
        const std::string out = directory / "out.pfm";
        const ProcessResult result = run(with({KBUFFER_VOLUME, "--size", "48x32", "--float-out",
                                               out, "--no-disorder", "--background", "0,0,0"},
                                              arguments),
                                         environment);
        EXPECT_EQ(result.status, 0) << result.err;
        if (std::ranges::find(arguments, "--repair") != arguments.end()) {
            EXPECT_EQ(result.out.find(repaired), 0U) << result.out;
        }
        std::ifstream file(out, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    for (const std::string driver : {"llvmpipe", "softpipe"}) {
        for (const auto &method : {std::vector<std::string>{"--k", "6"}, {"--exact"}}) {
            SCOPED_TRACE(driver + ' ' + method[0]);
            const std::string picture = picture_of(with(method, {"--grid", good}), driver);
            const auto bytes = [](unsigned char byte) { return byte != 0; };
            EXPECT_GT(std::ranges::count_if(picture, bytes), 4'000) << "there is something";
            EXPECT_TRUE(picture == picture_of(with(method, {"--grid", flat, "--repair"}), driver));
        }
    }
}

TEST(VolumeCommand, OutputsGoWhereTheirNamesLead)
{
    const TempDirectory directory;
    const auto environment = mesa_environment(patched_prefix());
    const std::vector<std::string> command{KBUFFER_VOLUME, "--size", "16x16",
                                           "--cubes",      "2",      "--no-disorder"};
    for (const char *name : {"-", "/dev/stdout"}) {
        const auto printed = run(with(command, {"--json", name}), environment);
        EXPECT_EQ(printed.status, 0) << printed.err;
        EXPECT_EQ(printed.out.find("{\n"), 0U) << printed.out;
        EXPECT_EQ(printed.out.substr(printed.out.size() - 3), "\n}\n");
        EXPECT_NE(printed.err.find("geometry pass"), std::string::npos) << printed.err;
    }
    // By then the picture has been told of.
    const auto full = run(with(command, {"--json", "/dev/full"}), environment);
    EXPECT_EQ(full.status, 2);
    EXPECT_EQ(full.err, "volume: cannot write /dev/full: No space left on device\n");
    expect_command_refused(with(command, {"--json", directory / "out.csv"}), "volume",
                           "it is a .json file");
    expect_command_refused(with(command, {"--out", directory / "out.jpg"}), "volume",
                           "it is a .png file");
    EXPECT_EQ(directory.file_count(), 0U);
}

TEST(VolumeCommand, OneFrameHasNoPercentiles)
{
    const auto result = run({KBUFFER_VOLUME, "--size", "16x16", "--cubes", "2", "--no-disorder"},
                            mesa_environment(patched_prefix()));
    EXPECT_EQ(result.out.find("95 %"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find(" ms (sorting "), std::string::npos) << result.out;
}

} // namespace
