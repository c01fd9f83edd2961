// SPDX-License-Identifier: MIT

#include "lib/scene/color.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace
{

TEST(ParseColor, ReadsNamesHexadecimalDigitsAndNumbers)
{
    const struct {
        const char *text;
        glm::vec3 color;
    } cases[] = {
        {"red", {1, 0, 0}},
        {"Navy", {0, 0, 128 / 255.0F}},
        {"gray", glm::vec3(128 / 255.0F)},
        {"#ff8000", {1, 128 / 255.0F, 0}},
        {"FF8000", {1, 128 / 255.0F, 0}},
        {"#f80", {1, 136 / 255.0F, 0}},
        {"1,0.5,0", {1, 0.5F, 0}},
        {"0, 0.25, 1", {0, 0.25F, 1}},
    };
    for (const auto &c : cases) {
        const auto color = kb::parse_color(c.text);
        ASSERT_TRUE(color) << color.error().message;
        EXPECT_LE(glm::distance(*color, c.color), 1e-6F) << c.text;
    }
}

TEST(ParseColor, RefusesWhatIsNone)
{
    for (const char *text :
         {"", "reddish", "#", "#ff80", "#ff80001", "#gg0000", "0x1234", "1,1", "1,1,1,1", "1,1,2",
          "-0.5,0,0", "nan,0,0", "1,,1", "1 1 1", "1,1,1,"}) {
        const auto color = kb::parse_color(text);
        ASSERT_FALSE(color) << text;
        EXPECT_NE(color.error().message.find("is no color"), std::string::npos);
    }
}

} // namespace
