// SPDX-License-Identifier: MIT

#include "tests/integrator/scene.hpp"

#include "tests/support/temp_directory.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace kb::integrator;
using kb::test::TempDirectory;

constexpr const char *scene_text = R"({
  "grid": null, "cubes": 4, "field": "distance", "center": [0, 0, 0], "radius": 1.7320508,
  "transfer": [[0.0, 1.0, 0.5, 0.25, 2.0], [0.5, 0.0, 0.5, 0.25, "inf"]],
  "camera": {"azimuth": 30, "elevation": -20, "distance": 3.5, "field_of_view": 40},
  "size": [32, 24], "background": [0.25, 0.5, 1.0]})";

TEST(IntegratorScene, IsReadAndDrawn)
{
    const TempDirectory directory;
    const auto scene = load_scene(directory.write("scene.json", scene_text));
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->view.size.width, 32);
    EXPECT_EQ(scene->view.size.height, 24);
    const auto &pieces = scene->medium.pieces();
    ASSERT_EQ(pieces.size(), 3U);
    EXPECT_EQ(pieces[1].low.color, glm::dvec3(1.0, 0.5, 0.25));
    EXPECT_EQ(pieces[1].low.extinction, 2.0);
    EXPECT_TRUE(std::isinf(pieces[1].high.extinction));

    // The corner shows the background, the middle what is opaque from the first cell on.
    const Picture picture = integrate(scene->volume());
    EXPECT_EQ(picture.at(0, 0), glm::dvec4(0.25, 0.5, 1.0, 0.0));
    EXPECT_EQ(picture.at(16, 12).w, 1.0);
    EXPECT_LT(picture.at(16, 12).r, 1.0);
}

TEST(IntegratorScene, SaysWhatIsMissing)
{
    const TempDirectory directory;
    EXPECT_FALSE(load_scene(directory / "none.json"));
    for (const auto &[from, to] : {std::pair("\"grid\": null", "\"grid\": \"none.vtk\""),
                                   std::pair("distance\", \"center", "no-field\", \"center"),
                                   std::pair("\"transfer\"", "\"transport\""),
                                   std::pair("[32, 24]", "[32]"), std::pair("1.0]}", "1.0}")}) {
        std::string text = scene_text;
        text.replace(text.find(from), std::string(from).size(), to);
        const auto scene = load_scene(directory.write("scene.json", text));
        ASSERT_FALSE(scene) << to;
        EXPECT_FALSE(scene.error().message.empty());
    }
}

} // namespace
