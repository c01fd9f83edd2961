// SPDX-License-Identifier: MIT

#pragma once

#include "isosurface/isosurface_renderer.hpp"
#include "lib/gl/context.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace kb::test
{

/// No multiples of the 4x4 pixels that lie together in storage.
inline constexpr Size size{190, 170};

/// Tests that draw in this process, on the Mesa that LD_LIBRARY_PATH leads to.
class IsosurfaceTest : public testing::Test
{
protected:
    void SetUp() override
    {
        auto made = make_context("osmesa");
        ASSERT_TRUE(made) << made.error().message;
        context_ = std::move(*made);
    }

    const Gl &gl() const { return context_->gl(); }

    /// Distance from the eye and iso-value (from 0 to 1) of the surfaces of a stream. A failure is
    /// the test's.
    ImageRgbaF draw_stream(Result<std::unique_ptr<FragmentStream>> &stream, ScalarRange range,
                           const std::vector<float> &values, int k, float gap = 0.0F)
    {
        if (!stream) {
            ADD_FAILURE() << stream.error().message;
            return ImageRgbaF(size.width, size.height);
        }
        settings_.k = k;
        settings_.medium = (*stream)->medium();
        settings_.gap = gap;
        settings_.shading.size = size;
        auto renderer = IsosurfaceRenderer::make(gl(), settings_);
        if (!renderer) {
            ADD_FAILURE() << renderer.error().message;
            return ImageRgbaF(size.width, size.height);
        }
        iso_values_.clear();
        for (const float value : values)
            iso_values_.push_back({value, glm::vec3(1.0F), 0.0F});
        iso_values_ = normalized(iso_values_, range);
        EXPECT_TRUE(renderer->set_iso_values(iso_values_));
        (*stream)->sort(camera_, size);
        renderer->capture(**stream, camera_);
        renderer->shade(camera_);
        EXPECT_TRUE(check_gl(gl(), "drawing"));
        picture_ = read_color(gl(), renderer->framebuffer(), size);
        return renderer->read_surfaces();
    }

    OrbitCamera camera_{.azimuth = 30.0F, .elevation = 20.0F};

    // Of the last draw_stream:
    IsosurfaceSettings settings_;
    std::vector<IsoValue> iso_values_;
    ImageRgbaF picture_; ///< Shaded in white on white.

private:
    std::unique_ptr<Context> context_;
};

} // namespace kb::test
