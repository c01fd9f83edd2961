// SPDX-License-Identifier: MIT

#include "lib/scene/camera.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace
{

glm::vec3 project(const kb::OrbitCamera &camera, kb::Size size, glm::vec3 point)
{
    const glm::vec4 clip = camera.projection(size) * camera.view() * glm::vec4(point, 1.0F);
    return glm::vec3(clip) / clip.w;
}

TEST(Camera, OriginIsInTheMiddle)
{
    kb::OrbitCamera camera;
    camera.turn(33.0F, -20.0F);
    const glm::vec3 p = project(camera, {640, 480}, glm::vec3(0.0F));
    EXPECT_NEAR(p.x, 0.0F, 1e-6F);
    EXPECT_NEAR(p.y, 0.0F, 1e-6F);
}

TEST(Camera, UnitSphereIsInViewInBothOrientations)
{
    const kb::OrbitCamera camera;
    for (const kb::Size size : {kb::Size{400, 200}, kb::Size{200, 400}}) {
        for (const glm::vec3 &point : {glm::vec3(0, 1, 0), glm::vec3(0, -1, 0), glm::vec3(1, 0, 0),
                                       glm::vec3(0, 0, 1), glm::vec3(0, 0, -1)}) {
            const glm::vec3 p = project(camera, size, point);
            EXPECT_LE(std::abs(p.x), 1.0F);
            EXPECT_LE(std::abs(p.y), 1.0F);
            EXPECT_LE(std::abs(p.z), 1.0F);
        }
    }
}

TEST(Camera, PositiveElevationLooksFromAbove)
{
    kb::OrbitCamera camera;
    camera.turn(0.0F, 90.0F);
    // From above, what was nearest is now at the bottom.
    EXPECT_LT(project(camera, {100, 100}, glm::vec3(0, 0, 1)).y, -0.5F);
}

TEST(Camera, StaysWithinItsLimits)
{
    kb::OrbitCamera camera;
    camera.turn(0.0F, 1000.0F);
    EXPECT_FLOAT_EQ(camera.elevation, 90.0F);
    camera.zoom(1e-9F);
    EXPECT_GT(camera.distance, 0.0F);
}

} // namespace
