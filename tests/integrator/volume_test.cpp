// SPDX-License-Identifier: MIT
//
// The sample `volume`, in processes of its own, against the integrator.

#include "tests/integrator/scene.hpp"

#include "lib/io/image.hpp"
#include "tests/lib/io/tet_grid_file.hpp"
#include "tests/support/process.hpp"
#include "tests/support/temp_directory.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <utility>

namespace
{

using namespace kb;
using namespace kb::test;

class AgainstIntegrator : public testing::Test
{
protected:
    struct Drawing {
        ImageRgbaF picture;
        std::string file; ///< The picture's, byte for byte.
        std::filesystem::path scene;
    };

    /// Runs `volume`. A failure is the test's.
    Drawing draw(std::vector<std::string> arguments, const std::string &driver = "llvmpipe")
    {
        const auto floats = directory_ / "volume.pfm";
        const auto json = directory_ / "volume.json";
        arguments.insert(arguments.begin(), KBUFFER_VOLUME);
        for (const std::string &argument :
             {std::string("--no-disorder"), std::string("--float-out"), floats.string(),
              std::string("--json"), json.string()})
            arguments.push_back(argument);
        auto variables = mesa_environment(patched_prefix());
        variables["GALLIUM_DRIVER"] = driver;
        const ProcessResult result = run(arguments, variables);
        EXPECT_EQ(result.status, 0) << result.err;
        auto picture = read_pfm(floats);
        if (result.status != 0 || !picture) {
            ADD_FAILURE() << "there is no picture";
            return {};
        }
        std::ifstream file(floats, std::ios::binary);
        return {*std::move(picture), {std::istreambuf_iterator<char>(file), {}}, json};
    }

    /// The promise is one step of 255 if nothing else is said. llvmpipe moves corners by up to
    /// 1/512 pixel along each axis, so a pixel may show what a ray beside its center sees;
    /// softpipe, which walks edges in floats, rounds places by less.
    static void expect_right(const Drawing &drawing, double promise = 1.0 / 255.0)
    {
        const auto scene = integrator::load_scene(drawing.scene);
        ASSERT_TRUE(scene) << scene.error().message;
        const auto bounds = integrator::integrate_bounds(scene->volume(), 1.0 / 512.0);
        const ImageRgbaF &picture = drawing.picture;
        ASSERT_EQ(picture.pixels.size(), bounds.low.pixels.size());
        std::size_t wrong = 0;
        std::size_t seen = 0;
        double most = 0.0;
        for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
            double off = 0.0;
            for (int c = 0; c < 3; ++c) {
                const auto value = static_cast<double>(picture.pixels[i][c]);
                const double beyond =
                    std::max(value - bounds.high.pixels[i][c], bounds.low.pixels[i][c] - value);
                off = std::isnan(value) ? 1.0 : std::max(off, beyond);
            }
            wrong += off > promise ? 1 : 0;
            seen += bounds.high.pixels[i].w > 0.02 ? 1 : 0;
            most = std::max(most, off);
        }
        EXPECT_EQ(wrong, 0U) << "pixels; the worst is off by " << most * 255.0 << "/255";
        EXPECT_GT(seen, picture.pixels.size() / 8) << "enough of the picture shows the volume";
    }

    static std::size_t triangles_drawn(const Drawing &drawing)
    {
        return nlohmann::json::parse(std::ifstream(drawing.scene)).at("triangles_drawn");
    }

    TempDirectory directory_;
};

/// Where scripts/fetch-data put a grid; an empty path if it is not there.
std::filesystem::path data_set(const std::string &name)
{
    const char *folder = std::getenv("KBUFFER_DATA");
    const auto path = std::filesystem::path(folder ? folder : "") / (name + ".vtk");
    return folder && std::filesystem::exists(path) ? path : std::filesystem::path();
}

TEST_F(AgainstIntegrator, GeneratedGrid)
{
    for (const char *transfer : {"haze", "shells"}) {
        SCOPED_TRACE(transfer);
        expect_right(draw({"--exact", "--k", "24", "--transfer", transfer, "--size", "120x100",
                           "--azimuth", "40", "--elevation", "20"}));
        expect_right(draw({"--exact", "--k", "24", "--transfer", transfer, "--size", "40x30",
                           "--azimuth", "-75", "--elevation", "-50"},
                          "softpipe"));
    }
}

