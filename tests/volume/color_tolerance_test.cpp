// SPDX-License-Identifier: MIT
//
// What being off may cost, by brute force from the transfer function's own values.

#include "volume/color_tolerance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

namespace
{

using kb::ColorTolerance;
using kb::TransferFunction;

TransferFunction make(std::vector<kb::TransferPoint> points)
{
    auto function = TransferFunction::make(std::move(points));
    EXPECT_TRUE(function) << function.error().message;
    return *std::move(function);
}

/// How much of what is allowed is used when a scalar r stands for s: more than 1 is too much.
double use(const TransferFunction &transfer, double tolerance, double s, double r)
{
    const kb::TransferPoint at_s = transfer.at(static_cast<float>(s));
    const kb::TransferPoint at_r = transfer.at(static_cast<float>(r));
    double off = 0.0;
    for (int c = 0; c < 3; ++c) {
        const auto light = [c](const kb::TransferPoint &p, double behind) {
            return p.extinction * (p.color[c] - behind);
        };
        for (const double behind : {0.0, 0.5, 1.0})
            off = std::max(off, std::abs(light(at_r, behind) - light(at_s, behind)));
    }
    return off / (0.5 * tolerance * (0.5 + at_s.extinction));
}

TEST(ColorTolerance, NoAllowedDeviationIsTooMuch)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit;
    double most = 0.0;
    for (int trial = 0; trial < 300; ++trial) {
        std::vector<kb::TransferPoint> points;
        for (const float value : {0.0F, 0.3F, 0.35F, 0.8F, 1.0F})
            points.push_back({value,
                              {unit(random), unit(random), unit(random)},
                              20.0F * unit(random) * unit(random)});
        const TransferFunction transfer = make(points);
        const double tolerance = 0.5 * unit(random);
        const double low = unit(random);
        const double high = low + 0.1 * unit(random);
        const double deviation = ColorTolerance(transfer, tolerance).most_deviation(low, high);
        for (int i = 0; i <= 100; ++i) {
            const double s = low + (high - low) * i / 100.0;
            for (const double part : {-1.0, -0.5, 0.5, 1.0})
                most = std::max(most, use(transfer, tolerance, s, s + part * deviation));
        }
    }
    // The functions' values are floats: of 20 at most, so that differences are 4e-6 off.
    EXPECT_LE(most, 1.001);
    EXPECT_GE(most, 0.9) << "and what is allowed is not far from what could be";
}

TEST(ColorTolerance, WhereTheFunctionIsConstantAnyScalarMayStandForAnyOther)
{
    const ColorTolerance tolerance(
        make({{0.2F, {1, 0, 0}, 3}, {0.6F, {1, 0, 0}, 3}, {1.0F, {0, 1, 0}, 5}}), 0.0);
    EXPECT_TRUE(tolerance.allows(-0.5, 0.6));
    EXPECT_FALSE(tolerance.allows(0.5, 0.6001));
    EXPECT_TRUE(tolerance.allows(1.0, 9.0)) << "beyond the last point";
    EXPECT_EQ(tolerance.most_deviation(0.7, 0.8), 0.0);
    EXPECT_NEAR(tolerance.most_deviation(0.2, 0.5), 0.1, 2e-6);
    EXPECT_EQ(tolerance.most_deviation(-3.0, -1.0), 1.0);
}

TEST(ColorTolerance, ColorsDoNotMatterWithoutExtinction)
{
    const ColorTolerance tolerance(make({{0, {1, 0, 0}, 0}, {0.5F, {0, 1, 0}, 0}, {1, {}, 4}}),
                                   0.0);
    EXPECT_TRUE(tolerance.allows(0.0, 0.5));
    EXPECT_FALSE(tolerance.allows(0.0, 0.51));
}

TEST(ColorTolerance, StepsAllowNothing)
{
    const ColorTolerance tolerance(make({{0, {}, 1}, {0.5F, {}, 1}, {0.5F, {}, 2}, {1, {}, 2}}),
                                   1.0);
    EXPECT_TRUE(tolerance.allows(0.0, 0.499));
    EXPECT_TRUE(tolerance.allows(0.501, 1.0));
    EXPECT_FALSE(tolerance.allows(0.4, 0.5)) << "what is at the step may be on either side";
    EXPECT_FALSE(tolerance.allows(0.5, 0.6));
    EXPECT_NEAR(tolerance.most_deviation(0.1, 0.3), 0.2, 2e-6);
}

TEST(ColorTolerance, InfiniteExtinctionIsNoSpecialCase)
{
    const float infinity = std::numeric_limits<float>::infinity();
    const ColorTolerance tolerance(
        make({{0, {}, 0}, {0.4F, {}, 0}, {0.5F, {}, infinity}, {1, {}, infinity}}), 0.01);
    EXPECT_TRUE(tolerance.allows(0.0, 0.4));
    EXPECT_TRUE(tolerance.allows(0.5, 1.0));
    EXPECT_FALSE(tolerance.allows(0.3, 0.6));
}

TEST(ColorTolerance, MoreIsAllowedWhereLittleLightComesFrom)
{
    // Twice the slope, but behind most of what absorbs: 0.25 (0.5 + 40) against 0.25 (0.5 + 0).
    const ColorTolerance tolerance(make({{0, {}, 0}, {0.5F, {}, 1}, {0.6F, {}, 40}, {1, {}, 42}}),
                                   0.5);
    EXPECT_GT(tolerance.most_deviation(0.8, 0.8), 10 * tolerance.most_deviation(0.1, 0.1) - 1.0);
    EXPECT_GT(tolerance.most_deviation(0.8, 0.8), tolerance.most_deviation(0.1, 0.1));
}

} // namespace
