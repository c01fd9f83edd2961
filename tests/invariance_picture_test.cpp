// SPDX-License-Identifier: MIT
//
// What must not change the picture: threads, vector width, the kind of context. And what may change
// it a little: the driver.

#include "picture_test.hpp"
#include "test_scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace
{

using namespace kb::test;

class Invariance : public PictureTest
{
};

TEST_F(Invariance, ThreadsAndVectorWidth)
{
    write_tied_soup(directory_ / "soup.ply", 30, 11);
    for (const std::string layout : {"rgbz", "packed"}) {
        std::string first;
        for (const std::string width : {"256", "128"}) {
            for (const std::string threads : {"0", "1", "2", "8"}) {
                SCOPED_TRACE(fmt::format("{} width {} threads {}", layout, width, threads));
                // More than one tile of 64x64, and a size that is not a multiple of one.
                const auto rendering =
                    render(patched_prefix(),
                           {"--mesh", directory_ / "soup.ply", "--layout", layout, "--k", "10",
                            "--size", "200x150"},
                           {{"LP_NUM_THREADS", threads}, {"LP_NATIVE_VECTOR_WIDTH", width}});
                ASSERT_FALSE(rendering.float_file.empty());
                if (first.empty())
                    first = rendering.float_file;
                EXPECT_TRUE(rendering.float_file == first);
            }
        }
    }
}

TEST_F(Invariance, RepeatedDrawing)
{
    write_triangle_soup(directory_ / "soup.ply", 30, 12);
    const std::string mesh = directory_ / "soup.ply";
    const auto once = render(patched_prefix(), {"--mesh", mesh});
    const auto thrice = render(patched_prefix(), {"--mesh", mesh, "--repeat", "3"});
    EXPECT_TRUE(once.float_file == thrice.float_file);
}

TEST_F(Invariance, KindOfContext)
{
    write_triangle_soup(directory_ / "soup.ply", 30, 13);
    const std::string mesh = directory_ / "soup.ply";
    const auto osmesa = render(patched_prefix(), {"--mesh", mesh, "--context", "osmesa"});
    const auto egl = render(patched_prefix(), {"--mesh", mesh, "--context", "egl"});
    ASSERT_FALSE(egl.float_file.empty());
    EXPECT_TRUE(osmesa.float_file == egl.float_file);
}

TEST_F(Invariance, SoftpipeAgreesInsideOfFaces)
{
    write_plane_stack(directory_ / "planes.ply", 12, 17);
    const std::vector<std::string> arguments{"--mesh",      directory_ / "planes.ply",
                                             "--layout",    "rgbz",
                                             "--k",         "12",
                                             "--size",      "128x128",
                                             "--elevation", "20"};
    const auto llvmpipe = render(patched_prefix(), arguments, {{"GALLIUM_DRIVER", "llvmpipe"}});
    const auto softpipe = render(patched_prefix(), arguments, {{"GALLIUM_DRIVER", "softpipe"}});
    ASSERT_EQ(llvmpipe.depths.size(), 12U);
    ASSERT_EQ(softpipe.depths.size(), 12U);

    // The drivers put edges at other places (llvmpipe snaps vertices to 1/256 pixel): compare where
    // in both the number of layers is the same in the whole neighbourhood of 5x5 pixels.
    const auto count = [](const Rendering &rendering, int x, int y) {
        return std::count_if(rendering.depths.begin(), rendering.depths.end(),
                             [x, y](const kb::ImageRgbaF &d) { return d.at(x, y).x < 1.0F; });
    };
    const auto is_inside = [&](int x, int y) {
        for (int dy = -2; dy <= 2; ++dy) {
            for (int dx = -2; dx <= 2; ++dx) {
                if (count(llvmpipe, x + dx, y + dy) != count(llvmpipe, x, y) ||
                    count(softpipe, x + dx, y + dy) != count(llvmpipe, x, y))
                    return false;
            }
        }
        return true;
    };
    // Snapping moves a plane's vertices by up to 1/512 pixel. Colors and depths change by less than
    // 1/32 a pixel in this scene (a face is some 60 pixels wide, and the light falls off by less
    // than half across it), so by less than 1/32 * sqrt(2)/512 through that, and less again by
    // rounding of the plane equations: some 2^-24 * 128 pixels * 1/32.
    const double tolerance = 1.5 / (32.0 * 512.0) + std::ldexp(1.0, -22);
    int inside = 0;
    int deepest = 0;
    for (int y = 2; y < 126; ++y) {
        for (int x = 2; x < 126; ++x) {
            if (!is_inside(x, y))
                continue;
            ++inside;
            deepest = std::max(deepest, static_cast<int>(count(llvmpipe, x, y)));
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(llvmpipe.floats.at(x, y)[c], softpipe.floats.at(x, y)[c], tolerance)
                    << x << ", " << y;
            for (std::size_t i = 0; i < 12; ++i)
                ASSERT_NEAR(llvmpipe.depths[i].at(x, y).x, softpipe.depths[i].at(x, y).x, tolerance)
                    << x << ", " << y << " layer " << i;
        }
    }
    EXPECT_GT(inside, 2000) << "most of the picture was compared";
    EXPECT_EQ(deepest, 12);
}

} // namespace