TEST_F(AgainstIntegrator, GeneratedGridFromEverySide)
{
    for (const auto &[azimuth, elevation] : {std::pair("0", "0"), std::pair("0", "-90"),
                                             std::pair("120", "45"), std::pair("240", "-20")}) {
        SCOPED_TRACE(fmt::format("{} {}", azimuth, elevation));
        expect_right(draw({"--exact", "--k", "24", "--cubes", "8", "--size", "48x48", "--azimuth",
                           azimuth, "--elevation", elevation}));
    }
}

TEST_F(AgainstIntegrator, OtherLensesAndBackgrounds)
{
    expect_right(draw({"--exact", "--size", "80x60", "--distance", "1.8", "--field-of-view", "70",
                       "--background", "0,0.5,0.25"}));
    expect_right(draw({"--exact", "--size", "60x80", "--distance", "12", "--field-of-view", "9",
                       "--background", "0,0,0"}));
}

TEST_F(AgainstIntegrator, LargeKIsRight)
{
    // Of the generated grid no fragment is more than 32 places late.
    expect_right(draw({"--k", "32", "--size", "120x100", "--azimuth", "40", "--elevation", "20"}));
}

TEST_F(AgainstIntegrator, ToleranceIsKept)
{
    // With fewer faces, too, the rest is within one step.
    for (const char *transfer : {"haze", "shells"}) {
        for (const double tolerance : {0.02, 0.2}) {
            SCOPED_TRACE(fmt::format("{} {}", transfer, tolerance));
            expect_right(draw({"--exact", "--k", "24", "--transfer", transfer, "--tolerance",
                               fmt::format("{}", tolerance), "--size", "80x60", "--azimuth", "40",
                               "--elevation", "20"}),
                         tolerance + 1.0 / 255.0);
        }
    }
}

TEST_F(AgainstIntegrator, AnyOrderIsRightOfTheFacesThatAreLeft)
{
    // Cells are put in order by faces that are not drawn: then k = 4 does what centroids take 32
    // for.
    const std::vector<std::string> view{"--size", "80x60", "--azimuth", "-20", "--elevation", "35"};
    std::vector<std::size_t> triangles;
    for (const auto &[order, k] : {std::pair("centroid", "32"), std::pair("cells", "4")}) {
        SCOPED_TRACE(order);
        std::vector<std::string> arguments{"--k", k, "--order", order, "--tolerance", "0.05"};
        arguments.insert(arguments.end(), view.begin(), view.end());
        const Drawing drawing = draw(arguments);
        expect_right(drawing, 0.05 + 1.0 / 255.0);
        triangles.push_back(triangles_drawn(drawing));
    }
    std::vector<std::string> arguments{"--all-faces"};
    arguments.insert(arguments.end(), view.begin(), view.end());
    EXPECT_EQ(triangles[0], triangles[1]);
    EXPECT_LT(triangles[0], triangles_drawn(draw(arguments)) * 9 / 10);
}

