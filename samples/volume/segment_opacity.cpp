// SPDX-License-Identifier: MIT

#include "volume/segment_opacity.hpp"

#include <fmt/format.h>

#include <array>

namespace kb
{

/// 2 alpha(D / 4) / D = (n0 + n1 x + n2 x^2) / (1 + q1 x + q2 x^2 + q3 x^3), of x = D / 2. The
/// maximum of both errors after the two steps was minimized, with the value and the slope at 0 as
/// they are (1/2, and q1 / 2 - n1 = 1/8).
static constexpr std::array<float, 3> n{0.5F, 0.0341028256F, 0.00296236973F};
static constexpr std::array<float, 3> q{0.318205651F, 0.0437773012F, 0.00296835484F};

SegmentOpacity segment_opacity(float x)
{
    float share = ((n[2] * x + n[1]) * x + n[0]) / (((q[2] * x + q[1]) * x + q[0]) * x + 1.0F);
    float alpha = share * x;
    share *= 2.0F - alpha;
    alpha *= 2.0F - alpha;
    // Written like this what should be 1 is 1; and 2 - alpha of what is returned is 1 + left^2.
    const float left = 1.0F - alpha;
    return {alpha + alpha * left, (1.0F + left * left) - (share + share * left)};
}

std::string make_opacity_program()
{
    return fmt::format("MAD opacity.y, depth.x, {2}, {1};\n"
                       "MAD opacity.y, depth.x, opacity.y, {0};\n"
                       "MAD opacity.z, depth.x, {5}, {4};\n"
                       "MUL opacity.w, depth.x, depth.x;\n"
                       "MAD opacity.x, depth.x, {3}, 1.0;\n"
                       "MAD opacity.z, opacity.z, opacity.w, opacity.x;\n"
                       "RCP opacity.z, opacity.z;\n"
                       "MUL opacity.y, opacity.y, opacity.z;\n"
                       "MUL opacity.x, opacity.y, depth.x;\n"
                       "SUB opacity.z, 2.0, opacity.x;\n"
                       "MUL opacity.xy, opacity, opacity.z;\n"
                       "SUB opacity.z, 1.0, opacity.x;\n"
                       "MAD opacity.x, opacity.x, opacity.z, opacity.x;\n"
                       "MAD opacity.w, opacity.y, opacity.z, opacity.y;\n"
                       "MAD opacity.z, opacity.z, opacity.z, 1.0;\n"
                       "SUB opacity.y, opacity.z, opacity.w;\n",
                       n[0], n[1], n[2], q[0], q[1], q[2]);
}

std::string make_opacity_shader()
{
    return fmt::format("vec2 opacity(float x)\n"
                       "{{\n"
                       "    float share = (({2:.9e} * x + {1:.9e}) * x + {0:.9e}) /\n"
                       "                  ((({5:.9e} * x + {4:.9e}) * x + {3:.9e}) * x + 1.0);\n"
                       "    float alpha = share * x;\n"
                       "    share *= 2.0 - alpha;\n"
                       "    alpha *= 2.0 - alpha;\n"
                       "    float left = 1.0 - alpha;\n"
                       "    return vec2(alpha + alpha * left,\n"
                       "                (1.0 + left * left) - (share + share * left));\n"
                       "}}\n",
                       n[0], n[1], n[2], q[0], q[1], q[2]);
}

} // namespace kb
