// SPDX-License-Identifier: MIT
//
// The integrals over ray segments against closed forms.

#include "volume/preintegration.hpp"

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace
{

using kb::PreintegratedTable;
using kb::TransferFunction;

/// Red goes from 0 to 1 and green is constant, extinction as given at the ends.
TransferFunction ramp(float first, float last)
{
    return *TransferFunction::make(
        {{0.0F, {0.0F, 0.25F, 1.0F}, first}, {1.0F, {1.0F, 0.25F, 0.0F}, last}});
}

/// coth(D / 2) - 2 / D: how far the color of a segment is from the mean towards its front end,
/// where extinction is constant and color linear. With digits to spare where the two nearly cancel.
double closed_fade(double depth)
{
    const long double half = 0.5L * static_cast<long double>(depth);
    return static_cast<double>(1.0L / std::tanh(half) - 1.0L / half);
}

TEST(Preintegration, FadeIsTheClosedForm)
{
    // 64 bits leave 1e-13 of 2e6, and of small depths there is a series to 3e-12.
    for (double depth = 1e-6; depth < 1e9; depth *= 1.05)
        EXPECT_NEAR(kb::fade(depth), closed_fade(depth), 4e-12) << depth;
    EXPECT_EQ(kb::fade(0.0), 0.0);
}

TEST(Preintegration, ConstantExtinctionAndLinearColorAreAsInTheClosedForm)
{
    for (const float extinction : {1e-3F, 0.1F, 1.0F, 10.0F, 1000.0F}) {
        const kb::SegmentOptics optics =
            kb::integrate_segment(ramp(extinction, extinction), 0.0F, 1.0F, 1.0F);
        EXPECT_NEAR(optics.extinction, extinction, 1e-6 * extinction);
        EXPECT_NEAR(optics.color.r, 0.5 * (1.0 - closed_fade(extinction)), 1e-6) << extinction;
        EXPECT_NEAR(optics.color.g, 0.25, 1e-6);
    }
}

TEST(Preintegration, ACutSegmentIsTheSameAsAWholeOne)
{
    const TransferFunction transfer = ramp(1.0F, 8.0F);
    const kb::SegmentOptics whole = kb::integrate_segment(transfer, 0.0F, 1.0F, 1.0F);
    for (const int parts : {2, 4, 8}) {
        glm::dvec3 sum(0.0);
        double depth = 0.0;
        for (int i = 0; i < parts; ++i) {
            const auto part =
                kb::integrate_segment(transfer, float(i) / float(parts),
                                      float(i + 1) / float(parts), 1.0F / float(parts));
            const double next = depth + part.extinction / parts;
            sum += glm::dvec3(part.color) * (std::exp(-depth) - std::exp(-next));
            depth = next;
        }
        EXPECT_NEAR(depth, 4.5, 1e-5);
        // Row 23 of the hard cases: 1e-4.
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(sum[c], whole.color[c] * -std::expm1(-4.5), 1e-4) << parts << ", " << c;
    }
}

TEST(Preintegration, APeakBetweenTheEndsIsNotMissed)
{
    const auto transfer = TransferFunction::make({{0.0F, {0.0F, 0.0F, 1.0F}, 0.0F},
                                                  {0.49F, {0.0F, 0.0F, 1.0F}, 0.0F},
                                                  {0.50F, {1.0F, 0.0F, 0.0F}, 100.0F},
                                                  {0.51F, {0.0F, 0.0F, 1.0F}, 0.0F},
                                                  {1.0F, {0.0F, 0.0F, 1.0F}, 0.0F}});
    ASSERT_TRUE(transfer);
    const auto optics = kb::integrate_segment(*transfer, 0.0F, 1.0F, 0.1F);
    EXPECT_NEAR(optics.extinction, 1.0, 1e-5); // A triangle of base .02 and height 100.
    // Color and extinction are proportional across it: the mean of x^2 over that of x is 2/3.
    EXPECT_NEAR(kb::integrate_segment(*transfer, 0.0F, 1.0F, 0.0F).color.r, 2.0 / 3.0, 1e-5);
}

TEST(Preintegration, BackwardsItIsMirrored)
{
    const TransferFunction transfer = ramp(3.0F, 3.0F);
    const auto there = kb::integrate_segment(transfer, 0.2F, 0.7F, 1.0F);
    const auto back = kb::integrate_segment(transfer, 0.7F, 0.2F, 1.0F);
    EXPECT_FLOAT_EQ(there.extinction, back.extinction);
    EXPECT_NEAR(there.color.r - 0.2F, 0.7F - back.color.r, 1e-6F);
}

TEST(Preintegration, NothingIsNanWhereThereIsNoOrInfiniteExtinction)
{
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float extinction : {0.0F, infinity}) {
        for (const float length : {0.0F, 1e-7F, 2.0F}) {
            const auto optics =
                kb::integrate_segment(ramp(extinction, extinction), 0.25F, 0.75F, length);
            EXPECT_LE(optics.extinction, PreintegratedTable::max_extinction);
            for (int c = 0; c < 3; ++c) {
                EXPECT_GE(optics.color[c], 0.0F);
                EXPECT_LE(optics.color[c], 1.0F);
            }
        }
    }
}

/// The texel of a mean that is one and of the difference that is nearest to the given one.
struct Texel {
    std::size_t index;
    double difference;
};

Texel texel_at(const PreintegratedTable &table, double mean, double difference)
{
    constexpr double half = PreintegratedTable::half_difference;
    const kb::TableSize size = table.size(); // With differences from -1 to 1
    const double place = difference / (std::abs(difference) + half) * (1.0 + half);
    const double row = std::round(0.5 * (place + 1.0) * (size.differences - 1));
    const double at = (2.0 * row / (size.differences - 1) - 1.0) / (1.0 + half);
    return {static_cast<std::size_t>(row) * static_cast<std::size_t>(size.means) +
                static_cast<std::size_t>(std::lround(mean * (size.means - 1))),
            half * at / (1.0 - std::abs(at))};
}

TEST(Preintegration, TheTableHoldsTheIntegrals)
{
    const TransferFunction transfer = ramp(2.0F, 2.0F);
    const PreintegratedTable table(transfer, {65, 33});
    for (const double difference : {-1.0, -0.3, -0.05, 0.1, 0.6}) {
        const auto [index, actual] = texel_at(table, 0.5, difference);
        const auto front = static_cast<float>(0.5 - actual / 2.0);
        const auto back = static_cast<float>(0.5 + actual / 2.0);
        for (const float length : {0.0F, 0.1F, 1.0F, 5.0F}) {
            const auto optics = kb::integrate_segment(transfer, front, back, length);
            const glm::vec4 thin = table.thin()[index];
            EXPECT_NEAR(thin.w, optics.extinction, 1e-6F);
            const double fade = kb::fade(thin.w * length);
            EXPECT_NEAR(thin.r + fade * actual * table.fading()[index].r, optics.color.r, 2e-6)
                << difference << ", " << length;
        }
    }
}

TEST(Preintegration, WhereColorsAreLinearFadingIsConstant)
{
    // So that interpolation between texels is right: half of the color's slope, backwards. Also
    // where segments cannot be, beside those that can.
    const PreintegratedTable table(ramp(2.0F, 2.0F), {65, 33});
    for (const glm::vec4 &fading : table.fading()) {
        EXPECT_NEAR(fading.r, -0.5F, 1e-3F);
        EXPECT_NEAR(fading.g, 0.0F, 1e-3F);
        EXPECT_NEAR(fading.b, 0.5F, 1e-3F);
    }
}

} // namespace
