// SPDX-License-Identifier: MIT

#include "tests/support/picture_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

namespace kb::test
{

Rendering PictureTest::render(const std::string &prefix, const std::vector<std::string> &arguments,
                              const std::map<std::string, std::string> &environment)
{
    const auto place = directory_ / fmt::format("run-{}", renderings_++);
    std::filesystem::create_directory(place);
    std::vector<std::string> command{KBUFFER_TRANSPARENCY, "--out",         place / "picture.png",
                                     "--float-out",        place / "p.pfm", "--layers-out",
                                     place / "layers"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    auto variables = mesa_environment(prefix);
    for (const auto &[name, value] : environment)
        variables[name] = value;
    const ProcessResult result = run(command, variables);

    Rendering rendering;
    EXPECT_EQ(result.status, 0) << result.err;
    if (result.status != 0)
        return rendering;
    auto floats = read_pfm(place / "p.pfm");
    auto bytes = read_png(place / "picture.png");
    if (!floats || !bytes) {
        ADD_FAILURE() << "the pictures cannot be read";
        return rendering;
    }
    rendering.floats = *floats;
    rendering.bytes = *bytes;
    for (int i = 0;; ++i) {
        auto color = read_pfm(place / "layers" / fmt::format("layer-{:03}.pfm", i));
        auto depth = read_pfm(place / "layers" / fmt::format("layer-{:03}-depth.pfm", i));
        if (!color || !depth)
            break;
        rendering.colors.push_back(*color);
        rendering.depths.push_back(*depth);
    }
    std::ifstream file(place / "p.pfm", std::ios::binary);
    rendering.float_file.assign(std::istreambuf_iterator<char>(file), {});
    std::filesystem::remove_all(place);
    return rendering;
}

double PictureTest::max_difference(const ImageRgbaF &a, const ImageRgbaF &b)
{
    const auto difference = compare(a, b);
    return difference ? difference->max : 1.0;
}

void expect_agreement_inside_of_faces(const LayeredPicture &a, const LayeredPicture &b,
                                      std::size_t layers)
{
    ASSERT_EQ(a.depths.size(), layers);
    ASSERT_EQ(b.depths.size(), layers);
    const int width = a.picture.width;
    const int height = a.picture.height;

    // The drivers put edges at other places (llvmpipe snaps vertices to 1/256 pixel): compare where
    // in both the number of layers is the same in the whole neighbourhood of 5x5 pixels.
    const auto count = [](const LayeredPicture &picture, int x, int y) {
        return std::count_if(picture.depths.begin(), picture.depths.end(),
                             [x, y](const ImageRgbaF &d) { return d.at(x, y).x < 1.0F; });
    };
    const auto is_inside = [&](int x, int y) {
        for (int dy = -2; dy <= 2; ++dy) {
            for (int dx = -2; dx <= 2; ++dx) {
                if (count(a, x + dx, y + dy) != count(a, x, y) ||
                    count(b, x + dx, y + dy) != count(a, x, y))
                    return false;
            }
        }
        return true;
    };
    // Snapping moves a plane's vertices by up to 1/512 pixel. Colors and depths change by less than
    // 1/32 a pixel in this scene (a face is some 60 pixels wide, and the light falls off by less
    // than half across it), so by less than 1/32 * sqrt(2)/512 through that, and less again by
    // rounding of the plane equations: some 2^-24 * 128 pixels * 1/32.
    const double tolerance = 1.5 / (32.0 * 512.0) + std::ldexp(1.0, -22);
    int inside = 0;
    std::size_t deepest = 0;
    for (int y = 2; y < height - 2; ++y) {
        for (int x = 2; x < width - 2; ++x) {
            if (!is_inside(x, y))
                continue;
            ++inside;
            deepest = std::max(deepest, static_cast<std::size_t>(count(a, x, y)));
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(a.picture.at(x, y)[c], b.picture.at(x, y)[c], tolerance)
                    << x << ", " << y;
            for (std::size_t i = 0; i < layers; ++i)
                ASSERT_NEAR(a.depths[i].at(x, y).x, b.depths[i].at(x, y).x, tolerance)
                    << x << ", " << y << " layer " << i;
        }
    }
    EXPECT_GT(inside, width * height / 8) << "enough of the picture was compared";
    EXPECT_EQ(deepest, layers);
}

} // namespace kb::test
