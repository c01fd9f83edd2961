// SPDX-License-Identifier: MIT
//
// The reference test's own tests: its files, its rasterizer against cases known by hand, its
// shrinking, and that it fails when it should.

#include "tests/reference/a_buffer.hpp"
#include "tests/reference/random_scene.hpp"
#include "tests/reference/rasterizer.hpp"
#include "tests/reference/scene.hpp"
#include "tests/reference/shrink.hpp"
#include "tests/support/process.hpp"
#include "tests/support/temp_directory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>

namespace
{

using namespace kb::reference;
using kb::test::ProcessResult;
using kb::test::TempDirectory;

constexpr SceneLimits limits{};

TEST(ReferenceScene, FilesKeepAllBits)
{
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        const Scene scene = random_scene(seed, limits);
        ASSERT_TRUE(check_scene(scene)) << check_scene(scene).error().message;
        const auto again = from_json(to_json(scene));
        ASSERT_TRUE(again) << again.error().message;
        ASSERT_EQ(to_json(*again), to_json(scene));
        for (std::size_t i = 0; i < scene.steps.size(); ++i) {
            for (std::size_t t = 0; t < scene.steps[i].triangles.size(); ++t)
                ASSERT_EQ(again->steps[i].triangles[t].vertices[0].position,
                          scene.steps[i].triangles[t].vertices[0].position);
        }
    }
}

TEST(ReferenceScene, SeedsGiveTheSameSceneAndDifferentOnes)
{
    EXPECT_EQ(to_json(random_scene(7, limits)), to_json(random_scene(7, limits)));
    EXPECT_NE(to_json(random_scene(7, limits)), to_json(random_scene(8, limits)));
}

TEST(ReferenceScene, BadFilesGetOneLine)
{
    const std::string good = to_json(random_scene(1, limits));
    const auto replaced = [&good](const std::string &from, const std::string &to) {
        return std::regex_replace(good, std::regex(from), to,
                                  std::regex_constants::format_first_only);
    };
    for (const std::string &text :
         {std::string(), std::string("{}"), good.substr(0, good.size() / 2),
          replaced("\"k\": [0-9]+", "\"k\": 0"), replaced("\"k\": [0-9]+", "\"k\": \"four\""),
          replaced("\"size\": \\[\\s*[0-9]+", "\"size\": [-3"),
          replaced("\"extension\": \"[a-z]+\"", "\"extension\": \"none\""),
          replaced("\"position\": \\[", "\"position\": [1e99, ")}) {
        const auto scene = from_json(text);
        ASSERT_FALSE(scene) << text.substr(0, 100);
        EXPECT_EQ(scene.error().message.find('\n'), std::string::npos);
    }
}

/// A 4x4 picture with a triangle of corners in pixels.
Scene scene_of(const std::array<std::array<double, 2>, 3> &corners)
{
    Scene scene;
    scene.width = scene.height = 4;
    scene.viewport = {0, 0, 4, 4};
    Triangle triangle{1, {}};
    for (std::size_t i = 0; i < 3; ++i)
        triangle.vertices[i] = {{static_cast<float>(corners[i][0] / 2.0 - 1.0),
                                 static_cast<float>(corners[i][1] / 2.0 - 1.0),
                                 static_cast<float>(i) / 4.0F, 1.0F},
                                {0.0F, 0.0F, 0.0F, 1.0F}};
    scene.steps.resize(1);
    scene.steps[0].triangles = {triangle};
    return scene;
}

std::string coverage_of(const Scene &scene, const RasterRules &rules)
{
    const TriangleRaster raster(scene, Cull::none, scene.steps[0].triangles[0], rules);
    std::string rows;
    for (int y = 3; y >= 0; --y) {
        for (int x = 0; x < 4; ++x) {
            const Coverage coverage = raster.coverage(x, y, rules.samples[0]);
            rows += coverage == Coverage::yes ? '#' : coverage == Coverage::no ? '.' : '?';
        }
        rows += y > 0 ? "/" : "";
    }
    return rows;
}

