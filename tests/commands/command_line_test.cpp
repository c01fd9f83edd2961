// SPDX-License-Identifier: MIT
//
// Bad usage and bad input: one clear line on the standard error output, exit status 2, nothing
// written. What the driver lacks: exit status 1.

#include "lib/io/image.hpp"
#include "tests/support/process.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temp_directory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace
{

using namespace kb::test;

TEST(CommandLine, TransparencyRefusesBadInput)
{
    const TempDirectory directory;
    const std::string out = directory / "out.png";
    const std::string empty = directory.write("empty.ply", "");
    const struct {
        std::vector<std::string> arguments;
        std::string mention;
    } cases[] = {
        {{"--k", "0"}, "--k"},
        {{"--k", "-1"}, "--k"},
        {{"--k", "65"}, "--k"},
        {{"--k", "99999999999999999999"}, "--k"},
        {{"--k", "eight"}, "--k"},
        {{"--k", "010"}, "--k: 010 is no integer from 1 to 64"},
        {{"--k", "0x8"}, "--k: 0x8 is no integer"},
        {{"--size", "0x010"}, "--size"},
        {{"--k", ""}, "--k"},
        {{"--mesh", ""}, "--mesh: its value is empty"},
        {{"--k"}, "--k"},
        {{"--no-such-option"}, "--no-such-option"},
        {{"stray"}, "stray"},
        {{"--method", "magic"}, "--method"},
        {{"--layout", "depth"}, "--layout"},
        {{"--context", "vulkan"}, "--context"},
        {{"--size", "0x10"}, "--size"},
        {{"--size", "10"}, "--size"},
        {{"--size", "99999x1"}, "--size"},
        {{"--size", "1x1x1"}, "--size"},
        {{"--alpha", "1.5"}, "--alpha"},
        {{"--alpha", "nan"}, "--alpha"},
        {{"--repeat", "0"}, "--repeat"},
        {{"--triangles", "-5"}, "--triangles"},
        {{"--mesh", "/no/such/mesh.ply"}, "/no/such/mesh.ply: no such file"},
        {{"--mesh", empty}, "it is empty"},
        {{"--float-out", "/no/such/place.pfm"}, "/no/such"},
        {{"--layers-out", empty}, empty},
    };
    for (const auto &c : cases) {
        SCOPED_TRACE(testing::PrintToString(c.arguments));
        std::vector<std::string> command{KBUFFER_TRANSPARENCY, "--out", out, "--size", "16x16"};
        if (c.arguments[0] == "--size")
            command.resize(3);
        command.insert(command.end(), c.arguments.begin(), c.arguments.end());
        expect_refused(run(command, mesa_environment(patched_prefix())), "transparency", c.mention);
        EXPECT_EQ(directory.file_count(), 1U) << "something was written";
    }
    expect_refused(run({KBUFFER_TRANSPARENCY, "--out", directory / "no/such/out.png"}),
                   "transparency", "no/such");
    expect_refused(run({KBUFFER_TRANSPARENCY, "--out", directory / "."}), "transparency",
                   "directory");
}

TEST(CommandLine, PeelingRefusesBadInput)
{
    const TempDirectory directory;
    const std::string out = directory / "layers";
    const std::string empty = directory.write("empty.ply", "");
    const struct {
        std::vector<std::string> arguments;
        std::string mention;
    } cases[] = {
        {{"--k", "0"}, "--k"},
        {{"--k", "-3"}, "--k"},
        {{"--k", "4096"}, "--k"},
        {{"--k", "1.5"}, "--k"},
        {{"--func", "always"}, "--func"},
        {{"--func", ""}, "--func"},
        {{"--all", "--func", "lequal"}, "--func less or greater"},
        {{"--all", "--func", "gequal"}, "--func less or greater"},
        {{"--depth-format", "8"}, "--depth-format"},
        {{"--color-format", "64"}, "--color-format"},
        {{"--samples", "2"}, "--samples"},
        {{"--samples", "-4"}, "--samples"},
        {{"--size", "0x0"}, "--size"},
        {{"--alpha", "nan"}, "--alpha"},
        {{"--azimuth", "inf"}, "--azimuth"},
        {{"--repeat", "0"}, "--repeat"},
        {{"--context", "vulkan"}, "--context"},
        {{"--all=maybe"}, "--all"},
        {{"stray"}, "stray"},
        {{"--mesh", "/no/such/mesh.ply"}, "/no/such/mesh.ply: no such file"},
        {{"--mesh", empty}, "it is empty"},
    };
    for (const auto &c : cases) {
        SCOPED_TRACE(testing::PrintToString(c.arguments));
        std::vector<std::string> command{KBUFFER_PEELING, "--out-dir", out};
        command.insert(command.end(), c.arguments.begin(), c.arguments.end());
        expect_refused(run(command, mesa_environment(patched_prefix())), "peeling", c.mention);
        EXPECT_EQ(directory.file_count(), 1U) << "something was written";
    }
    expect_refused(run({KBUFFER_PEELING, "--out-dir", empty}), "peeling", "not a directory");
    expect_refused(run({KBUFFER_PEELING, "--out-dir", empty + "/in/it"}), "peeling",
                   "not a directory");
    expect_refused(run({KBUFFER_PEELING, "--floats"}), "peeling", "--out-dir");
    expect_refused(run({KBUFFER_PEELING, "--out", directory / "no/such/out.png"}), "peeling",
                   "no/such");
}

TEST(CommandLine, DriversThatOsmesaDoesNotHaveAreNamed)
{
    const TempDirectory directory;
    auto environment = mesa_environment(patched_prefix());
    for (const char *driver : {"zink", "nonsense", ""}) {
        environment["GALLIUM_DRIVER"] = driver;
        expect_refused(run({KBUFFER_PEELING, "--out", directory / "out.png"}, environment),
                       "peeling", std::string("GALLIUM_DRIVER is '") + driver + "'", 1);
    }
    EXPECT_EQ(directory.file_count(), 0U);
}

// What the layers are of is one run, whatever was in the directory before.
TEST(CommandLine, LayersOfAnEarlierRunAreReplaced)
{
    const auto environment = mesa_environment(patched_prefix());
    for (const char *option : {"--out-dir", "--layers-out"}) {
        const TempDirectory directory;
        const std::string layers = directory / "layers";
        const std::string program =
            option == std::string("--out-dir") ? KBUFFER_PEELING : KBUFFER_TRANSPARENCY;
        const auto draw = [&](const char *k) {
            const auto result =
                run({program, option, layers, "--k", k, "--size", "16x16", "--triangles", "100"},
                    environment);
            EXPECT_EQ(result.status, 0) << result.err;
        };
        draw("4");
        for (const char *other : {"layer-photo.png", "layer-1.txt", "mine.png"})
            directory.write(std::string("layers/") + other, "mine");
        EXPECT_TRUE(std::filesystem::exists(layers + "/layer-003.png"));
        draw("2");
        EXPECT_TRUE(std::filesystem::exists(layers + "/layer-001.png"));
        for (const char *gone : {"layer-002.png", "layer-003.png", "layer-003.pfm"})
            EXPECT_FALSE(std::filesystem::exists(layers + '/' + gone)) << gone;
        for (const char *other : {"layer-photo.png", "layer-1.txt", "mine.png"})
            EXPECT_TRUE(std::filesystem::exists(layers + '/' + other)) << other;
    }
}

TEST(CommandLine, PeelingSaysWhatTheDriverLacks)
{
    const TempDirectory directory;
    auto environment = mesa_environment(patched_prefix());
    const std::string out = directory / "layers";
    expect_refused(run({KBUFFER_PEELING, "--out-dir", out, "--k", "257"}, environment), "peeling",
                   "the driver has 1 to 256", 1);
    expect_refused(
        run({KBUFFER_PEELING, "--out-dir", out, "--k", "256", "--size", "8192x8192"}, environment),
        "peeling", "OUT_OF_MEMORY", 1);
    environment["GALLIUM_DRIVER"] = "softpipe";
    expect_refused(run({KBUFFER_PEELING, "--out-dir", out, "--samples", "4"}, environment),
                   "peeling", "samples are wanted", 1);
    EXPECT_EQ(directory.file_count(), 0U) << "something was written";
}

TEST(CommandLine, PeelingWorksOtherwise)
{
    const TempDirectory directory;
    const auto result =
        run({KBUFFER_PEELING, "--out-dir", directory / "new/layers", "--out", directory / "out.png",
             "--size", "16x16", "--triangles", "100", "--k", "2", "--all"},
            mesa_environment(patched_prefix()));
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_NE(result.out.find("\npass 1: layers 0 to 1, "), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("\npass 2: layers 2 to 3, "), std::string::npos) << result.out;
    EXPECT_TRUE(std::filesystem::exists(directory / "out.png"));
    EXPECT_TRUE(std::filesystem::exists(directory / "new/layers/picture.png"));
    EXPECT_TRUE(std::filesystem::exists(directory / "new/layers/layer-002.png"));
    EXPECT_FALSE(std::filesystem::exists(directory / "new/layers/layer-000.pfm"));
}

TEST(CommandLine, TransparencyWorksOtherwise)
{
    const TempDirectory directory;
    const auto result = run({KBUFFER_TRANSPARENCY, "--out", directory / "out.png", "--size",
                             "16x16", "--triangles", "100"},
                            mesa_environment(patched_prefix()));
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_NE(result.out.find("1 geometry pass,"), std::string::npos) << result.out;
    EXPECT_EQ(directory.file_count(), 1U);
}

TEST(CommandLine, IsosurfaceRefusesBadInput)
{
    const TempDirectory directory;
    const std::string out = directory / "out.png";
    const std::string empty = directory.write("empty.vtk", "");
    const std::string points = directory.write(
        "points.vtk", "# vtk DataFile Version 3.0\npoints\nASCII\nDATASET POLYDATA\n"
                      "POINTS 2 float\n0 0 0 1 1 1\nPOINT_DATA 2\nSCALARS mass float 1\n"
                      "LOOKUP_TABLE default\n0 1\n");
    const struct {
        std::vector<std::string> arguments;
        std::string mention;
    } cases[] = {
        {{"--iso", "x"}, "--iso"},
        {{"--iso", "0.5,nan"}, "--iso"},
        {{"--iso", "inf"}, "--iso"},
        {{"--iso", "0.5=reddish"}, "--iso"},
        {{"--iso", "0.5,1x"}, "--iso"},
        {{"--iso"}, "--iso"},
        {{"--iso", "0,0.5,0.50001,1"}, "0.5 and 0.50001"},
        {{"--levels", "0"}, "--levels"},
        {{"--k", "0"}, "--k"},
        {{"--k", "125"}, "--k"},
        {{"--k", "six"}, "--k"},
        {{"--order", "random"}, "--order"},
        {{"--field", "no-such-field"}, "no-such-field"},
        {{"--grid", "/no/such/grid.vtk"}, "/no/such/grid.vtk"},
        {{"--grid", empty}, "empty.vtk"},
        {{"--grid", points}, "points.vtk"},
        {{"--particles", empty}, "empty.vtk"},
        {{"--particles", "/no/such/points.vtk"}, "/no/such/points.vtk"},
        {{"--particles", "--field", "mass"}, "mass"},
        {{"--particles", points, "--field", "density"}, "density"},
        {{"--particles", "--grid", points}, "--particles"},
        {{"--particles", "--repair"}, "--particles"},
        {{"--particles", "--point-size", "0"}, "--point-size"},
        {{"--particles", "--gap", "nan"}, "--gap"},
        {{"--point-size", "0.1"}, "--particles"},
        {{"--gap", "0.1"}, "--particles"},
        {{"--smoothing", "-1"}, "--smoothing"},
        {{"--smoothing", "1.5"}, "--smoothing"},
        {{"--background", "1,1"}, "--background"},
        {{"--background", "1,1,2"}, "--background"},
        {{"--distance", "-0.5"}, "--distance"},
        {{"--azimuth", "nan"}, "--azimuth"},
        {{"--count", "1"}, "--count"},
        {{"--surfaces-out", "/no/such/place.pfm"}, "/no/such"},
        {{"--float-out", "/no/such/place.pfm"}, "/no/such"},
        {{"stray"}, "stray"},
    };
    for (const auto &c : cases) {
        SCOPED_TRACE(testing::PrintToString(c.arguments));
        std::vector<std::string> command{KBUFFER_ISOSURFACE, "--out", out, "--size", "16x16"};
        command.insert(command.end(), c.arguments.begin(), c.arguments.end());
        expect_refused(run(command, mesa_environment(patched_prefix())), "isosurface", c.mention);
        EXPECT_EQ(directory.file_count(), 2U) << "something was written";
    }
}

TEST(CommandLine, IsosurfaceWorksOtherwise)
{
    const TempDirectory directory;
    const std::string points = directory.write(
        "points.vtk", "# vtk DataFile Version 3.0\npoints\nASCII\nDATASET POLYDATA\n"
                      "POINTS 4 float\n0 0 0 0 0 0.4 3 0 0.2 -3 0 0.2\nPOINT_DATA 4\n"
                      "SCALARS mass float 1\nLOOKUP_TABLE default\n0 1 0 0\n");
    const std::vector<std::vector<std::string>> cases{
        {"--iso", "0.5,0.25=ff8000", "--iso", "0"},
        {"--levels", "9", "--k", "124"},
        {"--field", "distance", "--no-silhouettes", "--smoothing", "2"},
        {"--particles", "--count", "1000"},
        {"--particles", points, "--iso", "0.5", "--gap", "1", "--point-size", "0.5"},
    };
    for (const auto &arguments : cases) {
        SCOPED_TRACE(testing::PrintToString(arguments));
        const auto picture = directory / "out.png";
        const auto surfaces = directory / "out.pfm";
        std::vector<std::string> command{KBUFFER_ISOSURFACE, "--out",  picture, "--surfaces-out",
                                         surfaces,           "--size", "16x16"};
        command.insert(command.end(), arguments.begin(), arguments.end());
        const auto result = run(command, mesa_environment(patched_prefix()));
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_EQ(result.err, "");
        EXPECT_NE(result.out.find("1 geometry pass,"), std::string::npos) << result.out;
        EXPECT_TRUE(kb::read_png(picture));
        const auto image = kb::read_pfm(surfaces);
        ASSERT_TRUE(image);
        // The middle of the picture has a surface in all of them, whose value is one that was asked
        // for: see those that were given.
        const glm::vec4 &middle = image->at(8, 8);
        EXPECT_GT(middle.x, 1.5F);
        if (arguments[0] == "--iso") {
            EXPECT_TRUE(middle.y == 0.5F || middle.y == 0.25F || middle.y == 0.0F) << middle.y;
        }
        std::filesystem::remove(picture);
        std::filesystem::remove(surfaces);
    }
}

TEST(CommandLine, OutputsGoWhereTheirNamesLead)
{
    const TempDirectory directory;
    const auto environment = mesa_environment(patched_prefix());
    const struct {
        std::vector<std::string> command;
        std::string option;
        std::string beginning; ///< Of the file.
    } outputs[] = {
        {{KBUFFER_TRANSPARENCY, "--size", "16x16", "--triangles", "100"}, "--out", "\x89PNG\r\n"},
        {{KBUFFER_TRANSPARENCY, "--size", "16x16", "--triangles", "100"}, "--float-out", "PF\n16"},
        {{KBUFFER_PEELING, "--size", "16x16", "--triangles", "100"}, "--out", "\x89PNG\r\n"},
        {{KBUFFER_ISOSURFACE, "--size", "16x16"}, "--float-out", "PF\n16"},
        {{KBUFFER_ISOSURFACE, "--size", "16x16"}, "--surfaces-out", "PF\n16"},
    };
    for (const auto &output : outputs) {
        const auto to = [&](const std::vector<std::string> &arguments) {
            auto command = output.command;
            command.push_back(output.option);
            command.insert(command.end(), arguments.begin(), arguments.end());
            return run(command, environment);
        };
        SCOPED_TRACE(output.command[0] + " " + output.option);
        const std::string program = std::filesystem::path(output.command[0]).filename();
        for (const char *name : {"-", "/dev/stdout"}) {
            const auto printed = to({name});
            EXPECT_EQ(printed.status, 0) << printed.err;
            EXPECT_EQ(printed.out.find(output.beginning), 0U);
            EXPECT_EQ(printed.out.find(" ms"), std::string::npos);
            EXPECT_NE(printed.err.find("1 geometry pass,"), std::string::npos) << printed.err;
        }
        const auto full = to({"/dev/full"});
        EXPECT_EQ(full.status, 2);
        EXPECT_EQ(full.err, program + ": cannot write /dev/full: No space left on device\n");
        expect_refused(to({directory / "out.jpg"}), program, "not a .jpg file");
    }
    expect_refused(run({KBUFFER_TRANSPARENCY, "--out", "-", "--float-out", "-"}, environment),
                   "transparency", "only one file can be written to the standard output");
    EXPECT_EQ(directory.file_count(), 0U);
}

TEST(CommandLine, WhatIsPrintedMustArrive)
{
    const auto to_full_disk = [](std::vector<std::string> command) {
        command.insert(command.begin(), {"/bin/sh", "-c", "exec \"$0\" \"$@\" >/dev/full"});
        return run(command, mesa_environment(patched_prefix()));
    };
    expect_refused(to_full_disk({KBUFFER_TRANSPARENCY, "--size", "16x16", "--triangles", "100"}),
                   "transparency", "standard output", 1);
    expect_refused(to_full_disk({KBUFFER_ISOSURFACE, "--help"}), "isosurface", "standard output",
                   1);
    expect_refused(to_full_disk({KBUFFER_ISOSURFACE, "--list-fields"}), "isosurface",
                   "standard output", 1);
    expect_refused(to_full_disk({KBUFFER_TRANSPARENCY, "--version"}), "transparency",
                   "standard output", 1);
    expect_refused(to_full_disk({KBUFFER_PROGRAM_TOOL, "--k", "128"}), "kbuffer-program",
                   "standard output: No space left on device");
}

TEST(CommandLine, OneFrameHasNoPercentiles)
{
    for (const char *program : {KBUFFER_TRANSPARENCY, KBUFFER_PEELING, KBUFFER_ISOSURFACE}) {
        const auto frames = [program](const char *count) {
            return run({program, "--size", "16x16", "--repeat", count},
                       mesa_environment(patched_prefix()))
                .out;
        };
        EXPECT_EQ(frames("1").find("95 %"), std::string::npos) << program;
        EXPECT_NE(frames("2").find(" ms (5 % "), std::string::npos) << program;
    }
}

TEST(CommandLine, MissingExtensionSaysWhatToDo)
{
    const TempDirectory directory;
    auto environment = mesa_environment(patched_prefix());
    environment["MESA_EXTENSION_OVERRIDE"] = "-GL_MESA_kbuffer_program";
    expect_refused(run({KBUFFER_TRANSPARENCY, "--out", directory / "out.png"}, environment),
                   "transparency", "scripts/run", 1);
    expect_refused(run({KBUFFER_HELLO}, environment), "hello-kbuffer", "scripts/run", 1);
    expect_refused(run({KBUFFER_ISOSURFACE, "--out", directory / "out.png"}, environment),
                   "isosurface", "scripts/run", 1);
    environment["MESA_EXTENSION_OVERRIDE"] = "-GL_MESA_depth_peeling";
    expect_refused(
        run({KBUFFER_TRANSPARENCY, "--method", "peeling", "--out", directory / "out.png"},
            environment),
        "transparency", "GL_MESA_depth_peeling", 1);
    expect_refused(run({KBUFFER_PEELING, "--out-dir", directory / "out"}, environment), "peeling",
                   "scripts/run", 1);
    expect_refused(run({KBUFFER_HELLO_PEELING}, environment), "hello-peeling", "scripts/run", 1);
    EXPECT_EQ(directory.file_count(), 0U);
}

TEST(CommandLine, HelpIsNoError)
{
    for (const char *program :
         {KBUFFER_TRANSPARENCY, KBUFFER_PEELING, KBUFFER_ISOSURFACE, KBUFFER_PROGRAM_TOOL}) {
        const auto result = run({program, "--help"});
        EXPECT_EQ(result.status, 0);
        EXPECT_NE(result.out.find("--k"), std::string::npos);
        EXPECT_EQ(result.err, "");
    }
}

TEST(CommandLine, ProgramToolPrintsOrRefuses)
{
    const auto good = run({KBUFFER_PROGRAM_TOOL, "--layout", "rgbz", "--k", "3"});
    EXPECT_EQ(good.status, 0);
    EXPECT_EQ(good.out.find("!!ARBfp1.0\nOPTION MESA_kbuffer_program;\n"), 0U);

    const TempDirectory directory;
    const std::string file = directory / "program";
    EXPECT_EQ(run({KBUFFER_PROGRAM_TOOL, "--layout", "rgbz", "--k", "3", "--out", file}).out, "");
    std::ifstream stream(file);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), good.out);

    EXPECT_EQ(run({KBUFFER_PROGRAM_TOOL, "--layout", "rgbz", "--k", "3", "--out", "-"}).out,
              good.out);

    expect_refused(run({KBUFFER_PROGRAM_TOOL, "--k", "0"}), "kbuffer-program",
                   "--k: 0 is no integer from 1 to 256");
    expect_refused(run({KBUFFER_PROGRAM_TOOL, "--k", "129"}), "kbuffer-program", "1 to 128");
    expect_refused(run({KBUFFER_PROGRAM_TOOL, "--layout", "rgbz", "--k", "65"}), "kbuffer-program",
                   "1 to 64");
    expect_refused(run({KBUFFER_PROGRAM_TOOL, "--layout", "x"}), "kbuffer-program", "--layout");
    expect_refused(run({KBUFFER_PROGRAM_TOOL, "--out", "/no/such/file"}), "kbuffer-program",
                   "/no/such/file");
}

TEST(CommandLine, HelloKBufferFindsWhatItExpects)
{
    for (const char *driver : {"llvmpipe", "softpipe"}) {
        auto environment = mesa_environment(patched_prefix());
        environment["GALLIUM_DRIVER"] = driver;
        const auto result = run({KBUFFER_HELLO}, environment);
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_EQ(result.out, "expected 0.625 0.375 0.250, got 0.625 0.375 0.250\n");
    }
}

TEST(CommandLine, HelloPeelingFindsWhatItExpects)
{
    for (const char *driver : {"llvmpipe", "softpipe"}) {
        auto environment = mesa_environment(patched_prefix());
        environment["GALLIUM_DRIVER"] = driver;
        const auto result = run({KBUFFER_HELLO_PEELING}, environment);
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_EQ(result.out, "expected 0.625 0.375 0.250, got 0.625 0.375 0.250 in 2 passes\n");
    }
}

} // namespace
