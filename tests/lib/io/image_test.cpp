// SPDX-License-Identifier: MIT

#include "lib/app/timing.hpp"
#include "lib/io/image.hpp"
#include "tests/support/temp_directory.hpp"

#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>

namespace
{

using kb::test::TempDirectory;

kb::ImageRgba8 picture()
{
    kb::ImageRgba8 image(5, 3);
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 5; ++x)
            image.at(x, y) = glm::u8vec4(50 * x, 100 * y, x * y, 255 - x);
    }
    return image;
}

TEST(Png, RoundTripKeepsAllBytes)
{
    const TempDirectory directory;
    ASSERT_TRUE(kb::write_png(directory / "p.png", picture()));
    const auto read = kb::read_png(directory / "p.png");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->width, 5);
    EXPECT_EQ(read->height, 3);
    EXPECT_EQ(read->pixels, picture().pixels);
    EXPECT_EQ(directory.file_count(), 1U) << "no temporary file is left";
}

TEST(Png, BadFilesAreErrors)
{
    const TempDirectory directory;
    EXPECT_FALSE(kb::read_png(directory / "none.png"));
    EXPECT_FALSE(kb::read_png(directory.write("empty.png", "")));
    EXPECT_FALSE(kb::read_png(directory.write("text.png", "not a picture")));
    ASSERT_TRUE(kb::write_png(directory / "p.png", picture()));
    std::ifstream file(directory / "p.png", std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(file), {}};
    EXPECT_FALSE(kb::read_png(directory.write("cut.png", whole.substr(0, whole.size() / 2))));
}

TEST(Png, UnwritablePlacesAreErrorsAndLeaveNothing)
{
    const TempDirectory directory;
    EXPECT_FALSE(kb::write_png(directory / "no/such/place.png", picture()));
    EXPECT_FALSE(kb::write_png(directory / ".", picture()));
    EXPECT_FALSE(kb::write_png("", picture()));
    EXPECT_EQ(directory.file_count(), 0U);
}

TEST(Pfm, RoundTripKeepsAllBits)
{
    const TempDirectory directory;
    kb::ImageRgbaF image(2, 2);
    const float values[] = {0.1F,  -0.0F, 1e-40F, INFINITY, 3e38F, 1.0F,
                            0.25F, 2.0F,  5.0F,   6.0F,     7.0F,  8.0F};
    for (std::size_t i = 0; i < 12; ++i)
        image.pixels[i / 3][static_cast<int>(i % 3)] = values[i];
    ASSERT_TRUE(kb::write_pfm(directory / "f.pfm", image));
    const auto read = kb::read_pfm(directory / "f.pfm");
    ASSERT_TRUE(read) << read.error().message;
    for (std::size_t i = 0; i < 12; ++i)
        EXPECT_EQ(std::bit_cast<std::uint32_t>(read->pixels[i / 3][static_cast<int>(i % 3)]),
                  std::bit_cast<std::uint32_t>(values[i]));

    kb::ImageF gray(3, 1);
    gray.pixels = {0.5F, 0.25F, 1.0F};
    ASSERT_TRUE(kb::write_pfm(directory / "g.pfm", gray));
    const auto read_gray = kb::read_pfm(directory / "g.pfm");
    ASSERT_TRUE(read_gray) << read_gray.error().message;
    EXPECT_EQ(read_gray->at(1, 0), glm::vec4(0.25F, 0.25F, 0.25F, 1.0F));
}

TEST(Pfm, BadFilesAreErrors)
{
    const TempDirectory directory;
    EXPECT_FALSE(kb::read_pfm(directory.write("a.pfm", "")));
    EXPECT_FALSE(kb::read_pfm(directory.write("b.pfm", "PF\n2 2\n-1.0\nabc")));
    EXPECT_FALSE(kb::read_pfm(directory.write("c.pfm", "P6\n1 1\n-1.0\n0123")));
    EXPECT_FALSE(kb::read_pfm(directory.write("d.pfm", "Pf\n-1 1\n-1.0\n0123")));
    EXPECT_FALSE(kb::read_pfm(directory.write("e.pfm", "Pf\n1 1\n1.0\n0123"))) << "big-endian";
    EXPECT_TRUE(kb::read_pfm(directory.write("f.pfm", "Pf\n1 1\n-1.0\n0123")));
}

