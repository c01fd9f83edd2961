// SPDX-License-Identifier: MIT
//
// GL_MESA_depth_peeling by the sample `peeling`: layers and composites against the CPU reference,
// and what must not change them.

#include "tests/support/fragment_reference.hpp"
#include "tests/support/picture_test.hpp"
#include "tests/support/test_scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <regex>

namespace
{

using namespace kb::test;

using Arguments = std::vector<std::string>;
using Environment = std::map<std::string, std::string>;

/// What one run of the sample `peeling` wrote and printed.
struct Peeled {
    kb::ImageRgbaF picture;
    std::vector<kb::ImageRgbaF> colors;
    std::vector<kb::ImageRgbaF> depths;
    std::string files; ///< All files of floats, byte for byte.
    std::size_t passes = 0;
    std::size_t layers = 0;
    std::size_t fragments = 0;
};

class Peeling : public PictureTest
{
protected:
    /// Runs the sample with output to files. A failure is the test's.
    Peeled peel(const Arguments &arguments, const Environment &environment = {})
    {
        const auto place = directory_ / "peeled";
        std::filesystem::remove_all(place);
        Arguments command{KBUFFER_PEELING, "--out-dir", place, "--floats", "--color-format", "32f"};
        command.insert(command.end(), arguments.begin(), arguments.end());
        auto variables = mesa_environment(patched_prefix());
        for (const auto &[name, value] : environment)
            variables[name] = value;
        const ProcessResult result = run(command, variables);

        Peeled peeled;
        EXPECT_EQ(result.status, 0) << result.err;
        std::smatch numbers;
        const std::regex line("([0-9]+) geometry pass.*, ([0-9]+) layers, ([0-9]+) fragments");
        if (result.status != 0 || !std::regex_search(result.out, numbers, line)) {
            ADD_FAILURE() << "no numbers are printed: " << result.out;
            return peeled;
        }
        peeled.passes = std::stoul(numbers[1]);
        peeled.layers = std::stoul(numbers[2]);
        peeled.fragments = std::stoul(numbers[3]);
        const auto take = [&](const std::string &name, auto &&use) {
            const auto path = place / name;
            auto image = kb::read_pfm(path);
            if (!image)
                return false;
            use(std::move(*image));
            std::ifstream file(path, std::ios::binary);
            peeled.files.append(std::istreambuf_iterator<char>(file), {});
            return true;
        };
        EXPECT_TRUE(take("picture.pfm", [&](auto image) { peeled.picture = std::move(image); }));
        for (int i = 0;; ++i) {
            const auto stem = fmt::format("layer-{:03}", i);
            if (!take(stem + ".pfm", [&](auto image) { peeled.colors.push_back(image); }) ||
                !take(stem + "-depth.pfm", [&](auto image) { peeled.depths.push_back(image); }))
                break;
        }
        return peeled;
    }

    /// Each layer: the depth bit for bit, and the color that came with it, which tells apart
    /// fragments of equal depth.
    static void expect_layers(const Peeled &ours, const FragmentReference &reference, float empty)
    {
        for (std::size_t i = 0; i < ours.depths.size(); ++i) {
            for (std::size_t p = 0; p < reference.sample_count(); ++p) {
                const auto &fragments = reference.at(p);
                const bool kept = i < fragments.size();
                ASSERT_EQ(ours.depths[i].pixels[p].x, kept ? fragments[i].depth : empty)
                    << "layer " << i << " pixel " << p;
                // Peeling may be compiled with the shader: rounding differs in the last places.
                for (int c = 0; kept && c < 3; ++c)
                    ASSERT_NEAR(ours.colors[i].pixels[p][c], fragments[i].color[c],
                                std::ldexp(1.0, -22))
                        << "layer " << i << " pixel " << p;
            }
        }
    }

    /// The composite. Each layer (sum += T alpha rgb, T *= 1 - alpha), each pass (sum += T sum', T
    /// *= T'), each sample (its part of the average) and the background round at most four times
    /// values of at most 1 by half of 2^-23.
    static void expect_picture(const Peeled &ours, const kb::ImageRgbaF &exact, std::size_t layers,
                               std::size_t samples = 1)
    {
        EXPECT_LE(max_difference(ours.picture, exact),
                  static_cast<double>(layers + ours.passes + samples + 1) * std::ldexp(1.0, -22));
    }

    static std::size_t passes_for(std::size_t layers, std::size_t k)
    {
        return (layers + k - 1) / k;
    }