TEST(ReferenceRasterizer, AQuadOfTwoTrianglesIsCoveredOnce)
{
    const RasterRules rules;
    // All edges and the diagonal go through pixel centers.
    const std::string lower = coverage_of(scene_of({{{0.5, 0.5}, {3.5, 0.5}, {3.5, 3.5}}}), rules);
    const std::string upper = coverage_of(scene_of({{{0.5, 0.5}, {3.5, 3.5}, {0.5, 3.5}}}), rules);
    for (std::size_t i = 0; i < lower.size(); ++i)
        EXPECT_FALSE(lower[i] == '#' && upper[i] == '#') << i;
    // The left column and the bottom row belong to it, the right and the top do not.
    const std::string quad = "..../###./###./###.";
    for (std::size_t i = 0; i < quad.size(); ++i)
        EXPECT_EQ(lower[i] == '#' || upper[i] == '#', quad[i] == '#') << i;
}

TEST(ReferenceRasterizer, WindingDoesNotMatterButCullingDoes)
{
    const RasterRules rules;
    const Scene forth = scene_of({{{0.0, 0.0}, {4.0, 0.0}, {0.0, 4.0}}});
    const Scene back = scene_of({{{0.0, 0.0}, {0.0, 4.0}, {4.0, 0.0}}});
    EXPECT_EQ(coverage_of(forth, rules), coverage_of(back, rules));
    const auto covers = [&](const Scene &scene, Cull cull) {
        return TriangleRaster(scene, cull, scene.steps[0].triangles[0], rules).coverage(0, 0, {}) ==
               Coverage::yes;
    };
    EXPECT_TRUE(covers(forth, Cull::back));
    EXPECT_FALSE(covers(forth, Cull::front));
    EXPECT_FALSE(covers(back, Cull::back));
    EXPECT_TRUE(covers(back, Cull::front));
}

TEST(ReferenceRasterizer, WithoutSnappingEdgesThroughSamplesAreUndecided)
{
    RasterRules rules;
    rules.snaps = false;
    EXPECT_EQ(coverage_of(scene_of({{{0.5, 0.5}, {3.5, 0.5}, {0.5, 3.5}}}), rules),
              "?.../?\?../?#?./????");
}

TEST(ReferenceRasterizer, WithoutSnappingTheRowOfACornerIsUndecided)
{
    const Scene scene = scene_of({{{0.25, -8.0}, {3.75, 1.5}, {0.25, 12.0}}});
    EXPECT_EQ(coverage_of(scene, {}), "###./###./####/###.");
    RasterRules rules;
    rules.snaps = false;
    EXPECT_EQ(coverage_of(scene, rules), "###./###./\?\?\?\?/###.");
}

TEST(ReferenceRasterizer, DepthIsThatOfThePlane)
{
    const Scene scene = scene_of({{{0.0, 0.0}, {4.0, 0.0}, {0.0, 4.0}}});
    const TriangleRaster raster(scene, Cull::none, scene.steps[0].triangles[0], {});
    // z is 0, 1/4 and 1/2 in clip coordinates at the corners.
    const auto depth = raster.depth(1, 0, {});
    EXPECT_NEAR(depth.value, 0.5 + 0.5 * (0.25 * 1.5 / 4.0 + 0.5 * 0.5 / 4.0), 1e-12);
    EXPECT_GT(depth.tolerance, 0.0);
    EXPECT_LT(depth.tolerance, 1e-5);
}

TEST(ReferenceRasterizer, ASliverHasNoBound)
{
    const Scene scene = scene_of({{{0.0, 0.0}, {4.0, 4.0}, {2.0, 2.0 + 1e-7}}});
    const TriangleRaster raster(scene, Cull::none, scene.steps[0].triangles[0], {});
    EXPECT_TRUE(std::isinf(raster.depth(1, 1, {}).tolerance));
}

TEST(ReferenceRasterizer, NothingBehindTheEyeIsCovered)
{
    Scene scene = scene_of({{{0.0, 0.0}, {4.0, 0.0}, {0.0, 4.0}}});
    for (Vertex &vertex : scene.steps[0].triangles[0].vertices)
        vertex.position[3] = -1.0F;
    EXPECT_EQ(coverage_of(scene, {}), "..../..../..../....");
}

