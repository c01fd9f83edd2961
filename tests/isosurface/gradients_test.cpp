// SPDX-License-Identifier: MIT

#include "isosurface/gradients.hpp"

#include "isosurface/particles.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace kb::test
{

namespace
{

constexpr glm::vec3 slope{2.0F, -3.0F, 0.5F};

std::vector<float> linear_values(const std::vector<glm::vec3> &points)
{
    std::vector<float> values;
    for (const glm::vec3 &p : points)
        values.push_back(glm::dot(slope, p) + 7.0F);
    return values;
}

/// What is a millionth of the points' extent in all directions together is neglected; an even
/// neighbourhood has a third of that extent in each, an uneven one at least a thirtieth. Values are
/// rounded to 2^-20, and with 27 points a spacing of 0.04 apart that tilts a gradient by less.
constexpr float tolerance = 1e-4F;

void expect_gradients(const std::vector<glm::vec3> &points, const glm::vec3 &expected)
{
    const auto gradients = estimate_gradients(points, linear_values(points));
    ASSERT_EQ(gradients.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        ASSERT_LT(glm::distance(gradients[i], expected), tolerance) << i;
}

TEST(Gradients, AreThoseOfALinearField)
{
    expect_gradients(make_particles(20'000).points, slope);
}

TEST(Gradients, LieInThePlaneOrInTheLineThatHasThePoints)
{
    std::vector<glm::vec3> plane;
    std::vector<glm::vec3> line;
    for (int y = 0; y < 50; ++y) {
        line.emplace_back(0.0F, 0.04F * static_cast<float>(y), 0.25F);
        for (int x = 0; x < 50; ++x)
            plane.emplace_back(0.04F * static_cast<float>(x), line.back().y, 0.25F);
    }
    expect_gradients(plane, {slope.x, slope.y, 0.0F});
    expect_gradients(line, {0.0F, slope.y, 0.0F});
}

TEST(Gradients, AreOfUnevenPointsToo)
{
    // All but one of them in one cube.
    std::vector<glm::vec3> points = make_particles(5'000).points;
    for (glm::vec3 &p : points)
        p = 0.01F * p + glm::vec3(0.5F);
    points.emplace_back(-0.5F);
    const auto gradients = estimate_gradients(points, linear_values(points));
    // Values are rounded to 2^-21 here, and the points' deviation is 0.004.
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        ASSERT_LT(glm::distance(gradients[i], slope), tolerance + 0x1p-21F / 0.004F) << i;
    EXPECT_EQ(gradients.back(), glm::vec3(0.0F)) << "no neighbours, no slope";
}

TEST(Gradients, OfOnePlaceAreNone)
{
    EXPECT_TRUE(estimate_gradients({}, {}).empty());
    const std::vector<glm::vec3> points(3, glm::vec3(0.1F, 0.2F, 0.3F));
    const std::vector<float> values{0.0F, 1.0F, 5.0F};
    for (const glm::vec3 &gradient : estimate_gradients(points, values))
        EXPECT_EQ(gradient, glm::vec3(0.0F));
}

} // namespace

} // namespace kb::test
