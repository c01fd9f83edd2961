// SPDX-License-Identifier: MIT

#include "lib/gl/context.hpp"
#include "volume/disorder_capture.hpp"
#include "volume/disorder_report.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

constexpr kb::Size size{64, 64};

/// The eye is at z = 3 and looks along -z at the origin.
kb::OrbitCamera camera()
{
    kb::OrbitCamera camera;
    camera.distance = 3.0F;
    return camera;
}

/// A triangle about the origin that covers the picture, in the plane z = at + x_slope x + y_slope
/// y, its centroid at (0, middle).
void add_screen(kb::FaceMesh &mesh, float at, float x_slope, float y_slope, float middle)
{
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const glm::vec2 corner :
         {glm::vec2(-9.0F, -3.0F), glm::vec2(9.0F, -3.0F), glm::vec2(0.0F, 6.0F + 3.0F * middle)}) {
        mesh.positions.emplace_back(corner, at + x_slope * corner.x + y_slope * corner.y);
        mesh.scalars.push_back(0.0F);
    }
    mesh.triangles.emplace_back(first, first + 1, first + 2);
    mesh.interior_count = mesh.triangles.size();
}

class DisorderCapture : public testing::Test
{
protected:
    void SetUp() override
    {
        auto made = kb::make_context("osmesa");
        ASSERT_TRUE(made) << made.error().message;
        context_ = std::move(*made);
    }

    kb::Disorder capture(const kb::FaceMesh &mesh)
    {
        kb::SortedFaces faces(context_->gl(), mesh, {0.0F, 1.0F});
        faces.sort(camera(), size);
        auto disorder = kb::capture_disorder(context_->gl(), faces, size);
        EXPECT_TRUE(disorder) << disorder.error().message;
        return disorder ? *disorder : kb::Disorder();
    }

private:
    std::unique_ptr<kb::Context> context_;
};

TEST_F(DisorderCapture, FindsHowLateASlantedFaceIs)
{
    kb::FaceMesh mesh;
    for (const float z : {-0.4F, 0.4F, 0.2F, -0.2F})
        add_screen(mesh, z, 0.0F, 0.0F, 0.0F);
    const double slope = 0.55;
    add_screen(mesh, 0.0F, static_cast<float>(slope), 0.0F, 0.0F);
    const kb::Disorder disorder = capture(mesh);

    // By its centroid the slanted face comes third. Where it is the nearest it is two places late,
    // elsewhere it or the screens that it is behind are one place late.
    EXPECT_EQ(disorder.pixels(), 64U * 64U);
    EXPECT_EQ(disorder.fragments(), 5U * 64U * 64U);
    EXPECT_EQ(disorder.deepest(), 5);
    EXPECT_EQ(disorder.displacement(), 2);

    // The share of the picture on the right of where it meets the screen at z.
    const auto share_right = [slope](double z) {
        const double half_width = (3.0 - z) * std::tan(22.5 * std::acos(-1.0) / 180.0);
        return 0.5 - 0.5 * z / slope / half_width;
    };
    // A column of pixels at each border.
    EXPECT_NEAR(disorder.share_wrong(1), share_right(0.4), 1.0 / 64.0);
    EXPECT_NEAR(disorder.share_wrong(0), share_right(0.2) + 1.0 - share_right(-0.2), 2.0 / 64.0);
}

TEST_F(DisorderCapture, CountsFragmentsOfManyPassesBackToFront)
{
    // In the picture, where |y| is less than 1.4, screen i is at z[i] (1 - y / 2.5); but its
    // centroid is at y = 5, so at -z[i].
    constexpr int screens = 70;
    kb::FaceMesh mesh;
    for (int i = 0; i < screens; ++i) {
        const float z = 0.003F * static_cast<float>(i - screens / 2);
        add_screen(mesh, z, 0.0F, -0.4F * z, 5.0F);
    }
    const kb::Disorder disorder = capture(mesh);
    EXPECT_EQ(disorder.fragments(), screens * 64U * 64U);
    EXPECT_EQ(disorder.deepest(), screens);
    EXPECT_EQ(disorder.displacement(), screens - 1);
    EXPECT_EQ(disorder.share_wrong(screens - 2), 1.0);
}

TEST_F(DisorderCapture, TakesEqualDepthsAsInOrder)
{
    kb::FaceMesh mesh;
    for (int i = 0; i < 70; ++i)
        add_screen(mesh, 0.1F, 0.0F, 0.0F, 0.0F);
    const kb::Disorder disorder = capture(mesh);
    EXPECT_EQ(disorder.fragments(), 70U * 64U * 64U);
    EXPECT_EQ(disorder.displacement(), 0);
}

TEST_F(DisorderCapture, OfNothingIsNone)
{
    kb::FaceMesh mesh;
    add_screen(mesh, 0.0F, 0.0F, 0.0F, 0.0F);
    for (glm::vec3 &position : mesh.positions)
        position.x += 100.0F;
    const kb::Disorder disorder = capture(mesh);
    EXPECT_EQ(disorder.pixels(), 0U);
    EXPECT_EQ(disorder.displacement(), 0);
}

TEST(ColorError, IsOfThePixelsThatHaveFragments)
{
    kb::ImageRgbaF exact(4, 4);
    kb::ImageRgbaF picture(4, 4);
    picture.at(1, 2).y = 0.25F;
    picture.at(3, 3).x = 1.0F / 256.0F;
    const auto error = kb::color_error(picture, exact, 8);
    ASSERT_TRUE(error);
    EXPECT_EQ(error->max, 0.25);
    EXPECT_EQ(error->share, 1.0 / 8.0);
    EXPECT_DOUBLE_EQ(error->rmse, std::sqrt((0.0625 + 1.0 / 65536.0) / (4.0 * 8.0)));
    EXPECT_EQ(kb::color_error(exact, exact, 0)->rmse, 0.0);
}

} // namespace