TEST_F(AgainstIntegrator, OneCell)
{
    // Seen from a side, so that the scalar rises and falls along the rays.
    const TetGrid cell{
        {{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, {0.0F, 0.0F, 1.0F}},
        {{0, 1, 2, 3}},
        {{"s", {0.0F, 1.0F, 0.25F, 0.5F}}}};
    const auto path = directory_.write("cell.vtk", vtk_file(cell, VtkForm::binary));
    for (const char *azimuth : {"-60", "10", "100"})
        expect_right(
            draw({"--exact", "--grid", path, "--size", "64x64", "--azimuth", azimuth, "--elevation",
                  "25", "--transfer-points", "0 1 0 0 0.5; 0.5 0 1 0 4; 1 0 0 1 1"}));
}

/// A cell, or a cube in 5 or 24 of them. Each has scalars from 0 to 1.
TetGrid coarse_grid(std::size_t cells)
{
    TetGrid grid{{{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, {0.0F, 0.0F, 1.0F}},
                 {{0, 1, 2, 3}},
                 {{"s", {0.0F, 1.0F, 0.25F, 0.625F}}}};
    if (cells == 1)
        return grid;
    grid = make_tet_grid({.cubes = 1,
                          .split = cells == 5 ? CubeSplit::five : CubeSplit::twenty_four,
                          .jitter = 0.0F,
                          .sliver_share = 0.0F});
    grid.fields = {{"s", {}}};
    for (const glm::vec3 p : grid.points) {
        const bool corner = std::abs(p.x) == 1.0F && std::abs(p.y) == 1.0F && std::abs(p.z) == 1.0F;
        // Corners of one cell are on both sides.
        const float side = cells == 5 ? p.x : p.x * p.y * p.z;
        grid.fields.front().values.push_back(corner ? 0.5F + 0.5F * side
                                                    : 0.4F + 0.2F * (p.x + p.y + p.z));
    }
    return grid;
}

/// Points from 0 to 1 with gaps of 1/24 at least, a third of them transparent.
std::string random_transfer(unsigned seed)
{
    std::mt19937 random(seed);
    const auto unit = [&random] { return static_cast<double>(random()) / 4294967296.0; };
    std::string text;
    for (int i = 0; i < 12; ++i) {
        const double extinction = 30.0 * std::pow(unit(), 3.0);
        text += fmt::format("{:.4f} {:.3f} {:.3f} {:.3f} {:.3f};", (i + 0.25 + 0.5 * unit()) / 12.0,
                            unit(), unit(), unit(), i % 3 == 1 ? 0.0 : extinction);
    }
    text.pop_back();
    return text;
}

TEST_F(AgainstIntegrator, CellsMayHaveAllScalars)
{
    const std::vector<std::pair<std::string, std::string>> transfers{
        {"--transfer", "haze"},
        {"--transfer", "shells"},
        // That of the blunt fin, over the range of these scalars.
        {"--transfer-points", "0 .5 .2 .8 25; .106 .4 .25 .8 0; .19 .2 .4 .9 0; "
                              ".242 .15 .5 .95 1.2; .378 .1 .75 .6 3; .545 .6 .85 .2 7; "
                              ".712 1 .6 .05 14; 1 .9 .05 .05 30"},
        {"--transfer-points", random_transfer(1)},
        {"--transfer-points", random_transfer(2)}};
    for (const std::size_t cells : {1U, 5U, 24U}) {
        const TetGrid grid = coarse_grid(cells);
        ASSERT_EQ(grid.cells.size(), cells);
        const auto path = directory_.write("coarse.vtk", vtk_file(grid, VtkForm::binary));
        for (const auto &[option, transfer] : transfers) {
            for (const char *tolerance : {"0", "0.01"}) {
                SCOPED_TRACE(fmt::format("{} {} {}", cells, transfer, tolerance));
                expect_right(
                    draw({"--k", "6", "--grid", path, option, transfer, "--tolerance", tolerance,
                          "--size", "72x72", "--azimuth", "17", "--elevation", "31"}),
                    std::stod(tolerance) + 1.0 / 255.0);
            }
        }
        expect_right(draw({"--k", "6", "--grid", path, "--transfer", "shells", "--size", "24x24",
                           "--azimuth", "17", "--elevation", "31"},
                          "softpipe"));
    }
}

/// A box without its middle, and without a corner: rays leave it and enter again.
TetGrid grid_with_holes()
{
    TetGrid grid = make_tet_grid({.cubes = 4});
    std::erase_if(grid.cells, [&](const glm::uvec4 &cell) {
        glm::vec3 middle(0.0F);
        for (int i = 0; i < 4; ++i)
            middle += 0.25F * grid.points[cell[i]];
        const bool inner =
            std::max({std::abs(middle.x), std::abs(middle.y), std::abs(middle.z)}) < 0.5F;
        return inner || (middle.x > 0.2F && middle.y > 0.2F && middle.z > 0.2F);
    });
    return grid;
}

TEST_F(AgainstIntegrator, HolesAreEmpty)
{
    const auto path = directory_.write("holes.vtk", vtk_file(grid_with_holes(), VtkForm::binary));
    for (const char *azimuth : {"30", "200"})
        expect_right(draw({"--exact", "--grid", path, "--repair", "--size", "80x80", "--azimuth",
                           azimuth, "--elevation", "35"}));
}

TEST_F(AgainstIntegrator, TheEyeMayBeInside)
{
    for (const std::string driver : {"llvmpipe", "softpipe"}) {
        // As above, k is large enough.
        for (const std::vector<std::string> &way :
             {std::vector<std::string>{"--exact", "--k", "24"}, {"--k", "32"}}) {
            for (const char *distance : {"0", "0.41", "0.95"}) {
                SCOPED_TRACE(fmt::format("{} {} {}", driver, way.front(), distance));
                std::vector<std::string> arguments{
                    "--cubes",    "8",     "--size",      driver == "llvmpipe" ? "96x80" : "32x24",
                    "--azimuth",  "33",    "--elevation", "12",
                    "--distance", distance};
                arguments.insert(arguments.begin(), way.begin(), way.end());
                expect_right(draw(arguments, driver));
            }
        }
    }
}

TEST_F(AgainstIntegrator, TheEyeMayBeInsideACluster)
{
    // Of a linear field, so that all cells are of about one.
    TetGrid grid = make_tet_grid({.cubes = 4});
    grid.fields = {{"linear", {}}};
    for (const glm::vec3 p : grid.points)
        grid.fields.front().values.push_back(p.x - 0.5F * p.y + 0.25F * p.z);
    const auto path = directory_.write("linear.vtk", vtk_file(grid, VtkForm::binary));
    for (const char *order : {"centroid", "cells"})
        expect_right(
            draw({"--k", "8", "--order", order, "--tolerance", "0.001", "--grid", path, "--size",
                  "64x64", "--azimuth", "33", "--elevation", "12", "--distance", "0.41"}));
}

TEST_F(AgainstIntegrator, TheEyeMayBeInAHole)
{
    const auto path = directory_.write("holes.vtk", vtk_file(grid_with_holes(), VtkForm::binary));
    // In the middle one; in the one of the corner, which is open, its walls beside the eye.
    for (const auto &[distance, elevation] : {std::pair("0.1", "20"), {"0.55", "35"}})
        for (const char *azimuth : {"45", "-135"})
            for (const char *way : {"--exact", "--order=cells"})
                expect_right(
                    draw({way, "--k", "32", "--grid", path, "--repair", "--size", "64x64",
                          "--azimuth", azimuth, "--elevation", elevation, "--distance", distance}));
}

TEST_F(AgainstIntegrator, CellsWithoutVolumeChangeNoBit)
{
    const TetGrid grid = make_tet_grid({.cubes = 5});
    TetGrid with_flat = grid;
    with_flat.cells.clear();
    for (std::size_t i = 0; i < grid.cells.size(); ++i) {
        const glm::uvec4 &cell = grid.cells[i];
        if (i % 3 == 0) // A face twice over.
            with_flat.cells.emplace_back(cell[0], cell[1], cell[2], cell[i % 2]);
        with_flat.cells.push_back(cell);
        if (i % 5 == 0) // Nothing but an edge.
            with_flat.cells.emplace_back(cell[3], cell[2], cell[3], cell[2]);
    }
    const auto usual = directory_.write("usual.vtk", vtk_file(grid, VtkForm::binary));
    const auto flat = directory_.write("flat.vtk", vtk_file(with_flat, VtkForm::binary));
    for (const std::vector<std::string> &way :
         {std::vector<std::string>{"--exact"}, {"--k", "6"}, {"--k", "12"}}) {
        std::vector<std::string> arguments{"--size",      "96x96", "--azimuth", "25",
                                           "--elevation", "15",    "--repair",  "--grid"};
        arguments.insert(arguments.begin(), way.begin(), way.end());
        arguments.push_back(usual);
        const Drawing expected = draw(arguments);
        arguments.back() = flat;
        EXPECT_EQ(draw(arguments).file, expected.file) << way.front();
    }
}

TEST_F(AgainstIntegrator, DataSets)
{
    // With KBUFFER_FULL as large as the benchmark draws them.
    const char *full = std::getenv("KBUFFER_FULL");
    const std::string size = full && *full ? "512x512" : "96x96";
    for (const char *name : {"bluntfin", "combustor"}) {
        const auto path = data_set(name);
        if (path.empty())
            GTEST_SKIP() << name << ".vtk is not in KBUFFER_DATA: scripts/fetch-data";
        for (const char *transfer : {"haze", "shells"}) {
            SCOPED_TRACE(fmt::format("{} {}", name, transfer));
            expect_right(draw({"--exact", "--k", "32", "--grid", path, "--transfer", transfer,
                               "--size", size, "--azimuth", "30", "--elevation", "30"}));
        }
    }
}

} // namespace
