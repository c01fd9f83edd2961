// SPDX-License-Identifier: MIT

#include "isosurface/iso_values.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace kb::test
{

namespace
{

std::vector<IsoValue> iso_values(const std::vector<float> &values)
{
    std::vector<IsoValue> isos;
    for (const float value : values)
        isos.push_back({value, glm::vec3(value), value});
    return isos;
}

/// What a program reads at a scalar, and the neighbouring texel that rounding may lead it to.
std::vector<glm::vec4> look_up(const IsoTable &table, float scalar)
{
    const auto texels = static_cast<int>(table.neighbours.size());
    const double place =
        ((double(scalar) - table.base) * table.scale + table.offset) * static_cast<double>(texels);
    std::vector<glm::vec4> found;
    for (const double step : {-0.4, 0.0, 0.4}) {
        const double texel = std::clamp(std::floor(place + step), 0.0, texels - 1.0);
        found.push_back(table.neighbours[static_cast<std::size_t>(texel)]);
    }
    return found;
}

void expect_exact(const std::vector<float> &values, float scalar, const IsoTable &table)
{
    float above = IsoTable::no_value;
    float below = -IsoTable::no_value;
    for (const float value : values) {
        if (value >= scalar)
            above = std::min(above, value);
        if (value <= scalar)
            below = std::max(below, value);
    }
    for (const glm::vec4 &texel : look_up(table, scalar)) {
        ASSERT_EQ(scalar <= texel.y ? texel.y : texel.z, above) << scalar;
        ASSERT_EQ(scalar >= texel.y ? texel.y : texel.x, below) << scalar;
    }
}

TEST(IsoTable, GivesTheNextValueAboveAndBelowWithoutError)
{
    std::mt19937 random(7);
    const auto number = [&random] { return static_cast<float>(random() >> 8U) * 0x1p-24F; };
    for (const std::size_t count : {1U, 2U, 3U, 10U, 60U}) {
        for (int round = 0; round < 20; ++round) {
            std::vector<float> values;
            for (std::size_t i = 0; i < count; ++i)
                values.push_back(number());
            const auto table = make_iso_table(iso_values(values), 1 << 20);
            ASSERT_TRUE(table) << table.error().message;
            for (const float value : values) {
                for (const float scalar :
                     {value, std::nextafter(value, 2.0F), std::nextafter(value, -1.0F), number()})
                    expect_exact(values, scalar, *table);
            }
            for (const float scalar : {-1.0F, 0.0F, 1.0F, 5.0F})
                expect_exact(values, scalar, *table);
        }
    }
}

TEST(IsoTable, OfNoValuesHasNone)
{
    const auto table = make_iso_table({}, 16);
    ASSERT_TRUE(table);
    for (const float scalar : {-1.0F, 0.0F, 0.5F, 2.0F})
        expect_exact({}, scalar, *table);
}

TEST(IsoTable, TakesEqualValuesForOne)
{
    const auto table = make_iso_table(iso_values({0.5F, 0.25F, 0.5F}), 16);
    ASSERT_TRUE(table) << table.error().message;
    expect_exact({0.25F, 0.5F}, 0.4F, *table);
}

TEST(IsoTable, HasTheColorOfEachValueWhereItIs)
{
    const std::vector<float> values{0.1F, 0.3F, 0.35F, 0.9F};
    const auto table = make_iso_table(iso_values(values), 1024);
    ASSERT_TRUE(table);
    for (const float value : values) {
        const double place = (double(value) - table->base) * table->scale + table->offset;
        const auto texel =
            static_cast<std::size_t>(place * static_cast<double>(table->colors.size()));
        EXPECT_EQ(table->colors.at(texel), glm::vec4(glm::vec3(value), 1.0F));
    }
}

TEST(IsoTable, RefusesWhatItCannotTellApart)
{
    const auto near = make_iso_table(iso_values({0.0F, 0.5F, 0.5001F, 1.0F}), 16384);
    ASSERT_FALSE(near);
    EXPECT_NE(near.error().message.find("0.5 and 0.5001"), std::string::npos);
    EXPECT_TRUE(make_iso_table(iso_values({0.5F, 0.5001F}), 16384)) << "near in itself is no error";
    EXPECT_FALSE(make_iso_table(iso_values({0.0F, std::numeric_limits<float>::denorm_min()}), 16));
    EXPECT_FALSE(make_iso_table(iso_values({std::nanf("")}), 16));
    EXPECT_FALSE(make_iso_table(iso_values({0.5F, INFINITY}), 16));
}

TEST(IsoValues, AreReadWithAndWithoutColor)
{
    const auto plain = parse_iso_value("-2.5e-1");
    ASSERT_TRUE(plain);
    EXPECT_EQ(plain->value, -0.25F);
    EXPECT_FALSE(plain->has_color);
    const auto colored = parse_iso_value("3=ff8000");
    ASSERT_TRUE(colored);
    EXPECT_EQ(colored->value, 3.0F);
    EXPECT_TRUE(colored->has_color);
    EXPECT_EQ(colored->color, glm::vec3(255.0F, 128.0F, 0.0F) / 255.0F);
    const auto named = parse_iso_value("3=red");
    ASSERT_TRUE(named);
    EXPECT_EQ(named->color, glm::vec3(1.0F, 0.0F, 0.0F));
    for (const char *text : {"", "x", "1x", "nan", "inf", "1e999", "=ff8000", "1=", "1=ff800",
                             "1=ff80000", "1=-f8000", "1=gg8000", "1,2"})
        EXPECT_FALSE(parse_iso_value(text)) << text;
}

TEST(IsoValues, OutOfTheRangeAreLeftOut)
{
    const auto inside = normalized(iso_values({-1.0F, 2.0F, 3.0F, 4.0F, 4.5F}), {2.0F, 4.0F});
    ASSERT_EQ(inside.size(), 3U);
    EXPECT_EQ(inside[0].scalar, 0.0F);
    EXPECT_EQ(inside[0].value, 2.0F);
    EXPECT_EQ(inside[1].scalar, 0.5F);
    EXPECT_EQ(inside[2].scalar, 1.0F);
}

} // namespace

} // namespace kb::test
