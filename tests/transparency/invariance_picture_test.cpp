// SPDX-License-Identifier: MIT
//
// What must not change the picture: threads, vector width, the kind of context. And what may change
// it a little: the driver.

#include "tests/support/picture_test.hpp"
#include "tests/support/test_scenes.hpp"

#include <fmt/format.h>

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
    expect_agreement_inside_of_faces({llvmpipe.floats, llvmpipe.depths},
                                     {softpipe.floats, softpipe.depths}, 12);
}

} // namespace
