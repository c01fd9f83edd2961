// SPDX-License-Identifier: MIT
//
// Segments against closed forms. Where no bound is named the tolerance is that of a hundred
// roundings of numbers up to 1, 1e-14: what is tested is exact but for rounding.

#include "tests/integrator/segment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace
{

using namespace kb::integrator;

constexpr double rounding = 1e-14;
constexpr double infinity = std::numeric_limits<double>::infinity();

Medium constant(double extinction, glm::dvec3 color = glm::dvec3(1.0))
{
    return Medium({{0.0, color, extinction}});
}

/// Black to red, of one extinction.
Medium linear_emission(double extinction)
{
    return Medium({{0.0, {0.0, 0.0, 0.0}, extinction}, {1.0, {1.0, 0.0, 0.0}, extinction}});
}

/// Light that a segment gives when it is cut in equal parts.
Light integrate_parts(const Medium &medium, double front, double back, double length, int parts)
{
    Light light;
    for (int i = 0; i < parts; ++i)
        light.append(integrate_segment(medium, std::lerp(front, back, double(i) / parts),
                                       std::lerp(front, back, double(i + 1) / parts),
                                       length / parts));
    return light;
}

TEST(IntegratorSegment, ConstantMatterIsBeerLambert)
{
    for (const double depth : {1e-9, 1e-4, 0.5, 3.0, 40.0}) {
        const Light light = integrate_segment(constant(depth, {0.25, 0.5, 1.0}), 0.3, 0.7, 1.0);
        EXPECT_NEAR(light.optical_depth / depth, 1.0, rounding);
        EXPECT_NEAR(light.alpha() / -std::expm1(-depth), 1.0, rounding);
        EXPECT_NEAR(light.color.r / (0.25 * -std::expm1(-depth)), 1.0, rounding);
        EXPECT_NEAR(light.color.b / -std::expm1(-depth), 1.0, rounding);
    }
}

TEST(IntegratorSegment, LinearEmissionIsItsClosedForm)
{
    // Integral of D s exp(-D s) from 0 to 1: (1 - (1 + D) exp(-D)) / D; from the other end, of
    // D (1 - s) exp(-D s): (exp(-D) - 1 + D) / D.
    for (const double depth : {0.5, 1.0, 4.0, 30.0, 2000.0}) {
        const double rising = (1.0 - (1.0 + depth) * std::exp(-depth)) / depth;
        const double falling = (std::exp(-depth) - 1.0 + depth) / depth;
        EXPECT_NEAR(integrate_segment(linear_emission(depth), 0.0, 1.0, 1.0).color.r, rising,
                    rounding);
        EXPECT_NEAR(integrate_segment(linear_emission(depth), 1.0, 0.0, 1.0).color.r, falling,
                    rounding);
    }
    // D / 2 - D^2 / 3 + D^3 / 8 - ..., which the form above cannot give for small D.
    const double depth = 1e-5;
    EXPECT_NEAR(integrate_segment(linear_emission(depth), 0.0, 1.0, 1.0).color.r / depth,
                0.5 - depth / 3.0 + depth * depth / 8.0, rounding);
}

TEST(IntegratorSegment, LinearExtinctionAndEmissionAreTheirClosedForm)
{
    // Extinction D s and color s over length 1: A = D s^2 / 2, and by parts the light is
    // -exp(-D/2) + integral of exp(-D s^2 / 2) = -exp(-D/2) + sqrt(pi / (2 D)) erf(sqrt(D / 2)).
    for (const double density : {0.1, 1.0, 7.0, 300.0, 1e6}) {
        const Medium medium({{0.0, {0.0, 0.0, 0.0}, 0.0}, {1.0, {1.0, 0.0, 0.0}, density}});
        const double expected =
            -std::exp(-density / 2.0) +
            std::sqrt(std::acos(-1.0) / (2.0 * density)) * std::erf(std::sqrt(density / 2.0));
        const Light light = integrate_segment(medium, 0.0, 1.0, 1.0);
        EXPECT_NEAR(light.color.r, expected, rounding) << density;
        EXPECT_NEAR(light.optical_depth / density, 0.5, rounding);
    }
}

TEST(IntegratorSegment, CuttingItChangesNothing)
{
    const Medium medium({{-1.0, {0.1, 0.9, 0.3}, 0.0},
                         {0.2, {0.9, 0.1, 0.5}, 9.0},
                         {0.5, {0.2, 0.2, 0.9}, 2.0},
                         {0.5, {1.0, 0.0, 0.0}, 40.0}, // a step
                         {0.9, {0.0, 1.0, 0.0}, 0.0}});
    for (const auto &[front, back] :
         {std::pair(-2.0, 1.5), std::pair(1.5, -2.0), std::pair(0.1, 0.6), std::pair(0.6, 0.1)}) {
        const Light whole = integrate_segment(medium, front, back, 1.7);
        for (const int parts : {2, 3, 4, 8, 1000}) {
            const Light cut = integrate_parts(medium, front, back, 1.7, parts);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(cut.color[c], whole.color[c], parts * rounding);
            EXPECT_NEAR(cut.optical_depth, whole.optical_depth, parts * rounding);
        }
    }
}

TEST(IntegratorSegment, AgreesWithAFineRiemannSum)
{
    // A test that shares no formula: midpoint rule of n parts. Its error is at most 1/24 n^-2 max
    // f'' where f is smooth, f = extinction color exp(-A) with slopes of some 10 here, f'' < 2000
    // or so for the extinctions up to 9: below 1e-9 with n = 1e6; at the kinks, n^-2 times a
    // slope's jump.
    const Medium medium(
        {{0.0, {0.1, 0.9, 0.3}, 1.0}, {0.3, {0.9, 0.1, 0.5}, 9.0}, {1.0, {0.2, 0.2, 0.9}, 2.0}});
    constexpr int parts = 1'000'000;
    glm::dvec3 color(0.0);
    double depth = 0.0;
    for (int i = 0; i < parts; ++i) {
        const double scalar = (i + 0.5) / parts;
        const Matter matter = medium.pieces()[scalar < 0.3 ? 1 : 2].at(scalar);
        const double step = matter.extinction / parts;
        color += step * std::exp(-depth - 0.5 * step) * matter.color;
        depth += step;
    }
    const Light light = integrate_segment(medium, 0.0, 1.0, 1.0);
    EXPECT_NEAR(light.optical_depth, depth, 1e-9);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(light.color[c], color[c], 1e-9);
}

TEST(IntegratorSegment, ManySmallOpticalDepthsAddUp)
{
    // Hard case 14.
    for (const double depth : {1e-4, 1e-5}) {
        const Medium medium = constant(1.0);
        Light light;
        for (int i = 0; i < 4096; ++i)
            light.append(integrate_segment(medium, 0.0, 0.0, depth));
        EXPECT_NEAR(light.alpha(), -std::expm1(-4096 * depth), 4096 * std::ldexp(1.0, -52));
        EXPECT_NEAR(light.color.r, -std::expm1(-4096 * depth), 4096 * std::ldexp(1.0, -52));
    }
}

TEST(IntegratorSegment, NoLengthChangesNoBit)
{
    // Hard case 15.
    for (const double extinction : {0.0, 1.0, 1e30, infinity}) {
        const Light nothing = integrate_segment(
            Medium({{0.0, {0.0, 1.0, 0.5}, 0.0}, {1.0, {1.0, 0.0, 0.5}, extinction}}), 0.0, 1.0,
            0.0);
        Light light{{0.1, 0.2, 0.3}, 0.7};
        light.append(nothing);
        EXPECT_EQ(light.color, glm::dvec3(0.1, 0.2, 0.3));
        EXPECT_EQ(light.optical_depth, 0.7);
    }
}

TEST(IntegratorSegment, RangeOfTheExponential)
{
    // Hard case 16. exp(-100) is below the rounding of 1.
    EXPECT_EQ(integrate_segment(constant(1000.0), 0.0, 1.0, 0.1).alpha(), 1.0);
    EXPECT_NEAR(integrate_segment(constant(1000.0), 0.0, 1.0, 0.1).color.r, 1.0, rounding);
    const Light clear = integrate_segment(constant(0.0), 0.0, 1.0, 1e30);
    EXPECT_EQ(clear.color, glm::dvec3(0.0));
    EXPECT_EQ(clear.alpha(), 0.0);
    const Light opaque = integrate_segment(constant(infinity, {0.5, 0.25, 1.0}), 0.0, 1.0, 1e-30);
    EXPECT_EQ(opaque.color, glm::dvec3(0.5, 0.25, 1.0));
    EXPECT_EQ(opaque.alpha(), 1.0);
    // From clear to infinite: the color where it begins; what is behind is not seen.
    const Medium wall({{0.0, {1.0, 0.0, 0.0}, 0.0}, {1.0, {0.0, 1.0, 0.0}, infinity}});
    EXPECT_EQ(integrate_segment(wall, 0.0, 0.0, 1.0).alpha(), 0.0);
    Light light = integrate_segment(wall, 0.0, 1.0, 1.0);
    light.append({{1.0, 1.0, 1.0}, 1.0});
    EXPECT_EQ(light.color, glm::dvec3(1.0, 0.0, 0.0));
    EXPECT_EQ(light.alpha(), 1.0);
    // Largest float: no NaN, no endless loop.
    const Light dense = integrate_segment(linear_emission(3.4e38), 0.0, 1.0, 1.0);
    EXPECT_EQ(dense.alpha(), 1.0);
    EXPECT_NEAR(dense.color.r, 0.0, rounding);
}

TEST(IntegratorSegment, OutsideOfTheControlPointsIsTheNearestOne)
{
    const Medium medium({{0.0, {1.0, 0.0, 0.0}, 1.0}, {1.0, {0.0, 1.0, 0.0}, 2.0}});
    EXPECT_NEAR(integrate_segment(medium, -9.0, -3.0, 1.0).color.r, -std::expm1(-1.0), rounding);
    EXPECT_NEAR(integrate_segment(medium, 9.0, 3.0, 1.0).color.g, -std::expm1(-2.0), rounding);
    // Through all of it: 1/3 before, 1/3 within, 1/3 behind.
    EXPECT_NEAR(integrate_segment(medium, -1.0, 2.0, 3.0).optical_depth, 1.0 + 1.5 + 2.0, rounding);
}

} // namespace
