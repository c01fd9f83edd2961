// SPDX-License-Identifier: MIT
//
// What a segment of some optical depth adds, against exp; and the texels that hold the colors.

#include "volume/segment_opacity.hpp"

#include "tests/programs/arb_interpreter.hpp"
#include "volume/segment_texture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace
{

using kb::PackedSegmentTexture;
using kb::SegmentOpacity;
using kb::test::ArbInterpreter;

/// 2 - alpha - 2 alpha / D. Of small D by its series, the next term of which is D^4 / 40: the three
/// others nearly cancel.
double fading(double depth)
{
    if (depth < 1e-2)
        return depth * depth / 6.0 - depth * depth * depth / 12.0;
    const double alpha = -std::expm1(-depth);
    return 2.0 - alpha - 2.0 * alpha / depth;
}

TEST(SegmentOpacity, IsWithinItsPromiseOfTheClosedForms)
{
    for (double d = 1e-9; d < 4e9; d *= 1.002) {
        const auto half = static_cast<float>(0.5 * d);
        const double depth = 2.0 * static_cast<double>(half);
        const SegmentOpacity opacity = kb::segment_opacity(half);
        const double alpha = -std::expm1(-depth);
        ASSERT_NEAR(opacity.alpha, alpha, 2e-6 * alpha) << depth;
        ASSERT_NEAR(opacity.fading, fading(depth), 3e-6) << depth;
        ASSERT_LE(opacity.alpha, 1.0F) << depth;
        if (depth > 600.0) {
            ASSERT_EQ(opacity.alpha, 1.0F) << depth;
        }
    }
}

TEST(SegmentOpacity, OfNoDepthIsNothingToTheBit)
{
    EXPECT_EQ(kb::segment_opacity(0.0F).alpha, 0.0F);
    EXPECT_EQ(kb::segment_opacity(0.0F).fading, 0.0F);
}

TEST(SegmentOpacity, OfTheProgramIsThatOfTheFunction)
{
    const ArbInterpreter program("!!ARBfp1.0\nOPTION MESA_kbuffer_program;\n"
                                 "TEMP depth, opacity;\nMOV depth.x, fragment.color.x;\n" +
                                 kb::make_opacity_program() +
                                 "MOV result.kbuffer[0].xy, opacity;\nEND\n");
    for (float half = 1e-6F; half < 2e9F; half *= 1.5F) {
        std::vector<glm::vec4> kbuffer(1);
        ASSERT_TRUE(program.run({glm::vec4(half), 0.0F}, kbuffer));
        const SegmentOpacity expected = kb::segment_opacity(half);
        // The program multiplies by the reciprocal, which rounds once more.
        ASSERT_NEAR(kbuffer[0].x, expected.alpha, 4e-7F * expected.alpha) << half;
        ASSERT_NEAR(kbuffer[0].y, expected.fading, 1e-6F) << half;
    }
}

TEST(SegmentTexture, UnpackedIsWhatWasPackedToHalfAStep)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0.0F, 1.0F);
    for (int i = 0; i < 1000; ++i) {
        const glm::vec4 thin(unit(random), i % 2 ? 1.0F : unit(random), i % 3 ? 0.0F : 0.25F, 7.0F);
        // Thick colors from 0 to 1 as well.
        const float difference = (i % 5 ? 2.0F : 0.02F) * (unit(random) - 0.5F);
        const glm::vec4 thick(unit(random), unit(random), unit(random), 0.0F);
        const glm::vec4 texel =
            PackedSegmentTexture::pack(thin, (thick - thin) / difference, difference);
        const float range = static_cast<float>(PackedSegmentTexture::change_range) *
                            std::max(std::abs(difference),
                                     static_cast<float>(PackedSegmentTexture::least_difference));
        for (int c = 0; c < 3; ++c) {
            const float whole = std::floor(texel[c]);
            EXPECT_NEAR(whole / static_cast<float>(PackedSegmentTexture::color_steps), thin[c],
                        1.0F / 8192.0F + 1e-7F);
            // Parts are multiples of 1/4096, and beside a color of 1, for which the sum is rounded
            // once more, of 1/2048.
            EXPECT_NEAR((texel[c] - whole - 0.5F) * range, thick[c] - thin[c],
                        range * (whole == 4096.0F ? 1.5F : 0.5F) / 4096.0F + 1e-6F);
        }
        EXPECT_EQ(texel.w, 3.5F);
    }
}

} // namespace
