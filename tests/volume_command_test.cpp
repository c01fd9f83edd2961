// SPDX-License-Identifier: MIT
//
// What `volume` and `isosurface` say of bad input, and that cells which `--repair` leaves out leave
// no trace in a picture.

#include "process.hpp"
#include "refusal.hpp"
#include "temp_directory.hpp"
#include "tet_grid.hpp"
#include "tet_grid_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
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
        {changed("-4 ", "nan "), "not a number"},
        {changed("\n10 10", "\n10 12"), "hexahedron (type 12); scripts/convert-grid"},
        {binary.substr(0, binary.size() - 9), "cut off"},
    };
    for (const auto &c : cases) {
        const std::string grid = directory.write("grid.vtk", c.content);
        for (const auto &[program, name] : std::array<std::array<const char *, 2>, 2>{
                 {{KBUFFER_VOLUME, "volume"}, {KBUFFER_ISOSURFACE, "isosurface"}}}) {
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

} // namespace
