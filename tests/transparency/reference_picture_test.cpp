// SPDX-License-Identifier: MIT
//
// The k-buffer against the CPU reference.

#include "tests/support/fragment_reference.hpp"
#include "tests/support/picture_test.hpp"
#include "tests/support/test_scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace
{

using namespace kb::test;

class AgainstReference : public PictureTest
{
protected:
    void expect_agreement(const std::string &mesh, const std::string &driver)
    {
        for (const std::string layout : {"rgbz", "packed"}) {
            // RGBZ needs one alpha for all; eight bits hold 0.4 exactly.
            const bool rgbz = layout == "rgbz";
            FragmentReference reference(
                directory_, {.mesh = mesh, .alpha = rgbz ? 0.4F : -1.0F, .driver = driver});
            reference.sort();
            for (const int k : {1, 2, 3, 4, 8, 13, 16, 64}) {
                SCOPED_TRACE(fmt::format("{} k {}", layout, k));
                const auto ours = render(patched_prefix(),
                                         {"--mesh", mesh, "--k", std::to_string(k), "--layout",
                                          layout, "--size", "64x64"},
                                         {{"GALLIUM_DRIVER", driver}});
                ASSERT_EQ(ours.depths.size(), std::size_t(k));
                expect_layers(ours, reference, rgbz);
                const auto exact = reference.compose(std::size_t(k));
                if (rgbz)
                    // Each of k steps of sum += T alpha rgb, T *= 1 - alpha rounds four times
                    // values of at most 1 by half of 2^-23.
                    EXPECT_LE(max_difference(ours.floats, exact), k * std::ldexp(1.0, -22));
                else
                    // Rounding of the colors to 1/255 moves each by at most 1/510, their weights
                    // add up to at most 1, and alphas are not rounded: the sum moves by at most
                    // 1/510, the rounded sum by one step.
                    EXPECT_LE(kb::compare(ours.bytes, kb::to_rgba8(exact))->max,
                              1.0 / 255.0 + 1e-12);
            }
        }
    }

    /// Layer by layer: the depth bit for bit, and the color that came with it, which tells apart
    /// fragments of equal depth.
    static void expect_layers(const Rendering &ours, const FragmentReference &reference, bool rgbz)
    {
        // The driver's stage may be compiled with the shader: rounding differs in the last places.
        const double tolerance = rgbz ? std::ldexp(1.0, -22) : 0.5 / 255.0 + std::ldexp(1.0, -22);
        for (std::size_t i = 0; i < ours.depths.size(); ++i) {
            for (std::size_t p = 0; p < reference.sample_count(); ++p) {
                const auto &fragments = reference.at(p);
                const bool kept = i < fragments.size();
                ASSERT_EQ(ours.depths[i].pixels[p].x, kept ? fragments[i].depth : 1.0F)
                    << "layer " << i << " pixel " << p;
                for (int c = 0; kept && c < 3; ++c)
                    ASSERT_NEAR(ours.colors[i].pixels[p][c], fragments[i].color[c], tolerance)
                        << "layer " << i << " pixel " << p;
            }
        }
    }
};

TEST_F(AgainstReference, RandomTriangles)
{
    KB_NEED_STOCK();
    write_triangle_soup(directory_ / "soup.ply", 80, 3);
    expect_agreement(directory_ / "soup.ply", "llvmpipe");
}

TEST_F(AgainstReference, EqualDepthsKeepTheOrderOfArrival)
{
    KB_NEED_STOCK();
    write_tied_soup(directory_ / "ties.ply", 16, 5);
    // The scene has what it promises: in some pixel four different colors share a depth.
    FragmentReference reference(directory_, {.mesh = directory_ / "ties.ply"});
    reference.sort();
    bool tied = false;
    for (std::size_t p = 0; p < reference.sample_count(); ++p) {
        const auto &fragments = reference.at(p);
        tied = tied || (fragments.size() >= 4 && fragments[0].depth == fragments[3].depth &&
                        fragments[0].color != fragments[3].color);
    }
    EXPECT_TRUE(tied);
    for (const std::string driver : {"llvmpipe", "softpipe"}) {
        SCOPED_TRACE(driver);
        expect_agreement(directory_ / "ties.ply", driver);
    }
}

} // namespace
