// SPDX-License-Identifier: MIT
//
// The k-buffer against a reference that shares no code with it. Stock Mesa draws every triangle
// alone (fragment-dump), which gives all fragments with their depth and color. Here they are sorted
// by std::stable_sort, cut to k and composed in double precision.

#include "picture_test.hpp"
#include "test_scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>

namespace
{

using namespace kb::test;

constexpr int side = 64;
constexpr std::size_t side_size = side;

struct Fragment {
    float depth;
    glm::vec4 color;
};

class AgainstReference : public PictureTest
{
protected:
    /// The fragments of each pixel (top row first) in the order of drawing.
    std::vector<std::vector<Fragment>> dump(const std::string &mesh, float alpha,
                                            const std::string &driver)
    {
        const std::string file = directory_ / "fragments";
        auto environment = mesa_environment(stock_prefix());
        environment["GALLIUM_DRIVER"] = driver;
        const auto result =
            run({KBUFFER_FRAGMENT_DUMP, mesh, std::to_string(side), fmt::format("{}", alpha), file},
                environment);
        EXPECT_EQ(result.status, 0) << result.err;
        std::ifstream stream(file, std::ios::binary);
        std::vector<std::vector<Fragment>> pixels(side_size * side_size);
        std::array<std::uint32_t, 6> words{};
        while (stream.read(reinterpret_cast<char *>(words.data()), sizeof(words))) {
            const std::size_t row = side_size - 1 - words[0] / side_size;
            Fragment fragment{std::bit_cast<float>(words[1]), {}};
            for (int c = 0; c < 4; ++c)
                fragment.color[c] = std::bit_cast<float>(words[std::size_t(2 + c)]);
            pixels.at(row * side_size + words[0] % side_size).push_back(fragment);
        }
        return pixels;
    }

    /// Front to back, over white.
    static kb::ImageRgbaF compose(const std::vector<Fragment> *pixels, std::size_t k)
    {
        kb::ImageRgbaF image(side, side);
        for (std::size_t p = 0; p < image.pixels.size(); ++p) {
            double transmittance = 1.0;
            double sum[3] = {};
            for (std::size_t i = 0; i < std::min(k, pixels[p].size()); ++i) {
                const double alpha = pixels[p][i].color.a;
                for (int c = 0; c < 3; ++c)
                    sum[c] += transmittance * alpha * pixels[p][i].color[c];
                transmittance *= 1.0 - alpha;
            }
            for (int c = 0; c < 3; ++c)
                image.pixels[p][c] = static_cast<float>(sum[c] + transmittance);
            image.pixels[p].a = 1.0F;
        }
        return image;
    }

    static void sort(std::vector<std::vector<Fragment>> &pixels)
    {
        for (auto &fragments : pixels)
            std::stable_sort(
                fragments.begin(), fragments.end(),
                [](const Fragment &a, const Fragment &b) { return a.depth < b.depth; });
    }

    void expect_agreement(const std::string &mesh, const std::string &driver)
    {
        for (const std::string layout : {"rgbz", "packed"}) {
            // RGBZ needs one alpha for all; eight bits hold 0.4 exactly.
            const bool rgbz = layout == "rgbz";
            auto pixels = dump(mesh, rgbz ? 0.4F : -1.0F, driver);
            sort(pixels);
            for (const int k : {1, 2, 3, 4, 8, 13, 16, 64}) {
                SCOPED_TRACE(fmt::format("{} k {}", layout, k));
                const auto ours = render(patched_prefix(),
                                         {"--mesh", mesh, "--k", std::to_string(k), "--layout",
                                          layout, "--size", fmt::format("{0}x{0}", side)},
                                         {{"GALLIUM_DRIVER", driver}});
                ASSERT_EQ(ours.depths.size(), std::size_t(k));
                expect_layers(ours, pixels, rgbz);
                const auto exact = compose(pixels.data(), std::size_t(k));
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
    static void expect_layers(const Rendering &ours,
                              const std::vector<std::vector<Fragment>> &pixels, bool rgbz)
    {
        // The driver's stage may be compiled with the shader: rounding differs in the last places.
        const double tolerance = rgbz ? std::ldexp(1.0, -22) : 0.5 / 255.0 + std::ldexp(1.0, -22);
        for (std::size_t i = 0; i < ours.depths.size(); ++i) {
            for (std::size_t p = 0; p < pixels.size(); ++p) {
                const bool kept = i < pixels[p].size();
                ASSERT_EQ(ours.depths[i].pixels[p].x, kept ? pixels[p][i].depth : 1.0F)
                    << "layer " << i << " pixel " << p;
                for (int c = 0; kept && c < 3; ++c)
                    ASSERT_NEAR(ours.colors[i].pixels[p][c], pixels[p][i].color[c], tolerance)
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
    auto pixels = dump(directory_ / "ties.ply", -1.0F, "llvmpipe");
    sort(pixels);
    EXPECT_TRUE(std::any_of(pixels.begin(), pixels.end(), [](const auto &fragments) {
        return fragments.size() >= 4 && fragments[0].depth == fragments[3].depth &&
               fragments[0].color != fragments[3].color;
    }));
    for (const std::string driver : {"llvmpipe", "softpipe"}) {
        SCOPED_TRACE(driver);
        expect_agreement(directory_ / "ties.ply", driver);
    }
}

} // namespace