TEST(ToRgba8, RoundsToTheNearestStep)
{
    kb::ImageRgbaF image(1, 2);
    image.pixels = {glm::vec4(0.0F, 1.0F, 0.5F / 255.0F + 1e-6F, 0.5F / 255.0F - 1e-6F),
                    glm::vec4(-1.0F, 2.0F, std::nanf(""), 128.0F / 255.0F)};
    const auto bytes = kb::to_rgba8(image);
    EXPECT_EQ(bytes.pixels[0], glm::u8vec4(0, 255, 1, 0));
    EXPECT_EQ(bytes.pixels[1], glm::u8vec4(0, 255, 0, 128));
}

TEST(Compare, GivesMaxRmseAndShare)
{
    kb::ImageRgbaF a(2, 2);
    kb::ImageRgbaF b = a;
    auto same = kb::compare(a, b);
    ASSERT_TRUE(same);
    EXPECT_EQ(same->max, 0.0);
    EXPECT_EQ(same->share, 0.0);

    b.at(1, 0).y = 0.5F;
    b.at(0, 1).x = -0.25F;
    const auto different = kb::compare(a, b, 0.25);
    ASSERT_TRUE(different);
    EXPECT_DOUBLE_EQ(different->max, 0.5);
    EXPECT_DOUBLE_EQ(different->rmse, std::sqrt((0.25 + 0.0625) / 16.0));
    EXPECT_DOUBLE_EQ(different->share, 0.25) << "0.25 is within the tolerance";
}

TEST(Compare, NanAndInfinity)
{
    kb::ImageRgbaF a(1, 1);
    kb::ImageRgbaF b(1, 1);
    a.pixels[0] = glm::vec4(std::nanf(""), INFINITY, 0.0F, 0.0F);
    b.pixels[0] = a.pixels[0];
    EXPECT_EQ(kb::compare(a, b)->max, 0.0);
    b.pixels[0].x = 0.0F;
    EXPECT_EQ(kb::compare(a, b)->max, INFINITY);
    b.pixels[0] = glm::vec4(std::nanf(""), -INFINITY, 0.0F, 0.0F);
    EXPECT_EQ(kb::compare(a, b)->max, INFINITY);
}

TEST(Compare, BytesAndSizes)
{
    kb::ImageRgba8 a = picture();
    kb::ImageRgba8 b = a;
    b.at(4, 2).z += 51;
    EXPECT_DOUBLE_EQ(kb::compare(a, b)->max, 0.2);
    EXPECT_FALSE(kb::compare(a, kb::ImageRgba8(3, 5)));
}

TEST(Spread, InterpolatesBetweenRanks)
{
    const double values[] = {30.0, 10.0, 20.0};
    const auto spread = kb::spread_of(values);
    EXPECT_DOUBLE_EQ(spread.median, 20.0);
    EXPECT_DOUBLE_EQ(spread.p5, 11.0);
    EXPECT_DOUBLE_EQ(spread.p95, 29.0);
    EXPECT_EQ(kb::spread_of({}).median, 0.0);
}

TEST(Spread, OneMeasurementHasNoPercentiles)
{
    const double values[] = {30.0, 10.0, 20.0};
    EXPECT_EQ(describe(kb::spread_of(values)), "20.00 ms (5 % 11.00, 95 % 29.00, 3 times)");
    EXPECT_EQ(describe(kb::spread_of(values), "sorting 1.00"),
              "20.00 ms (5 % 11.00, 95 % 29.00, 3 times; sorting 1.00)");
    EXPECT_EQ(describe(kb::spread_of(std::span(values, 1))), "30.00 ms");
    EXPECT_EQ(describe(kb::spread_of(std::span(values, 1)), "sorting 1.00"),
              "30.00 ms (sorting 1.00)");
}

} // namespace