TEST(ReferenceABuffer, TiesAreOrderedAsTheFuncSays)
{
    const auto order = [](Func func, std::uint32_t empty) {
        ABuffer buffer(1);
        const std::array<std::uint32_t, 6> depths{5, 3, 5, 9, 3, 7};
        for (std::size_t t = 0; t < depths.size(); ++t)
            buffer.add(0, {depths[t], t, {}});
        buffer.sort(func, {empty});
        std::string text;
        for (const Fragment &f : buffer.at(0))
            text += static_cast<char>('0' + f.triangle);
        return text;
    };
    EXPECT_EQ(order(Func::less, 9), "14025");
    EXPECT_EQ(order(Func::lequal, 9), "41205");
    EXPECT_EQ(order(Func::greater, 3), "3502");
    EXPECT_EQ(order(Func::gequal, 3), "3520");
}

TEST(ReferenceShrink, LeavesWhatTheFailureNeeds)
{
    // Fails if triangles a and b are drawn in this order in a scene with samples.
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const Scene scene = random_scene(seed, limits);
        if (scene.samples == 0 || scene.triangle_count() < 5)
            continue;
        std::vector<std::uint32_t> all;
        for (const Step &step : scene.steps)
            for (const Triangle &triangle : step.triangles)
                all.push_back(triangle.id);
        const std::uint32_t a = all[1];
        const std::uint32_t b = all[all.size() - 2];
        int trials = 0;
        const Scene small = shrink(scene, [&](const Scene &candidate) {
            ++trials;
            EXPECT_TRUE(check_scene(candidate));
            bool seen_a = false;
            for (const Step &step : candidate.steps) {
                for (const Triangle &triangle : step.triangles) {
                    seen_a |= triangle.id == a;
                    if (triangle.id == b && seen_a)
                        return candidate.samples > 0;
                }
            }
            return false;
        });
        EXPECT_EQ(small.triangle_count(), a == b ? 1U : 2U);
        EXPECT_EQ(small.samples, 4);
        EXPECT_EQ(small.k, 1);
        EXPECT_TRUE(small.flat);
        EXPECT_FALSE(small.has_clears());
        EXPECT_LE(small.steps.size(), 2U);
        EXPECT_LT(trials, 500);
    }
}

TEST(ReferenceShrink, KeepsWhatCannotBeSmaller)
{
    const Scene scene = random_scene(3, limits);
    const std::string whole = to_json(scene);
    EXPECT_EQ(to_json(shrink(scene, [&](const Scene &s) { return to_json(s) == whole; })), whole);
}

TEST(ReferenceShrink, EndsWhenItMayNotAskMore)
{
    const Scene scene = random_scene(3, limits);
    int trials = 0;
    shrink(
        scene,
        [&](const Scene &) {
            ++trials;
            return false;
        },
        10);
    EXPECT_LE(trials, 10);
}

ProcessResult run_reference(std::vector<std::string> arguments)
{
    arguments.insert(arguments.begin(), KBUFFER_REFERENCE_TEST);
    return kb::test::run(arguments, kb::test::mesa_environment(kb::test::patched_prefix()));
}

/// One number for some scenes of several tiles, with a setting of llvmpipe.
std::string digest_of(const std::map<std::string, std::string> &environment,
                      const std::string &driver = "llvmpipe")
{
    auto variables = kb::test::mesa_environment(kb::test::patched_prefix());
    for (const auto &[name, value] : environment)
        variables[name] = value;
    const ProcessResult result = kb::test::run(
        {KBUFFER_REFERENCE_TEST, "--driver", driver, "--digest", "--scenes", "4"}, variables);
    EXPECT_EQ(result.status, 0) << result.out << result.err;
    std::smatch digest;
    if (!std::regex_search(result.out, digest, std::regex("digest ([0-9a-f]{16})"))) {
        ADD_FAILURE() << result.out;
        return {};
    }
    return digest[1];
}

TEST(ReferenceInvariance, NumberOfThreads)
{
    const std::string first = digest_of({{"LP_NUM_THREADS", "0"}});
    for (int threads = 1; threads <= 16; ++threads)
        EXPECT_EQ(digest_of({{"LP_NUM_THREADS", std::to_string(threads)}}), first) << threads;
}

