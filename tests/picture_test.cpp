// SPDX-License-Identifier: MIT

#include "picture_test.hpp"

#include <fmt/format.h>

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
        auto color = read_pfm(place / "layers" / fmt::format("layer-{:02}.pfm", i));
        auto depth = read_pfm(place / "layers" / fmt::format("layer-{:02}-depth.pfm", i));
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

} // namespace kb::test
