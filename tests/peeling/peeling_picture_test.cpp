// SPDX-License-Identifier: MIT
//
// The k-buffer and GL_DEPTH_PEELING in one pass on the patched Mesa against classic depth peeling
// in k passes on stock Mesa: the same k layers.

#include "tests/support/picture_test.hpp"
#include "tests/support/test_scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace
{

using namespace kb::test;

class AgainstPeeling : public PictureTest
{
protected:
    std::vector<std::string> arguments(int k, const std::string &layout, const std::string &method)
    {
        const auto mesh = directory_ / "soup.ply";
        if (!std::filesystem::exists(mesh))
            write_triangle_soup(mesh, 60, 7);
        return {"--mesh", mesh,       "--k",  std::to_string(k), "--layout",
                layout,   "--method", method, "--size",          "96x80"};
    }
};

TEST_F(AgainstPeeling, FloatLayersAreTheSame)
{
    KB_NEED_STOCK();
    for (const int k : {1, 2, 3, 7, 8, 9, 16, 64}) {
        const auto peeled = render(stock_prefix(), arguments(k, "rgbz", "classic-peeling"));
        ASSERT_EQ(peeled.depths.size(), std::size_t(k));
        for (const std::string method : {"kbuffer", "peeling"}) {
            SCOPED_TRACE(fmt::format("{} k {}", method, k));
            const auto ours = render(patched_prefix(), arguments(k, "rgbz", method));
            ASSERT_EQ(ours.depths.size(), std::size_t(k));
            for (std::size_t i = 0; i < ours.depths.size(); ++i) {
                EXPECT_EQ(max_difference(ours.depths[i], peeled.depths[i]), 0.0) << "layer " << i;
                EXPECT_LE(max_difference(ours.colors[i], peeled.colors[i]), std::ldexp(1.0, -22))
                    << "layer " << i;
            }
            // Each of k steps of sum += T alpha rgb, T *= 1 - alpha rounds four times values of at
            // most 1 by half of 2^-23.
            EXPECT_LE(max_difference(ours.floats, peeled.floats), k * std::ldexp(1.0, -22));
        }
        // Enough fragments meet to make all layers of a small k matter.
        if (k <= 16) {
            const auto &last = peeled.depths.back().pixels;
            EXPECT_GT(std::count_if(last.begin(), last.end(),
                                    [](const glm::vec4 &depth) { return depth.x < 1.0F; }),
                      100);
        }
    }
}

TEST_F(AgainstPeeling, PackedPicturesAreWithinOneStep)
{
    KB_NEED_STOCK();
    for (const int k : {1, 4, 5, 8, 32, 64}) {
        const auto peeled = render(stock_prefix(), arguments(k, "packed", "classic-peeling"));
        for (const std::string method : {"kbuffer", "peeling"}) {
            SCOPED_TRACE(fmt::format("{} k {}", method, k));
            const auto ours = render(patched_prefix(), arguments(k, "packed", method));
            ASSERT_EQ(ours.depths.size(), peeled.depths.size());
            for (std::size_t i = 0; i < ours.depths.size(); ++i)
                EXPECT_EQ(max_difference(ours.depths[i], peeled.depths[i]), 0.0) << "layer " << i;
            const auto difference = kb::compare(ours.bytes, peeled.bytes);
            ASSERT_TRUE(difference);
            EXPECT_LE(difference->max, 1.0 / 255.0 + 1e-12);
        }
    }
}

TEST_F(AgainstPeeling, UnsortedIsAnotherPicture)
{
    // A test of the tests above: these scenes do tell right from wrong.
    const auto ours = render(patched_prefix(), arguments(8, "rgbz", "kbuffer"));
    auto fewer = render(patched_prefix(), arguments(7, "rgbz", "kbuffer"));
    EXPECT_GT(max_difference(ours.floats, fewer.floats), 1e-3) << "the eighth layer is seen";

    const auto mesh = directory_ / "soup.ply";
    const auto unsorted = directory_ / "unsorted.png";
    const auto result = run({KBUFFER_TRANSPARENCY, "--mesh", mesh, "--method", "unsorted", "--size",
                             "96x80", "--out", unsorted},
                            mesa_environment(patched_prefix()));
    ASSERT_EQ(result.status, 0) << result.err;
    const auto picture = kb::read_png(unsorted);
    ASSERT_TRUE(picture);
    EXPECT_GT(kb::compare(*picture, ours.bytes)->max, 0.1);
}

} // namespace