TEST(ReferenceInvariance, VectorWidthAndEarlyRejection)
{
    const std::string first = digest_of({});
    for (const char *width : {"128", "256"}) {
        for (const char *culling : {"0", "1"})
            EXPECT_EQ(digest_of({{"LP_NATIVE_VECTOR_WIDTH", width}, {"LP_KBUF_CULL", culling}}),
                      first)
                << width << " bits, culling " << culling;
    }
}

TEST(ReferenceInvariance, ColdAndWarmShaderCache)
{
    const TempDirectory cache;
    const std::map<std::string, std::string> cached{
        {"MESA_SHADER_CACHE_DIR", (cache / "").string()}};
    const std::string cold = digest_of(cached);
    EXPECT_GT(cache.file_count(), 0U) << "nothing was cached";
    EXPECT_EQ(digest_of(cached), cold);
    EXPECT_EQ(digest_of({{"MESA_SHADER_CACHE_DISABLE", "true"}}), cold);
}

TEST(ReferenceInvariance, ADigestTellsPicturesApart)
{
    // A test of these tests: the other driver puts edges at other places.
    EXPECT_NE(digest_of({}, "softpipe"), digest_of({}));
}

/// Each mistake of a driver, or of this test, is found, shrunk, and found again in the file.
class ReferenceProgram : public testing::TestWithParam<std::string>
{
};

TEST_P(ReferenceProgram, FindsShrinksAndReplays)
{
    for (const std::string driver : {"softpipe", "llvmpipe"}) {
        TempDirectory directory;
        const ProcessResult found =
            run_reference({"--driver", driver, "--scenes", "40", "--inject", GetParam(),
                           "--failures", (directory / "").string()});
        ASSERT_EQ(found.status, 1) << found.out << found.err;
        std::smatch file;
        ASSERT_TRUE(std::regex_search(found.out, file, std::regex("--replay (\\S+)"))) << found.out;
        EXPECT_NE(found.out.find(GetParam() == "ties" ? "  layers: " : "  " + GetParam() + ": "),
                  std::string::npos)
            << found.out;
        std::smatch counts;
        ASSERT_TRUE(std::regex_search(found.out, counts,
                                      std::regex("shrunk from [0-9]+ triangles to ([0-9]+)")));
        EXPECT_LE(std::stoi(counts[1]), 2);

        EXPECT_EQ(run_reference({"--driver", driver, "--replay", file[1]}).status, 0);
        const ProcessResult again =
            run_reference({"--driver", driver, "--replay", file[1], "--inject", GetParam()});
        EXPECT_EQ(again.status, 1) << again.out << again.err;
    }
}

INSTANTIATE_TEST_SUITE_P(Faults, ReferenceProgram,
                         testing::Values("coverage", "depth", "ties", "layers", "composite"),
                         [](const auto &info) { return info.param; });

TEST(ReferenceProgram, ACrashLeavesTheSeed)
{
    const ProcessResult result =
        run_reference({"--driver", "softpipe", "--seed", "17", "--inject", "crash"});
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.out.find("signal 6 at the scene of seed 17"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("0 passed, 1 failed"), std::string::npos) << result.out;
}

TEST(ReferenceProgram, BadUsageGetsOneLine)
{
    TempDirectory directory;
    const std::string bad = directory.write("bad.json", "{\"k\": 3").string();
    for (const std::vector<std::string> &arguments : {std::vector<std::string>{"--driver", "zink"},
                                                      {"--scenes", "-3"},
                                                      {"--seconds", "0"},
                                                      {"--replay", "/nowhere"},
                                                      {"--replay", bad},
                                                      {"--failures", "/nowhere"},
                                                      {"--inject", "luck"}}) {
        const ProcessResult result = run_reference(arguments);
        EXPECT_EQ(result.status, 2) << arguments[0];
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_TRUE(result.out.empty()) << result.out;
    }
    EXPECT_EQ(run_reference({"--help"}).status, 0);
}

} // namespace