    /// All layers by passes of k.
    void expect_all(const Arguments &scene, const FragmentReference &reference, int k,
                    const std::string &func, const std::string &driver)
    {
        SCOPED_TRACE(fmt::format("{} {} k {}", driver, func, k));
        Arguments arguments = scene;
        arguments.insert(arguments.end(),
                         {"--all", "--k", std::to_string(k), "--func", func, "--size", "64x64"});
        const auto ours = peel(arguments, {{"GALLIUM_DRIVER", driver}});
        const bool farthest_first = func == "greater";
        ASSERT_EQ(ours.depths.size(), reference.deepest());
        expect_layers(ours, reference, farthest_first ? 0.0F : 1.0F);
        expect_picture(ours, reference.compose(reference.deepest(), farthest_first),
                       reference.deepest());
        EXPECT_EQ(ours.layers, reference.deepest());
        EXPECT_EQ(ours.fragments, reference.fragment_count());
        // Early rejection may have called something an overflow that would have been discarded.
        const std::size_t passes = passes_for(reference.deepest(), std::size_t(k));
        EXPECT_GE(ours.passes, passes);
        EXPECT_LE(ours.passes, passes + 1);
    }
};

TEST_F(Peeling, OnePassGivesTheFirstKLayers)
{
    KB_NEED_STOCK();
    const std::string mesh = directory_ / "soup.ply";
    write_triangle_soup(mesh, 80, 3);
    for (const std::string driver : {"llvmpipe", "softpipe"}) {
        for (const std::string depth_format : {"32f", "24", "16"}) {
            FragmentReference reference(
                directory_, {.mesh = mesh, .driver = driver, .depth_format = depth_format});
            reference.sort();
            ASSERT_GT(reference.deepest(), 17U);
            for (const int k : {1, 2, 3, 8, 17, 64}) {
                SCOPED_TRACE(fmt::format("{} {} k {}", driver, depth_format, k));
                const auto ours = peel({"--mesh", mesh, "--k", std::to_string(k), "--size", "64x64",
                                        "--depth-format", depth_format},
                                       {{"GALLIUM_DRIVER", driver}});
                ASSERT_EQ(ours.depths.size(), std::size_t(k));
                EXPECT_EQ(ours.passes, 1U);
                expect_layers(ours, reference, 1.0F);
                expect_picture(ours, reference.compose(std::size_t(k)), std::size_t(k));
            }
        }
    }
}

TEST_F(Peeling, EachFuncHasItsOrderOfEqualDepths)
{
    KB_NEED_STOCK();
    const std::string mesh = directory_ / "ties.ply";
    write_tied_soup(mesh, 16, 5);
    for (const std::string driver : {"llvmpipe", "softpipe"}) {
        for (const std::string func : {"less", "lequal", "greater", "gequal"}) {
            FragmentReference reference(directory_, {.mesh = mesh, .driver = driver});
            reference.sort(func);
            const bool farthest_first = func[0] == 'g';
            for (const int k : {1, 3, 8, 64}) {
                SCOPED_TRACE(fmt::format("{} {} k {}", driver, func, k));
                const auto ours = peel(
                    {"--mesh", mesh, "--k", std::to_string(k), "--size", "64x64", "--func", func},
                    {{"GALLIUM_DRIVER", driver}});
                ASSERT_EQ(ours.depths.size(), std::size_t(k));
                expect_layers(ours, reference, farthest_first ? 0.0F : 1.0F);
                expect_picture(ours, reference.compose(std::size_t(k), farthest_first),
                               std::size_t(k));
            }
        }
    }
}

TEST_F(Peeling, AllLayersComeWithAnyK)
{
    KB_NEED_STOCK();
    const std::string mesh = directory_ / "ties.ply";
    write_tied_soup(mesh, 16, 6);
    for (const std::string driver : {"llvmpipe", "softpipe"}) {
        for (const std::string func : {"less", "greater"}) {
            FragmentReference reference(directory_, {.mesh = mesh, .driver = driver});
            reference.sort(func);
            for (const int k : {1, 2, 3, 5, 8, 20, 64, 256})
                expect_all({"--mesh", mesh}, reference, k, func, driver);
        }
    }
}

TEST_F(Peeling, AllLayersComeInCoarseDepthFormats)
{
    KB_NEED_STOCK();
    const std::string mesh = directory_ / "soup.ply";
    write_triangle_soup(mesh, 60, 8);
    for (const std::string depth_format : {"24", "16"}) {
        SCOPED_TRACE(depth_format);
        FragmentReference reference(directory_, {.mesh = mesh, .depth_format = depth_format});
        reference.sort();
        for (const int k : {3, 8})
            expect_all({"--mesh", mesh, "--depth-format", depth_format}, reference, k, "less",
                       "llvmpipe");
    }
}

TEST_F(Peeling, HundredsOfEqualDepthsAreNeitherLostNorRepeated)
{
    KB_NEED_STOCK();
    const std::string mesh = directory_ / "stack.ply";
    write_coincident_quads(mesh, 150, 9);
    for (const std::string driver : {"llvmpipe", "softpipe"}) {
        FragmentReference reference(directory_, {.mesh = mesh, .driver = driver});
        reference.sort();
        ASSERT_GE(reference.deepest(), 150U);
        for (const int k : {1, 7, 64})
            expect_all({"--mesh", mesh}, reference, k, "less", driver);
    }
}

TEST_F(Peeling, SamplesAreSortedEachForItself)
{
    KB_NEED_STOCK();
    const std::string mesh = directory_ / "ties.ply";
    write_tied_soup(mesh, 16, 10);
    FragmentReference reference(directory_, {.mesh = mesh, .samples = 4});
    reference.sort();
    const Arguments scene{"--mesh", mesh, "--samples", "4", "--size", "64x64"};
    for (const int k : {1, 3, 8}) {
        SCOPED_TRACE(fmt::format("k {}", k));
        Arguments arguments = scene;
        arguments.insert(arguments.end(), {"--k", std::to_string(k)});
        expect_picture(peel(arguments), reference.compose(std::size_t(k)), std::size_t(k), 4);
        arguments.push_back("--all");
        const auto ours = peel(arguments);
        expect_picture(ours, reference.compose(reference.deepest()), reference.deepest(), 4);
        EXPECT_EQ(ours.layers, reference.deepest());
        EXPECT_EQ(ours.fragments, reference.fragment_count());
    }
    // A test of this test: edges do differ between one sample and four.
    const auto four = peel(scene);
    const auto one = peel({"--mesh", mesh, "--size", "64x64"});
    EXPECT_GT(max_difference(four.picture, one.picture), 0.01);
}

TEST_F(Peeling, ThreadsVectorsAndEarlyRejectionChangeNothing)
{
    const std::string mesh = directory_ / "ties.ply";
    write_tied_soup(mesh, 30, 11);
    // Large triangles, small ones (a knot), samples. More than one tile of 64x64, and a size that
    // is not a multiple of one.
    for (const Arguments &scene : {Arguments{"--mesh", mesh, "--k", "3", "--all"},
                                   Arguments{"--triangles", "20000", "--k", "2", "--all"},
                                   Arguments{"--mesh", mesh, "--k", "12", "--samples", "4"}}) {
        Arguments arguments = scene;
        arguments.insert(arguments.end(), {"--size", "200x150"});
        std::string first;
        for (const std::string culling : {"0", "1"}) {
            for (const std::string width : {"256", "128"}) {
                for (const std::string threads : {"0", "8"}) {
                    SCOPED_TRACE(fmt::format("{} culling {} width {} threads {}",
                                             testing::PrintToString(scene), culling, width,
                                             threads));
                    const auto ours = peel(arguments, {{"LP_KBUF_CULL", culling},
                                                       {"LP_NATIVE_VECTOR_WIDTH", width},
                                                       {"LP_NUM_THREADS", threads}});
                    ASSERT_FALSE(ours.files.empty());
                    if (first.empty())
                        first = ours.files;
                    EXPECT_TRUE(ours.files == first);
                }
            }
        }
    }
}

TEST_F(Peeling, RepetitionAndKindOfContextChangeNothing)
{
    const std::string mesh = directory_ / "soup.ply";
    write_triangle_soup(mesh, 40, 12);
    const Arguments arguments{"--mesh", mesh, "--all", "--k", "4", "--size", "96x80"};
    const auto once = peel(arguments);
    ASSERT_FALSE(once.files.empty());
    Arguments more = arguments;
    more.insert(more.end(), {"--repeat", "3"});
    EXPECT_TRUE(peel(more).files == once.files);
    more = arguments;
    more.insert(more.end(), {"--context", "egl"});
    EXPECT_TRUE(peel(more).files == once.files);
    // A test of this test: fewer layers are another picture.
    EXPECT_GT(
        max_difference(once.picture, peel({"--mesh", mesh, "--k", "4", "--size", "96x80"}).picture),
        1e-3);
}

TEST_F(Peeling, SoftpipeAgreesInsideOfFaces)
{
    write_plane_stack(directory_ / "planes.ply", 12, 17);
    const Arguments arguments{"--mesh",  directory_ / "planes.ply",
                              "--all",   "--k",
                              "5",       "--size",
                              "128x128", "--elevation",
                              "20"};
    const auto llvmpipe = peel(arguments, {{"GALLIUM_DRIVER", "llvmpipe"}});
    const auto softpipe = peel(arguments, {{"GALLIUM_DRIVER", "softpipe"}});
    expect_agreement_inside_of_faces({llvmpipe.picture, llvmpipe.depths},
                                     {softpipe.picture, softpipe.depths}, 12);
}

} // namespace
